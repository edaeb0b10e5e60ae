"""The modes of a fully actuated vehicle, and the orders that a plan becomes.

    idle ─▶ takeoff ─▶ transit ─▶ approach ─▶ press ─▶ retreat ─▶ transit … ─▶ land ─▶ landed
                          ╰─▶ hold ─▶ …          ╰─▶ slide ─▶╯
    any of them while flying, by the failsafes ─▶ hover, and the run ends aborted

Where the vehicle shall go next and when a point is done is decided here; how to get there is
guidance's, how to hold it is the controller's, which never learns of modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inspect_cli.autonomy.context import Judges
from inspect_cli.autonomy.modes import Mode, Order, by_name
from inspect_cli.autonomy.protocols import GuidedStack
from inspect_cli.interfaces import Posture
from inspect_cli.schema.flight_times import PAUSE_S
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.vehicles.fully_actuated.context import ContactContext

SETTLE_S = 1.0
"""On the ground before take-off, for the filter to find its biases."""
STAND_S = 1.5
"""On the ground after the motors have stopped."""
SAFE_HOVER_S = 3.0
"""Hover at rest after an abort before the run ends."""
TOUCHDOWN_M = 0.15
"""How far below standing height the vehicle leans on the ground before its motors stop."""
BEFORE_CONTACT_M = 0.01
"""The approach ends this far from the surface; the press goes through it."""


def orders_of(plan: Plan) -> list[Order]:
    """The legs of a plan as orders, and the touch-down after the last of them."""
    orders = [
        Order(leg.kind, leg.target, tuple(model.posture for model in leg.postures), leg.speed_mps)
        for leg in plan.legs
    ]
    last = orders[-1]
    below = _lower(last.postures[-1], TOUCHDOWN_M)
    return [*orders, Order("landed", postures=(below,), speed_mps=last.speed_mps)]


def back_off(context: ContactContext) -> Sequence[Order]:
    """Back off to the standoff if there is a surface to leave, then hover."""
    if not _has_something_to_leave(context):
        return stop(context)
    leaving, speed_mps = context.order.target, context.order.speed_mps
    return (Order("hover", speed_mps=speed_mps, leaving=leaving),)


def stop(context: ContactContext) -> Sequence[Order]:
    """Hover where the vehicle is."""
    return (Order("hover"),)


def context_of(plan: Plan, stack: GuidedStack, judges: Judges) -> ContactContext:
    """The context of a flight that begins on the ground."""
    return ContactContext(plan, stack, judges, MODES["idle"])


def _lower(posture: Posture, by_m: float) -> Posture:
    down = np.array([0.0, 0.0, by_m])
    return replace(posture, p_WB=posture.p_WB - down)


def _has_something_to_leave(context: ContactContext) -> bool:
    """Whether the standoff leads away from the surface.

    A following begins anywhere: before its surface is found or near, the standoff would lead
    back into what nobody looked at, or forward.
    """
    target, name = context.target, context.mode.name
    if target is None or name not in ("approach", "press", "slide", "retreat"):
        return False
    if name != "approach" or target.following is None:
        return True
    near = context.inputs.surface_distance_m < target.standoff_m
    return not context.waiting_for_surface and near


def _working_on(context: ContactContext) -> Target:
    target = context.target
    assert target is not None  # the plan's schema asks for it
    return target


# What each mode begins with.


def _travel(context: ContactContext, order: Order) -> None:
    context.guidance.go_to(context.t_s, order.postures, order.speed_mps)


def _wait_for_surface(context: ContactContext, order: Order) -> None:
    inputs = context.inputs
    context.waiting_for_surface = True
    inputs.surface_seen_s = inputs.surface_agreed_s = context.t_s


def _press(context: ContactContext, order: Order) -> None:
    target = _working_on(context)
    context.prepare_reading(target)
    context.dwelling_since_s = None
    context.guidance.tracks_surface = True
    context.guidance.approach(context.t_s, target, target.press_m, order.speed_mps)


def _slide(context: ContactContext, order: Order) -> None:
    # A stroke is drawn on the surface that was seen before it.
    target = _working_on(context)
    context.guidance.tracks_surface = target.following is not None
    context.guidance.slide(context.t_s, target)


def _retreat(context: ContactContext, order: Order) -> None:
    # It keeps to the surface that it leaves: what is seen of that only gets noisier.
    target = _working_on(context)
    context.guidance.approach(context.t_s, target, -target.standoff_m, order.speed_mps)


def _hover(context: ContactContext, order: Order) -> None:
    if order.leaving is None:
        context.guidance.hold(context.t_s)
        return
    target = context.plan.targets[order.leaving]
    context.guidance.approach(context.t_s, target, -target.standoff_m, order.speed_mps)


# When each mode is done.


def _settled(context: ContactContext) -> bool:
    return context.t_s - context.since_s >= SETTLE_S


def _rested(context: ContactContext) -> bool:
    return context.rested()


def _held(context: ContactContext) -> bool:
    return context.t_s - context.since_s >= _working_on(context).dwell_s


def _approached(context: ContactContext) -> bool:
    """Begin to move once the surface is seen from the standoff; then rest before it."""
    if context.waiting_for_surface:
        _begin_approach_when_seen(context)
        return False
    return context.rested()


def _begin_approach_when_seen(context: ContactContext) -> None:
    inputs, guidance, target = context.inputs, context.guidance, _working_on(context)
    if inputs.surface_agreed_s < context.since_s + PAUSE_S:
        return
    # The estimate is one record that every image overwrites: is it still the one that agreed?
    seen = context.seen
    good = seen is not None and seen.valid == 1.0 and seen.t_s == inputs.surface_agreed_s
    if target.following is not None and not good:
        return
    context.waiting_for_surface, guidance.tracks_surface = False, True
    guidance.approach(context.t_s, target, -BEFORE_CONTACT_M, context.order.speed_mps)
    if target.following is not None and seen is not None:
        # A surface that nobody described is aimed at by what is seen of it now.
        guidance.observe(context.t_s, seen)


def _dwelt(context: ContactContext) -> bool:
    """Press to the set-point, then dwell: until the judge has decided, if there is one."""
    if context.dwelling_since_s is None and context.guidance.arrived(context.t_s):
        context.dwelling_since_s = context.t_s
        context.begin_reading()
    if context.dwelling_since_s is None:
        return False
    if context.reads:
        return context.decided()
    return context.t_s - context.dwelling_since_s >= _working_on(context).dwell_s


def _slid(context: ContactContext) -> bool:
    """Rest at the end of the way; after a following for as long as the tool shall stay."""
    target = _working_on(context)
    return context.rested(max(PAUSE_S, target.dwell_s) if target.following else PAUSE_S)


def _stood(context: ContactContext) -> bool:
    """Lean on the ground, stop the motors, wait."""
    if context.armed and context.rested():
        context.armed, context.since_s = False, context.t_s
    return not context.armed and context.t_s - context.since_s >= STAND_S


def _hovered(context: ContactContext) -> bool:
    return context.rested(SAFE_HOVER_S)


MODES = by_name(
    Mode("idle", 0, Phase.GROUND, _settled),
    Mode("takeoff", 1, Phase.NEAR_GROUND, _rested, _travel),
    Mode("transit", 2, Phase.FREE, _rested, _travel),
    Mode("hold", 3, Phase.FREE, _held, _travel),
    Mode("approach", 4, Phase.NEAR, _approached, _wait_for_surface),
    Mode("press", 5, Phase.CONTACT, _dwelt, _press, ContactContext.take_reading),
    Mode("slide", 6, Phase.CONTACT, _slid, _slide, slides=True),
    Mode("retreat", 7, Phase.NEAR, _rested, _retreat),
    Mode("land", 8, Phase.NEAR_GROUND, _rested, _travel),
    Mode("landed", 9, Phase.GROUND, _stood, _travel),
    Mode("hover", 10, Phase.SAFE, _hovered, _hover),
)
