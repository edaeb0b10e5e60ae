"""A two-point plan, and a guidance, a judge and a vehicle that do as the test says."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from inspect_cli.autonomy.executive import Executive
from inspect_cli.autonomy.modes import Behaviour
from inspect_cli.interfaces import DepthLaw, Posture
from inspect_cli.records import (
    Command,
    DepthImage,
    Estimate,
    InvalidReason,
    Pose,
    Probe,
    Reading,
    Record,
    Reference,
    SurfaceEstimate,
)
from inspect_cli.schema.plan import Leg, LegKind, MarginModel, Plan, PostureModel, Target
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR

TICK_S = 0.02
STANDOFF_M, PRESS_M = 0.25, 0.10
APPROACH_MPS, PRESS_MPS, RETREAT_MPS, TRANSIT_MPS = 0.1, 0.12, 0.15, 0.5
TIME_LIMIT_S = 100.0


def posture(x: float, z: float = 1.0) -> PostureModel:
    return PostureModel(p_WB=(x, 0.0, z), q_WB=(1.0, 0.0, 0.0, 0.0))


def target(index: int) -> Target:
    return Target(
        index=index,
        label=f"A{index + 1}",
        kind="contact",
        impedance="contact_ndt",
        surface="wall",
        uv_m=(0.0, 0.0),
        p_WC=(2.0, float(index), 1.0),
        n_W=(-1.0, 0.0, 0.0),
        q_WT=(1.0, 0.0, 0.0, 0.0),
        sensor="half_cell",
        law=DepthLaw(PRESS_M, "contact_ndt", 1.8),
        dwell_s=3.0,
        standoff_m=STANDOFF_M,
        standoff=posture(1.2),
        contact=posture(1.45),
        margins={"thrust": MarginModel(value=5.0, unit="N")},
        clearance_m=0.5,
    )


def two_point_plan() -> Plan:
    def leg(kind: LegKind, target: int | None, speed: float, x: float, z: float = 1.0) -> Leg:
        at = (posture(x, z),)
        return Leg(kind=kind, target=target, postures=at, speed_mps=speed, duration_s=1.0)

    legs = [leg("takeoff", None, TRANSIT_MPS, 0.0)]
    for index in (0, 1):
        legs += [
            leg("transit", index, TRANSIT_MPS, 1.2),
            leg("approach", index, APPROACH_MPS, 1.44),
            leg("press", index, PRESS_MPS, 1.55),
            leg("retreat", index, RETREAT_MPS, 1.2),
        ]
    legs += [leg("transit", None, TRANSIT_MPS, 0.0), leg("land", None, TRANSIT_MPS, 0.0, 0.2)]
    return Plan(
        mission="scripted",
        platform="scripted",
        impedance="contact_ndt",
        surfaces=(),
        start=posture(0.0, 0.2),
        targets=(target(0), target(1)),
        legs=tuple(legs),
        duration_s=20.0,
        energy_wh=1.0,
        path_m=5.0,
        cable_m=2.0,
    )


def target_is_unknown(calls: list[tuple[str, float, float]]) -> bool:
    """Only what nobody described, the third target of a plan of work, is aimed at by sight."""
    return calls[-1][0] == "approach A3"


@dataclass
class FakeGuidance:
    """Writes down what it is asked; arrives ``takes_s`` later, or when the test says."""

    tracks_surface: bool = False
    takes_s: float = 1.0
    calls: list[tuple[str, float, float]] = field(default_factory=list)
    """(what, depth or height of the goal, speed)."""
    arrival_s: float = 0.0
    impedances: list[str] = field(default_factory=list)
    observed: list[float] = field(default_factory=list)
    """When the surfaces were seen that the executive passed on."""
    contradicted: bool = False
    """What the next surfaces do to the plan."""

    def go_to(self, t_s: float, postures: Sequence[Posture], speed_mps: float) -> None:
        self._ask(t_s, "go_to", float(postures[-1].p_WB[2]), speed_mps)

    def approach(self, t_s: float, target: Target, depth_m: float, speed_mps: float) -> None:
        self._ask(t_s, f"approach {target.label}", depth_m, speed_mps)

    def observe(self, t_s: float, surface: SurfaceEstimate) -> None:
        assert target_is_unknown(self.calls), "the loop hands the others to guidance"
        self.observed.append(surface.t_s)

    def take_impedance(self, name: str) -> None:
        self.impedances.append(name)

    def slide(self, t_s: float, target: Target) -> None:
        self._ask(t_s, f"slide {target.label}", 0.0, 0.0)

    def contradicts(self, t_s: float, target: Target, surface: SurfaceEstimate) -> bool:
        return self.contradicted

    def hold(self, t_s: float) -> None:
        self._ask(t_s, "hold", 0.0, 0.0)

    def arrived(self, t_s: float) -> bool:
        return t_s >= self.arrival_s

    def _ask(self, t_s: float, what: str, value: float, speed_mps: float) -> None:
        self.calls.append((what, value, speed_mps))
        self.arrival_s = t_s + self.takes_s


class FakeStack:
    """Estimates nothing and controls nothing; what the modes need of a stack."""

    def __init__(self, guidance: FakeGuidance) -> None:
        self.guidance = guidance
        self.estimate = Estimate.create()
        self.reference = Reference.create()
        self.command = Command.create()
        self.estimate.q_WB[0] = self.reference.q_WB[0] = 1.0
        self.armed = False
        self.loops: Mapping[str, int] = {}

    def start(self, pose: Pose) -> None: ...

    def hear(self, sample: Record | DepthImage) -> Record | None:
        return sample if isinstance(sample, Record) else None

    def enter(self, t_s: float, mode: str, target: int | None) -> None: ...

    def run(self, loop: str, t_s: float) -> None: ...

    def refer(self, t_s: float) -> None: ...

    def control(self, t_s: float) -> None: ...

    def believed(self, frame: str) -> tuple[Vector, Matrix]:
        return np.zeros(3), np.eye(3)


@dataclass
class FakeJudge:
    """Decides after ``takes_s``."""

    takes_s: float = 2.0
    aside_m: float = 0.0
    """How far from its point the tool stands, along the surface."""
    deep_m: float = 0.0
    """The same across it."""
    fed: int = 0
    target: int = -1
    begun_s: float = 0.0

    def begin(self, target: int, t_s: float) -> None:
        self.target, self.begun_s = target, t_s

    def feed(self, probe: Probe, p_WT: Vector) -> None:
        self.fed += 1

    def done(self, t_s: float) -> bool:
        return t_s - self.begun_s >= self.takes_s

    def finish(self, t_s: float) -> Reading:
        reading = Reading.create()
        reading.t_s, reading.target, reading.valid = t_s, float(self.target), 1.0
        reading.reason = float(InvalidReason.NONE)
        reading.p_WT[:] = [2.0 + self.deep_m, self.target + self.aside_m, 1.0]
        return reading


class Script:
    """Steps an executive through time; poses and surfaces come as long as they are on."""

    def __init__(self, plan: Plan | None = None, behaviour: Behaviour = BEHAVIOUR) -> None:
        self.guidance = FakeGuidance()
        self.stack = FakeStack(self.guidance)
        self.judges: list[FakeJudge] = []
        self.estimate = self.stack.estimate
        self.poses = self.surfaces = True
        self.distance_m = 0.25
        self.blind_after_s = float("inf")
        self._seen = SurfaceEstimate.create()
        self.t_s = 0.0
        self.context = behaviour.context(
            plan or two_point_plan(), self.stack, {"half_cell": self._judge}
        )
        self.executive = Executive(behaviour, self.context, TIME_LIMIT_S)
        self.modes: list[tuple[str, int]] = []

    def _judge(self, target: Target) -> FakeJudge:
        self.judges.append(FakeJudge())
        return self.judges[-1]

    @property
    def mode(self) -> str:
        return self.executive.mode.name

    @property
    def target(self) -> int:
        return int(self.stack.reference.target)

    def step(self) -> None:
        """One period of the mission rate."""
        if self.poses:
            pose = Pose.create()
            pose.t_s = self.t_s
            self.executive.hear(pose)
        if self.surfaces:
            seen = self._seen
            seen.t_s, seen.distance = self.t_s, self.distance_m
            seen.valid = float(self.t_s < self.blind_after_s)
            self.executive.hear(seen)
        self.executive.hear(Probe.create())
        self.executive.update(self.t_s)
        now = (self.mode, self.target)
        if not self.modes or self.modes[-1] != now:
            self.modes.append(now)
        self.t_s += TICK_S

    def run(self, duration_s: float) -> None:
        for _ in range(round(duration_s / TICK_S)):
            self.step()

    def run_until(self, condition: Callable[[], bool], limit_s: float = 200.0) -> float:
        """Step until something is so; how long that took."""
        begun = self.t_s
        while not condition():
            assert self.t_s - begun < limit_s, f"still {self.mode}"
            self.step()
        return self.t_s - begun

    def run_to(self, mode: str, target: int | None = None) -> float:
        """Step until a mode begins."""
        wanted = (mode, self.target if target is None else target)
        return self.run_until(
            lambda: self.mode == mode and (target is None or self.modes[-1] == wanted)
        )
