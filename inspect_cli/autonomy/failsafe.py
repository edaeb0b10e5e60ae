"""When to give up: a table of conditions, each with the modes it watches and what follows.

``Action`` is ordered by severity, so that several violations are settled by ``max``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import Estimate, Mode, Reference
from inspect_cli.spatial.arrays import Structured, Vector


class Action(IntEnum):
    """What a violated condition asks for, mildest first."""

    CONTINUE = 0
    RETREAT = 1
    """Back off to the standoff, then hover; the mission is aborted."""
    HOVER = 2
    """Stop where you are and hover; the mission is aborted."""


@dataclass
class FlightInputs:
    """What the conditions look at; measured or estimated, never true."""

    t_s: float
    estimate: Estimate
    reference: Reference
    pose_heard_s: float = 0.0
    """When the last pose was accepted."""
    surface_seen_s: float = 0.0
    """When the last valid surface estimate came."""
    surface_agreed_s: float = 0.0
    """When the last one came that does not contradict the plan of the target."""
    surface_distance_m: float = np.inf
    """From the tip to the surface that was seen last; infinite when that is long ago."""
    surface_n_W: Vector = field(default_factory=lambda: np.zeros(3))
    """Its outward normal."""
    least_distance_m: float = 0.0
    """How near the surface ahead may come on the way to the target."""
    press_m: float = 0.0
    """How far behind the surface the reference may lie."""

    position_error_m: float = 0.0
    """Distance between estimate and reference."""
    attitude_error_rad: float = 0.0
    """Angle between estimate and reference."""
    force_n: float = 0.0
    """Estimated external force."""
    closing_mps: float = 0.0
    """Estimated speed towards the surface that was seen last."""

    @property
    def stopping_m(self) -> float:
        """The way to a stop: a reaction time, then braking."""
        return REACTION_S * self.closing_mps + 0.5 * self.closing_mps**2 / BRAKING_MPS2

    def refresh(self, t_s: float) -> None:
        """Bring time and errors up to date."""
        self.t_s = t_s
        errors = tracking_errors(self.estimate.array, self.reference.array)
        self.position_error_m, self.attitude_error_rad, self.force_n = errors
        self.closing_mps = max(0.0, -float(self.surface_n_W @ self.estimate.v_WB_W))
        if t_s - self.surface_seen_s > STALE_S:
            self.surface_distance_m = np.inf


@kernel
def tracking_errors(estimate: Structured, reference: Structured) -> tuple[float, float, float]:
    """(distance m, angle rad) between an Estimate and a Reference (1,); the external force, N."""
    now, ref = estimate[0], reference[0]
    square, force = 0.0, 0.0
    for k in range(3):
        square += (now["p_WB"][k] - ref["p_WB"][k]) ** 2
        force += now["wrench_B"][k] ** 2
    cosine = 0.0
    for k in range(4):
        cosine += now["q_WB"][k] * ref["q_WB"][k]
    angle = 2.0 * np.arccos(min(abs(cosine), 1.0))
    return np.sqrt(square), angle, np.sqrt(force)


FLYING = frozenset(
    {
        Mode.TAKEOFF,
        Mode.TRANSIT,
        Mode.HOLD,
        Mode.APPROACH,
        Mode.PRESS,
        Mode.SLIDE,
        Mode.RETREAT,
        Mode.LAND,
    }
)
NEAR_SURFACE = frozenset({Mode.APPROACH, Mode.PRESS, Mode.SLIDE})
FREE = frozenset({Mode.TRANSIT, Mode.APPROACH})
REACTION_S, BRAKING_MPS2 = 0.2, 1.0
"""How late and how hard the vehicle brakes, for the distance that it needs to stop."""
STALE_S = 0.5
"""An estimate of the surface that is older tells nothing of the present."""


@dataclass(frozen=True)
class Failsafe:
    """One row: what is watched, in which modes, for how long it may be so, what follows."""

    name: str
    modes: frozenset[Mode]
    violated: Callable[[FlightInputs], bool]
    patience_s: float
    action: Action


# Each condition is written so that a NaN violates it.
FAILSAFES: tuple[Failsafe, ...] = (
    Failsafe(
        "pose measurements lost",
        FLYING,
        lambda i: not i.t_s - i.pose_heard_s <= 0.25,
        0.0,
        Action.RETREAT,
    ),
    Failsafe(
        "surface not seen by the depth camera",
        NEAR_SURFACE,
        lambda i: not i.t_s - i.surface_seen_s <= STALE_S,
        1.5,
        Action.RETREAT,
    ),
    Failsafe(
        "surface lost while sliding",
        frozenset({Mode.SLIDE}),
        lambda i: not i.t_s - i.surface_seen_s <= STALE_S,
        0.0,
        Action.RETREAT,
    ),
    Failsafe(
        "surface contradicts the plan",
        NEAR_SURFACE,
        lambda i: not i.surface_seen_s - i.surface_agreed_s <= STALE_S,
        0.5,
        Action.RETREAT,
    ),
    Failsafe(
        "surface nearer than planned on the way",
        frozenset({Mode.TRANSIT}),
        lambda i: not i.surface_distance_m >= i.least_distance_m + i.stopping_m,
        0.0,
        Action.HOVER,
    ),
    Failsafe(
        "unexpected force above 12 N",
        FREE,
        lambda i: not i.force_n <= 12.0,
        0.1,
        Action.RETREAT,
    ),
    Failsafe(
        "position error above 0.6 m",
        FLYING,
        lambda i: not i.position_error_m <= 0.6 + i.press_m,
        0.5,
        Action.RETREAT,
    ),
    Failsafe(
        "attitude error above 0.6 rad",
        FLYING,
        lambda i: not i.attitude_error_rad <= 0.6,
        0.3,
        Action.RETREAT,
    ),
)


@dataclass
class Watch:
    """Keeps how long each condition has been violated."""

    table: Iterable[Failsafe] = FAILSAFES
    _since: dict[str, float] = field(default_factory=dict)

    def check(self, mode: Mode, inputs: FlightInputs) -> tuple[Action, str]:
        """The severest action that is due now, and the condition that asks for it."""
        worst, reason = Action.CONTINUE, ""
        for row in self.table:
            if mode not in row.modes or not row.violated(inputs):
                self._since.pop(row.name, None)
                continue
            since = self._since.setdefault(row.name, inputs.t_s)
            if inputs.t_s - since >= row.patience_s and row.action > worst:
                worst, reason = row.action, row.name
        return worst, reason
