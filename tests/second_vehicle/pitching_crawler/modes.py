"""The modes of a pitching crawler, none of which a tilt-rotor vehicle has.

standing ─▶ climbing_out ─▶ hovering ─▶ nearing ─▶ leaning ─▶ crawling ─▶ hovering …
                                              ╰─▶ propping ─▶ hovering
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.autonomy.context import Context, Judges
from inspect_cli.autonomy.failsafe import Failsafe
from inspect_cli.autonomy.modes import Behaviour, Mode, Order, by_name
from inspect_cli.schema.modes import Phase
from inspect_cli.spatial.arrays import Vector
from pitching_crawler.motions import RAMP_S, crawl, crawl_s, creep, line, press, stay
from pitching_crawler.stack import CrawlerStack

SETTLE_S, REST_S = 0.3, 1.0
NEARING_MPS = 0.05
BLOCKED_M = 0.03
"""A surface is felt once the set-point has gone on so far ahead of the vehicle."""
LOST_M = 0.6
UP_W = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class PushTarget:
    """A frame to press on a surface, and how far to crawl there."""

    index: int
    label: str
    frame: str
    into_W: Vector
    force_n: float
    dwell_s: float
    crawl_m: float = 0.0
    crawl_mps: float = 0.2
    sensor: None = None


@dataclass(frozen=True)
class CrawlerPlan:
    """Targets, and the orders that lead to them."""

    targets: tuple[PushTarget, ...]
    orders: tuple[Order, ...]


@dataclass
class CrawlerInputs:
    """What the failsafes look at."""

    position_error_m: float = 0.0


class CrawlerContext(Context):
    """The flight as the crawler's modes see it."""

    stack: CrawlerStack
    inputs: CrawlerInputs

    def __init__(self, plan: CrawlerPlan, stack: CrawlerStack, judges: Judges, mode: Mode) -> None:
        super().__init__(plan, stack, judges, mode)
        self.inputs = CrawlerInputs()
        self.length_s = 0.0
        """How long the motion of the mode takes."""

    def refresh(self, t_s: float) -> None:
        super().refresh(t_s)
        self.inputs.position_error_m = float(np.linalg.norm(self.error_W))

    def enter(self, t_s: float, mode: Mode, order: Order) -> None:
        super().enter(t_s, mode, order)
        self.armed = True

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


def _go(context: CrawlerContext, order: Order) -> None:
    end = order.postures[-1].p_WB
    way_m = float(np.linalg.norm(end - context.begun_W))
    context.length_s = max(1.9 * way_m / order.speed_mps, 1.0)
    context.stack.begin(context.t_s, line(context.begun_W, end, context.length_s))


def _near(context: CrawlerContext, order: Order) -> None:
    motion = creep(context.begun_W, NEARING_MPS * context.target.into_W)
    context.stack.begin(context.t_s, motion)


def _press(context: CrawlerContext, order: Order) -> None:
    target = context.target
    begun = context.begun_W - target.into_W * float(context.error_W @ target.into_W)
    trimmed = context.stack.trimmed(target.frame, target.into_W, target.force_n)
    motion = press(begun, trimmed.p_WB, target.into_W, target.force_n)
    context.length_s = RAMP_S + target.dwell_s
    context.stack.begin(context.t_s, motion)


def _crawl(context: CrawlerContext, order: Order) -> None:
    target = context.target
    context.length_s = crawl_s(target.crawl_m, target.crawl_mps)
    motion = crawl(context.begun_W, UP_W, target.crawl_m, target.crawl_mps)
    context.stack.begin(context.t_s, motion)


def _hover(context: CrawlerContext, order: Order) -> None:
    context.stack.begin(context.t_s, stay)


def _settled(context: CrawlerContext) -> bool:
    return context.elapsed_s >= SETTLE_S


def _rested(context: CrawlerContext) -> bool:
    return context.elapsed_s >= context.length_s + REST_S


def _blocked(context: CrawlerContext) -> bool:
    return float(context.error_W @ context.target.into_W) > BLOCKED_M


MODES = by_name(
    Mode("standing", 0, Phase.GROUND, _settled),
    Mode("climbing_out", 1, Phase.NEAR_GROUND, _rested, _go),
    Mode("hovering", 2, Phase.FREE, _rested, _go),
    Mode("nearing", 3, Phase.NEAR, _blocked, _near),
    Mode("leaning", 4, Phase.CONTACT, _rested, _press),
    Mode("crawling", 5, Phase.CONTACT, _rested, _crawl, slides=True),
    Mode("propping", 6, Phase.PERCHED, _rested, _press),
    Mode("giving_up", 7, Phase.SAFE, lambda context: context.elapsed_s >= REST_S, _hover),
)


def give_up(context: CrawlerContext) -> Sequence[Order]:
    """Hover where it is."""
    return (Order("giving_up"),)


BEHAVIOUR = Behaviour(
    modes=MODES,
    failsafes=(
        Failsafe(
            name="far from where it shall be",
            modes=frozenset(MODES) - {"giving_up"},
            violated=lambda inputs: not inputs.position_error_m < LOST_M,
            patience_s=0.2,
            severity=1,
            fallbacks=(give_up,),
        ),
    ),
    first="standing",
    orders=lambda plan: plan.orders,
    stop=give_up,
    context=lambda plan, stack, judges: CrawlerContext(plan, stack, judges, MODES["standing"]),
)
