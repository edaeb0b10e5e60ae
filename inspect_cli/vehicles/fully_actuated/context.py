"""What the modes and failsafes of a fully actuated vehicle look at; measured or estimated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from inspect_cli.autonomy.context import Context, Judges
from inspect_cli.autonomy.modes import Mode, Order
from inspect_cli.autonomy.protocols import Guidance, GuidedStack
from inspect_cli.compiled import bound, kernel
from inspect_cli.records import Estimate, Pose, Record, Reference, SurfaceEstimate
from inspect_cli.schema.flight_times import PAUSE_S
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Plan
from inspect_cli.spatial.arrays import Structured, Vector

POSE_AGE_S = 0.25
"""A pose measurement that is older is lost."""
STALE_S = 0.5
"""An estimate of the surface that is older tells nothing of the present."""
REACTION_S, BRAKING_MPS2 = 0.2, 1.0
"""How late and how hard the vehicle brakes, for the distance that it needs to stop."""
NEAREST_SHARE = 0.4
"""Of the standoff: a surface that is nearer on the way to it is not where it was planned."""
BEHIND_SURFACE = frozenset({"press", "slide", "retreat"})
"""Modes in which the reference may lie behind the surface."""


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

    _errors: Callable[[], tuple[float, float, float, float]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Look up once how the records of estimate and reference are compared."""
        records = self.estimate.array, self.reference.array
        self._errors = bound(tracking_errors, *records, self.surface_n_W)

    @property
    def stopping_m(self) -> float:
        """The way to a stop: a reaction time, then braking."""
        return REACTION_S * self.closing_mps + 0.5 * self.closing_mps**2 / BRAKING_MPS2

    def refresh(self, t_s: float) -> None:
        """Bring time and errors up to date."""
        self.t_s = t_s
        errors = self._errors()
        self.position_error_m, self.attitude_error_rad, self.force_n, self.closing_mps = errors
        if t_s - self.surface_seen_s > STALE_S:
            self.surface_distance_m = np.inf


@kernel
def tracking_errors(
    estimate: Structured, reference: Structured, n_W: Vector
) -> tuple[float, float, float, float]:
    """(distance m, angle rad, force N, speed m/s) of an Estimate and a Reference (1,).

    Distance and angle are those between the two, the force is the estimated external one, the
    speed that against the normal ``n_W`` (3,), at least zero.
    """
    now, ref = estimate[0], reference[0]
    square, force, leaving = 0.0, 0.0, 0.0
    for k in range(3):
        square += (now["p_WB"][k] - ref["p_WB"][k]) ** 2
        force += now["wrench_B"][k] ** 2
        leaving += n_W[k] * now["v_WB_W"][k]
    cosine = 0.0
    for k in range(4):
        cosine += now["q_WB"][k] * ref["q_WB"][k]
    angle = 2.0 * np.arccos(min(abs(cosine), 1.0))
    return np.sqrt(square), angle, np.sqrt(force), max(-leaving, 0.0)


class ContactContext(Context):
    """The flight as the modes of a fully actuated vehicle see it."""

    inputs: FlightInputs

    def __init__(self, plan: Plan, stack: GuidedStack, judges: Judges, mode: Mode) -> None:
        super().__init__(plan, stack, judges, mode)
        self.guidance: Guidance = stack.guidance
        self.inputs = FlightInputs(0.0, stack.estimate, stack.reference)
        self.dwelling_since_s: float | None = None
        """Since when the set-point of a press is where it shall be."""
        self.waiting_for_surface = False
        """Whether an approach has not begun to move."""
        self.seen: SurfaceEstimate | None = None
        """The last valid estimate; every image overwrites it."""
        self._resting_since_s: float | None = None

    def refresh(self, t_s: float) -> None:
        """Bring the inputs up to date."""
        super().refresh(t_s)
        self.inputs.refresh(t_s)

    def is_fresh(self, need: str) -> bool:
        """Whether ``pose`` or ``surface`` was measured a short time ago."""
        inputs = self.inputs
        if need == "pose":
            return self.t_s - inputs.pose_heard_s <= POSE_AGE_S
        return self.t_s - inputs.surface_seen_s <= STALE_S

    def enter(self, t_s: float, mode: Mode, order: Order) -> None:
        """Note the mode; set what its target allows, and the impedance that it is flown with."""
        super().enter(t_s, mode, order)
        self.armed = True
        self._resting_since_s = None
        self.waiting_for_surface = self.guidance.tracks_surface = False
        target = self.target
        behind = target is not None and mode.name in BEHIND_SURFACE
        self.inputs.press_m = target.press_m if target is not None and behind else 0.0
        self.inputs.least_distance_m = NEAREST_SHARE * target.standoff_m if target else 0.0
        impedance = target.impedance if target else self.plan.impedance
        # After an abort, possibly in contact, nothing changes.
        if mode.phase is not Phase.SAFE and impedance is not None:
            self.guidance.take_impedance(impedance)

    def hear(self, record: Record) -> None:
        """Take an accepted pose, an estimate of the surface, or a sample of an instrument."""
        if isinstance(record, Pose):
            self.inputs.pose_heard_s = record.t_s
        elif isinstance(record, SurfaceEstimate):
            self._see(record)
        else:
            super().hear(record)

    def rested(self, for_s: float = PAUSE_S) -> bool:
        """Whether the reference has been at rest at its goal for so long."""
        if not self.guidance.arrived(self.t_s):
            self._resting_since_s = None
            return False
        if self._resting_since_s is None:
            self._resting_since_s = self.t_s
        return self.t_s - self._resting_since_s >= for_s

    def _see(self, surface: SurfaceEstimate) -> None:
        """Note what the depth camera saw; only a valid estimate counts."""
        if not surface.valid:
            return
        self.seen = surface
        inputs = self.inputs
        inputs.surface_seen_s, inputs.surface_distance_m = surface.t_s, surface.distance
        inputs.surface_n_W[:] = surface.n_W
        target = self.target
        if target is not None and not self.guidance.contradicts(surface.t_s, target, surface):
            inputs.surface_agreed_s = surface.t_s
