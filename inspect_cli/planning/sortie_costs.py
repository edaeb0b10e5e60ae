"""Sorties from a start through some contacts and back: their ways, energies and plans."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.planning.clearance import Scene
from inspect_cli.planning.feasibility import Limits, Reason, cable_reasons, clamp_of
from inspect_cli.planning.legs import Itinerary, leg_of, plan_of
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.planner import check_start, start_postures
from inspect_cli.planning.segments import Stretch
from inspect_cli.planning.sorties import Costs
from inspect_cli.planning.tasks.situation import Situation
from inspect_cli.planning.tasks.touch import ContactSegment
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.start import Start
from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class Base:
    """A place to take off from and to land on, with the cable's clamp under it."""

    start: Start
    standing: Posture
    hover: Posture
    situation: Situation

    @classmethod
    def of(
        cls,
        start: Start,
        capabilities: Capabilities,
        scene: Scene,
        clearance_m: float,
        cable_m: float,
        min_force_n: float,
    ) -> Base:
        """The base at a start.

        Raises:
            InfeasibleError: the vehicle cannot rise from there.
        """
        standing, hover = start_postures(start, capabilities)
        limits = Limits(clearance_m, cable_m, clamp_of(start), min_force_n)
        base = cls(start, standing, hover, Situation(capabilities, scene, limits))
        check_start(base.situation, standing, hover)
        return base

    @property
    def stop(self) -> Stop:
        """Hovering above it."""
        return Stop(self.hover, np.zeros(3))


class SortieCosts:
    """Ways, energies and plans of flights over one mission's structure."""

    def __init__(
        self,
        mission: Mission,
        platform_name: str,
        capabilities: Capabilities,
        surfaces: tuple[PlannedSurface, ...],
        bases: Sequence[Base],
    ) -> None:
        self._mission, self._platform_name = mission, platform_name
        self._capabilities, self._surfaces = capabilities, surfaces
        self._bases = bases
        self._out: dict[tuple[int, str], Way] = {}
        self._between: dict[tuple[str, str], Way] = {}

    def costs(self, segments: Sequence[ContactSegment]) -> tuple[Costs, dict[int, list[Reason]]]:
        """The energies of the segments without those between them, and why some have no way.

        What a base's cable does not span, or no clear way leads to, is infinite.
        """
        shape = (len(self._bases), len(segments))
        out, home = np.full(shape, np.inf), np.full(shape, np.inf)
        reasons: dict[int, list[Reason]] = {}
        for b, base in enumerate(self._bases):
            rise = self._energy_j(base.standing, [Stretch("takeoff", None, (base.hover,))])
            sink = self._energy_j(base.hover, [Stretch("land", None, (base.standing,))])
            for k, segment in enumerate(segments):
                found = self._way_out(b, segment)
                if isinstance(found, list):
                    reasons.setdefault(k, found)
                    continue
                there = [Stretch("transit", 0, found)] if found else []
                home_way = _back(base.hover, found)
                back = [Stretch("transit", None, home_way)] if home_way else []
                out[b, k] = rise + self._energy_j(base.hover, there)
                home[b, k] = sink + self._energy_j(segment.stop.posture, back)
        work = [self._energy_j(segment.stop.posture, segment.stretches(0)) for segment in segments]
        blocked = {k: found for k, found in reasons.items() if not np.isfinite(out[:, k]).any()}
        return Costs(np.array(work), np.empty(0), out, home), blocked

    def between_j(self, segments: Sequence[ContactSegment]) -> Vector:
        """(n − 1,) energies, J, of the ways from each segment to the next; infinite without one."""
        costs_j = np.full(max(len(segments) - 1, 0), np.inf)
        for k, (a, b) in enumerate(pairwise(segments)):
            way = self._bases[0].situation.way(a.stop, b.stop)
            if isinstance(way, list):
                continue
            self._between[a.label, b.label] = way
            transit = [Stretch("transit", k + 1, way)] if way else []
            costs_j[k] = self._energy_j(a.stop.posture, transit)
        return costs_j

    def plan(self, base: int, segments: Sequence[ContactSegment]) -> Plan:
        """The flight from a base through the segments and back, on ways that were found before."""
        at = self._bases[base]
        joined = [replace(segments[0], way=self._out[base, segments[0].label])]
        for a, b in pairwise(segments):
            joined.append(replace(b, way=self._between[a.label, b.label]))
        home = _back(at.hover, self._out[base, segments[-1].label])
        itinerary = Itinerary(at.standing, at.hover, tuple(joined), home)
        mission = self._mission.model_copy(update={"start": at.start})
        return plan_of(mission, self._platform_name, self._capabilities, self._surfaces, itinerary)

    def _way_out(self, b: int, segment: ContactSegment) -> Way | list[Reason]:
        """From hovering over a base to a standoff; the way home is the same, backwards."""
        base = self._bases[b]
        short = cable_reasons(segment.point, base.situation.limits)
        if short:
            return short
        way = base.situation.way(base.stop, segment.stop)
        if not isinstance(way, list):
            self._out[b, segment.label] = way
        return way

    def _energy_j(self, before: Posture, stretches: Iterable[Stretch]) -> float:
        total_j = 0.0
        for stretch in stretches:
            total_j += leg_of(stretch, before, self._mission.flight, self._capabilities)[1]
            before = stretch.postures[-1]
        return total_j


def _back(hover: Posture, way: Way) -> Way:
    """A way from hovering to a stop, flown backwards; empty when it leads nowhere."""
    return (*way[-2::-1], hover) if way else ()
