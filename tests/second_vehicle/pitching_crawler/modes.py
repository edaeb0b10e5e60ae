"""The modes of a pitching crawler, none of which a tilt-rotor vehicle has.

standing ─▶ climbing_out ─▶ hovering ─▶ nearing ─▶ leaning ─▶ crawling ─▶ leaving ─▶ hovering …
                                              ╰─▶ propping ─▶ leaving ─▶ … sinking ─▶ resting
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.autonomy.context import Context, Judges
from inspect_cli.autonomy.failsafe import Failsafe
from inspect_cli.autonomy.modes import Behaviour, Mode, Order, by_name
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.spatial.arrays import Vector
from pitching_crawler.motions import RAMP_S, crawl, crawl_s, creep, press, route, stay
from pitching_crawler.stack import CrawlerStack

SETTLE_S, REST_S = 0.3, 0.6
BLOCKED_M = 0.03
"""A surface is felt once the set-point has gone on so far ahead of the vehicle."""
LOST_M = 0.6
GOING = {"takeoff": "climbing_out", "transit": "hovering", "land": "sinking"}
"""The modes of the legs that every plan has; a leg of a task of its own is called by its mode."""


@dataclass
class CrawlerInputs:
    """What the failsafes look at."""

    position_error_m: float = 0.0


class CrawlerContext(Context):
    """The flight as the crawler's modes see it."""

    stack: CrawlerStack
    inputs: CrawlerInputs

    def __init__(self, plan: Plan, stack: CrawlerStack, judges: Judges, mode: Mode) -> None:
        super().__init__(plan, stack, judges, mode)
        self.inputs = CrawlerInputs()
        self.length_s = 0.0
        """How long the motion of the mode takes."""

    def refresh(self, t_s: float) -> None:
        super().refresh(t_s)
        self.inputs.position_error_m = float(np.linalg.norm(self.error_W))

    def enter(self, t_s: float, mode: Mode, order: Order) -> None:
        super().enter(t_s, mode, order)
        self.armed = mode.phase is not Phase.GROUND

    @property
    def error_W(self) -> Vector:
        """How far the set-point is ahead of the estimate."""
        return self.stack.point.p_WB - self.stack.estimate.p_WB

    @property
    def elapsed_s(self) -> float:
        return self.t_s - self.since_s

    @property
    def begun_W(self) -> Vector:
        return self.stack.point.p_WB.copy()

    @property
    def into_W(self) -> Vector:
        """Into the surface of the target."""
        return -np.array(self._target.n_W)

    @property
    def _target(self) -> Target:
        assert self.target is not None  # the plan's schema asks for it
        return self.target


def go(context: CrawlerContext, order: Order) -> None:
    """Pass the way-points."""
    stack = context.stack
    motion, context.length_s = route(stack.point, order.postures, order.speed_mps, stack.turn_radps)
    stack.begin(context.t_s, motion)


def near(context: CrawlerContext, order: Order) -> None:
    """Creep on until something is felt."""
    motion = creep(context.begun_W, order.speed_mps * context.into_W)
    context.stack.begin(context.t_s, motion)


def push(context: CrawlerContext, order: Order) -> None:
    """Press where the surface was felt, in the posture that statics say for that place."""
    law, into_W = context.target.law, context.into_W
    begun = context.begun_W - into_W * float(context.error_W @ into_W)
    trimmed = context.stack.trimmed(context.mode.name, into_W, law.force_n)
    context.length_s = RAMP_S + context.target.dwell_s
    context.stack.begin(context.t_s, press(begun, trimmed.p_WB, into_W, law.force_n))


def roll(context: CrawlerContext, order: Order) -> None:
    """Crawl as far as the plan does, from where the vehicle is."""
    way = order.postures[-1].p_WB - np.array(context.target.contact.p_WB)
    length_m = float(np.linalg.norm(way))
    context.length_s = crawl_s(length_m, order.speed_mps)
    motion = crawl(context.begun_W, way / length_m, length_m, order.speed_mps)
    context.stack.begin(context.t_s, motion)


def hover(context: CrawlerContext, order: Order) -> None:
    """Stay where it is."""
    context.stack.begin(context.t_s, stay)


def settled(context: CrawlerContext) -> bool:
    """Whether it has stood for a moment."""
    return context.elapsed_s >= SETTLE_S


def rested(context: CrawlerContext) -> bool:
    """Whether the motion is over, and the rest after it."""
    return context.elapsed_s >= context.length_s + REST_S


def blocked(context: CrawlerContext) -> bool:
    """Whether a surface is in the way."""
    return float(context.error_W @ context.into_W) > BLOCKED_M


def stayed(context: CrawlerContext) -> bool:
    """Whether it has hovered for a moment."""
    return context.elapsed_s >= REST_S


MODES = by_name(
    Mode("standing", 0, Phase.GROUND, settled),
    Mode("climbing_out", 1, Phase.NEAR_GROUND, rested, go),
    Mode("hovering", 2, Phase.FREE, rested, go),
    Mode("nearing", 3, Phase.NEAR, blocked, near),
    Mode("leaning", 4, Phase.CONTACT, rested, push),
    Mode("crawling", 5, Phase.CONTACT, rested, roll, slides=True),
    Mode("propping", 6, Phase.PERCHED, rested, push),
    Mode("leaving", 7, Phase.NEAR, rested, go),
    Mode("sinking", 8, Phase.NEAR_GROUND, rested, go),
    Mode("resting", 9, Phase.GROUND, stayed),
    Mode("giving_up", 10, Phase.SAFE, stayed, hover),
)


def orders_of(going: Mapping[str, str]) -> Callable[[Plan], Sequence[Order]]:
    """Makes the orders of a plan, given the modes of the legs that every plan has."""

    def orders(plan: Plan) -> Sequence[Order]:
        legs = [
            Order(
                going.get(leg.kind, leg.kind),
                leg.target,
                tuple(model.posture for model in leg.postures),
                leg.speed_mps,
            )
            for leg in plan.legs
        ]
        return [*legs, Order("resting")]

    return orders


def give_up(context: CrawlerContext) -> Sequence[Order]:
    """Hover where it is."""
    return (Order("giving_up"),)


FAR_OFF = Failsafe(
    name="far from where it shall be",
    modes=frozenset(MODES) - {"standing", "resting", "giving_up"},
    violated=lambda inputs: not inputs.position_error_m < LOST_M,
    patience_s=0.2,
    severity=1,
    fallbacks=(give_up,),
)


def behaviour_of(
    modes: Mapping[str, Mode], failsafes: Sequence[Failsafe], going: Mapping[str, str]
) -> Behaviour:
    """How a crawler with these modes goes about a plan; it begins standing."""
    return Behaviour(
        modes=modes,
        failsafes=failsafes,
        first="standing",
        orders=orders_of(going),
        stop=give_up,
        context=lambda plan, stack, judges: CrawlerContext(plan, stack, judges, modes["standing"]),
    )


BEHAVIOUR = behaviour_of(MODES, (FAR_OFF,), GOING)
