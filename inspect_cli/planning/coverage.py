"""Covering a surface: its points, those left out and why, their order, and the sorties.

Of the two ways to turn the tool at a point the one with more thrust to spare is taken (more of the
vehicle's first margin), whichever way leads there; it also takes less energy. Turning about costs
time, so the order counts it as a distance. A point that cannot be touched is listed with its
reasons and does not refuse the mission.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inspect_cli.errors import InfeasibleError, Problem
from inspect_cli.interfaces import TOOL, Capabilities, Margins, Shortfall
from inspect_cli.planning.clearance import Scene
from inspect_cli.planning.feasibility import Reason, assess, cable_span_m
from inspect_cli.planning.lattice import Place, along_m, lattice
from inspect_cli.planning.legs import JOULE_PER_WH
from inspect_cli.planning.order import shortest
from inspect_cli.planning.points import ContactPoint, in_words, point_on
from inspect_cli.planning.segments import triple
from inspect_cli.planning.sortie_costs import Base, SortieCosts
from inspect_cli.planning.sorties import Costs, split
from inspect_cli.planning.tasks.situation import unreachable
from inspect_cli.planning.tasks.touch import ContactSegment
from inspect_cli.schema.coverage import CoveragePlan, Skipped, Sortie
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.tasks import Task
from inspect_cli.schema.tasks.base import MAX_POINTS
from inspect_cli.schema.tasks.coverage import Coverage
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.spatial.primitives import raycast

WORTH_TURNING = {"N": 0.5, "rad": 0.05, "N·m": 0.05, "m": 0.01}
"""By its unit, what more of the vehicle's first margin is worth another heading than that of the
first start."""
CLEAR_OF_OWN_M = 1e-3
"""From the surface to where the look ahead begins, so that it does not see the surface itself."""


@dataclass(frozen=True)
class Batch:
    """Flights through some of a surface's points, and the points that were left out."""

    plans: tuple[Plan, ...]
    skipped: tuple[Skipped, ...]
    tour_m: float


class Surveyor:
    """Plans the coverage of one surface; what holds for every point is kept here."""

    def __init__(
        self,
        mission: Mission,
        platform_name: str,
        capabilities: Capabilities,
        surfaces: tuple[PlannedSurface, ...],
        cable_m: float,
        min_force_n: float,
        battery_wh: float,
    ) -> None:
        task = mission.tasks[0]
        assert isinstance(task.work, Coverage)  # who asks for a survey has looked
        self.task: Task = task
        self.coverage: Coverage = task.work
        self.budget_wh = (1.0 - self.coverage.reserve) * battery_wh
        shapes = {surface.name: surface.shape for surface in surfaces}
        self.prim = primitive_of(shapes[self.coverage.on])
        self._mission, self._capabilities = mission, capabilities
        self._scene = Scene.of(surfaces)
        self._bases = self._made_bases(cable_m, min_force_n)
        self._sortie_costs = SortieCosts(
            mission, platform_name, capabilities, surfaces, self._bases
        )

    def survey(self) -> CoveragePlan:
        """The whole survey.

        Raises:
            InfeasibleError: no point at all can be visited; with every reason.
        """
        coverage = self.coverage
        edge_m = 0.5 * coverage.pitch_m if coverage.edge_m is None else coverage.edge_m
        self._check_count()
        places = lattice(self.prim, coverage.pitch_m, edge_m, coverage.offset_m)
        if not places:
            raise InfeasibleError(
                f"coverage: no point of '{coverage.on}' is {edge_m:g} m from its edge",
                hint="give a smaller edge_m, or a larger surface",
            )
        batch = self.batch([(str(k), place) for k, place in enumerate(places, 1)])
        if not batch.plans:
            raise InfeasibleError(_problems(batch.skipped))
        sorties = [Sortie(number=k, plan=plan) for k, plan in enumerate(batch.plans, 1)]
        return CoveragePlan.of(sorties, batch.skipped, batch.tour_m, self.budget_wh)

    def batch(self, places: Iterable[tuple[str, Place]]) -> Batch:
        """Flights through the points at labelled places."""
        segments: list[ContactSegment] = []
        skipped: list[Skipped] = []
        for label, place in places:
            point = self._point(label, place)
            found = self._segment(point)
            if isinstance(found, ContactSegment):
                segments.append(found)
            else:
                skipped.append(_skipped(point, found))
        costs, segments, further = self._affordable(segments)
        skipped += further
        order = self._order(segments)
        ordered = [segments[k] for k in order]
        costs = replace(
            costs,
            work=costs.work[order],
            out=costs.out[:, order],
            home=costs.home[:, order],
            between=self._sortie_costs.between_j(ordered),
        )
        stages = split(costs, self.budget_wh * JOULE_PER_WH)
        plans = [
            self._sortie_costs.plan(stage.start, ordered[stage.first : stage.last + 1])
            for stage in stages
        ]
        return Batch(tuple(plans), tuple(skipped), self._tour_m(ordered))

    def _check_count(self) -> None:
        """Refuse a pitch that is too small before a list of its points is made."""
        coverage = self.coverage
        count = float(np.prod(2.0 * self.prim["half_size"][0] / coverage.pitch_m))
        if count > MAX_POINTS:
            raise InfeasibleError(
                f"coverage: '{coverage.on}' holds some {count:.0f} points at a pitch of "
                f"{coverage.pitch_m:g} m; at most {MAX_POINTS} in one mission",
                hint="give a larger pitch_m",
            )

    def _made_bases(self, cable_m: float, min_force_n: float) -> list[Base]:
        starts = self.coverage.starts or (self._mission.start,)
        clearance_m = self._mission.flight.clearance_m
        return [
            Base.of(start, self._capabilities, self._scene, clearance_m, cable_m, min_force_n)
            for start in starts
        ]

    def _point(self, label: str, place: Place) -> ContactPoint:
        impedance = self.task.impedance or self._mission.impedance
        coverage, sensor = self.coverage, self.task.instrument
        cell_m = (coverage.pitch_m, coverage.pitch_m)
        return point_on(
            self.prim, place, label, coverage.on, coverage, impedance, sensor, cell_m=cell_m
        )

    def _segment(self, point: ContactPoint) -> ContactSegment | list[Reason]:
        """How a point is touched, without the way to it, or why it cannot be."""
        reasons = [*_faults(point), *self._kept_out(point), *self._hidden(point)]
        if reasons:
            return reasons
        nearest = min(
            self._bases, key=lambda base: cable_span_m(point, base.situation.limits.clamp_W)
        )
        capabilities, scene = self._capabilities, self._scene
        ways = nearest.situation.touches(point, self._bases[0].hover)
        if isinstance(ways, Shortfall):
            return [unreachable(point, ways)]
        best: ContactSegment | None = None
        for touch in ways:
            found = assess(capabilities, scene, point, touch, nearest.situation.limits)
            if found.reasons:
                reasons = reasons or list(found.reasons)
            elif best is None or _worth_turning(found.margins, best.assessment.margins):
                best = ContactSegment(point, self.coverage, touch, (), found)
        return best or reasons

    def _kept_out(self, point: ContactPoint) -> list[Reason]:
        reasons = []
        for zone in self.coverage.keep_out:
            apart_m = along_m(self.prim, point.uv_m, zone.at_m)
            if apart_m <= zone.radius_m:
                where = in_words(zone.at_m)
                what = f"kept out: {apart_m:.3f} m from {where}, radius_m is {zone.radius_m:g}"
                reasons.append(Reason(what))
        return reasons

    def _hidden(self, point: ContactPoint) -> list[Reason]:
        """Whether another believed surface stands between the point and the standoff."""
        ahead = np.ascontiguousarray(point.n_W).reshape(1, 3)
        origin_W = point.in_front(CLEAR_OF_OWN_M)
        found = np.empty(1)
        for i, name in enumerate(self._scene.names):
            prim = self._scene.prims[i : i + 1]
            raycast(prim, origin_W, ahead, point.options.standoff_m, found)
            if np.isfinite(found[0]):
                what = f"hidden: '{name}' stands {found[0] + CLEAR_OF_OWN_M:.3f} m in front of it"
                return [Reason(what)]
        return []

    def _affordable(
        self, segments: list[ContactSegment]
    ) -> tuple[Costs, list[ContactSegment], list[Skipped]]:
        """The energies of the segments that a flight of their own could make, and the others."""
        costs, reasons = self._sortie_costs.costs(segments)
        alone_j = costs.alone()
        skipped, kept = [], []
        for k, segment in enumerate(segments):
            alone_wh = alone_j[k] / JOULE_PER_WH
            if alone_wh <= self.budget_wh:
                kept.append(k)
                continue
            what = (
                f"a flight to it alone takes {alone_wh:.2f} Wh, the battery gives "
                f"{self.budget_wh:.2f} Wh above its reserve"
            )
            skipped.append(_skipped(segment.point, reasons.get(k) or [Reason(what)]))
        chosen = replace(
            costs, work=costs.work[kept], out=costs.out[:, kept], home=costs.home[:, kept]
        )
        return chosen, [segments[k] for k in kept], skipped

    def _order(self, segments: Sequence[ContactSegment]) -> list[int]:
        """The shortest way through the standoffs, turning about counted as a distance.

        In the time of a turn by θ at the rate ω the vehicle covers v θ / ω. The tool's level axis
        y_T, drawn out to v π / 2ω, is a further place: a half turn is v π / ω away.
        """
        if not segments:
            return []
        capabilities = self._capabilities
        speed_mps = min(self._mission.flight.speed_mps, capabilities.max_speed_mps)
        reach_m = 0.5 * np.pi * speed_mps / capabilities.max_angular_rate_radps
        first_y = capabilities.frame_pose(self._bases[0].hover, TOOL)[1][:, 1]
        ys = np.array([segment.touch.R_WT[:, 1] for segment in segments])
        places = np.hstack([_tips(segments), reach_m * ys])
        return shortest(places, np.concatenate([self._first_tip(), reach_m * first_y]))

    def _first_tip(self) -> Vector:
        return self._capabilities.frame_pose(self._bases[0].hover, TOOL)[0]

    def _tour_m(self, ordered: Sequence[ContactSegment]) -> float:
        if not ordered:
            return 0.0
        path = np.vstack([self._first_tip(), _tips(ordered)])
        return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def _worth_turning(margins: Margins, others: Margins) -> bool:
    """Whether a posture's first margin is so much larger than another posture's."""
    name, margin = next(iter(margins.items()), ("", None))
    if margin is None:
        return False
    return margin.value > others[name].value + WORTH_TURNING.get(margin.unit, 0.0)


def _tips(segments: Sequence[ContactSegment]) -> Points:
    """The tool's tips (n, 3) m in W at the standoffs."""
    return np.array([segment.point.in_front(segment.options.standoff_m) for segment in segments])


def _faults(point: ContactPoint) -> list[Reason]:
    return [Reason(point.fault)] if point.fault else []


def _skipped(point: ContactPoint, reasons: Sequence[Reason]) -> Skipped:
    return Skipped(
        label=point.label,
        surface=point.surface,
        uv_m=point.uv_m,
        p_WC=triple(point.p_WC),
        reason="; ".join(reason.what for reason in reasons),
    )


def _problems(skipped: Sequence[Skipped]) -> list[Problem]:
    """One problem for each reason, with the points that share it."""
    groups: dict[str, list[str]] = {}
    for point in skipped:
        groups.setdefault(point.reason, []).append(point.label)
    return [
        Problem(f"coverage: no point can be visited: {', '.join(labels)}: {reason}")
        for reason, labels in groups.items()
    ]
