"""Planners of ``lean`` and ``prop``: postures that carry the push as a load.

Before the surface nothing acts on the vehicle; on it the surface pushes the pressed frame back, and
``Capabilities.solve`` trims the whole posture to that.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import (
    FREE,
    TOOL,
    ForceLaw,
    FramePose,
    Loads,
    Margins,
    Posture,
    Shortfall,
    least,
)
from inspect_cli.planning.clearance import Gap, gap_along
from inspect_cli.planning.feasibility import Reason, gap_reasons, margin_reasons
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.points import in_words, outside
from inspect_cli.planning.segments import Segment, Stretch, margin_models, posture_model, triple
from inspect_cli.planning.tasks.situation import Asked, Planners, Situation
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.arrays import Matrix, Structured, Vector
from inspect_cli.spatial.primitives import normal_at, point_at, project
from inspect_cli.spatial.rotations import matrix_to_quaternion
from pitching_crawler.file_model import FOOT
from pitching_crawler.task_models import RAMP_S, Lean, Push

NEARING_MPS = 0.05
PRESSING_MODES = {TOOL: "leaning", FOOT: "propping"}


@dataclass(frozen=True)
class Place:
    """A place on a surface with its outward normal, (3,) each in W, and the frame's axes there."""

    p_W: Vector
    n_W: Vector
    R: Matrix

    def posture(
        self, situation: Situation, frame: str, near: Posture, away_m: float, loads: Loads
    ) -> Posture | Shortfall:
        """The posture with the frame ``away_m`` from the surface, at rest under the loads."""
        goals = {frame: FramePose(self.p_W + away_m * self.n_W, self.R)}
        return situation.capabilities.solve(goals, loads, near)


@dataclass(frozen=True)
class PushSegment:
    """A frame that is pressed on a surface, and perhaps crawls along it."""

    label: str
    work: Push
    frame: str
    place: Place
    way: Way
    postures: tuple[Posture, ...]
    """Before the surface, pressing, at the crawl's end, before the surface there."""
    margins: Margins
    gap: Gap

    @property
    def stop(self) -> Stop:
        """Before the surface."""
        return Stop(self.postures[-1], self.place.n_W)

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Nothing hangs on a cable."""
        return ()

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Up to the surface, press, perhaps crawl, leave."""
        _, pressing, end, after = self.postures
        creep = {"speed_mps": NEARING_MPS}
        yield Stretch("nearing", index, (pressing,), **creep)
        yield Stretch(PRESSING_MODES[self.frame], index, (pressing,), RAMP_S + self.work.dwell_s)
        if end is not pressing and isinstance(self.work, Lean):
            moving_s = self.work.crawl_m / self.work.crawl_mps + RAMP_S
            yield Stretch("crawling", index, (end,), 0.0, moving_s, self.work.crawl_mps)
        yield Stretch("leaving", index, (after,), **creep)

    def target(self, index: int) -> Target:
        """A contact of the tool, or a perch of the foot."""
        before, pressing, _, _ = self.postures
        w, x, y, z = (float(value) for value in matrix_to_quaternion(self.place.R))
        return Target(
            index=index,
            label=self.label,
            kind="contact" if self.frame == TOOL else "perch",
            surface=self.work.on,
            uv_m=self.work.at_m,
            p_WC=triple(self.place.p_W),
            n_W=triple(self.place.n_W),
            q_WT=(w, x, y, z),
            sensor=None,
            law=ForceLaw(self.work.force_n),
            dwell_s=self.work.dwell_s,
            standoff_m=self.work.standoff_m,
            standoff=posture_model(before),
            contact=posture_model(pressing),
            margins=margin_models(self.margins),
            clearance_m=self.gap.structure_m,
        )


@dataclass(frozen=True)
class PushPlanner:
    """Press a frame of the vehicle on a surface."""

    label: str
    work: Push
    frame: str
    prim: Structured

    @property
    def name(self) -> str:
        """The place and its surface."""
        return f"push {self.label} on '{self.work.on}'"

    def plan(self, situation: Situation, before: Stop) -> Segment | list[Reason]:
        """The trimmed postures and the way to the first, or what speaks against them."""
        u, v = self.work.at_m
        if fault := outside(self.prim, u, v):
            return [Reason(fault, "push on the patch, or enlarge it")]
        place = self._place(situation, u, v, before.posture)
        end = self._end(place, situation, before.posture)
        if isinstance(end, str):
            return [Reason(end, "crawl less far, or enlarge the patch")]
        pushed = {self.frame: np.concatenate([self.work.force_n * place.n_W, np.zeros(3)])}
        postures = []
        for spot, away_m, loads in (
            (place, self.work.standoff_m, FREE),
            (place, 0.0, pushed),
            (end, 0.0, pushed),
            (end, self.work.standoff_m, FREE),
        ):
            near = postures[-1] if postures else before.posture
            found = spot.posture(situation, self.frame, near, away_m, loads)
            if isinstance(found, Shortfall):
                what = f"no posture brings the {self.frame} to {in_words(spot.p_W)}"
                return [Reason(f"{what}: {found.reason}", found.hint)]
            postures.append(found)
        if end is place:
            postures[2:] = postures[1], postures[0]
        return self._checked(situation, place, tuple(postures), pushed, before)

    def _checked(
        self,
        situation: Situation,
        place: Place,
        postures: tuple[Posture, ...],
        pushed: Loads,
        before: Stop,
    ) -> Segment | list[Reason]:
        able = situation.capabilities
        free, loaded = able.margins(postures[0], FREE), able.margins(postures[1], pushed)
        gap = gap_along(able, situation.scene, postures)
        reasons = [
            *margin_reasons(free, "holding still before it"),
            *margin_reasons(loaded, f"pushing with {self.work.force_n:.2f} N"),
            *gap_reasons(gap, situation.limits.clearance_m),
        ]
        if reasons:
            return reasons
        way = situation.way(before, Stop(postures[0], place.n_W))
        if isinstance(way, list):
            return way
        margins = least([free, loaded])
        return PushSegment(self.label, self.work, self.frame, place, way, postures, margins, gap)

    def _place(self, situation: Situation, u: float, v: float, near: Posture) -> Place:
        """The place at (u, v): z of the frame into the surface; a ceiling leaves the heading."""
        n_W = normal_at(self.prim, 0, u, v)
        z = -n_W
        side = np.cross([0.0, 0.0, 1.0], z)
        if np.linalg.norm(side) < 0.1:
            _, R_WF = situation.capabilities.frame_pose(near, FOOT)
            side = np.cross(z, R_WF[:, 0])
        y = side / np.linalg.norm(side)
        R = np.ascontiguousarray(np.column_stack([np.cross(y, z), y, z]))
        return Place(point_at(self.prim, 0, u, v), n_W, R)

    def _end(self, place: Place, situation: Situation, near: Posture) -> Place | str:
        """Where a crawl upwards ends; the place itself without one, and why it cannot end there."""
        if not isinstance(self.work, Lean) or self.work.crawl_m == 0.0:
            return place
        up_W = np.array([0.0, 0.0, 1.0]) - place.n_W[2] * place.n_W
        top_W = place.p_W + self.work.crawl_m * up_W / np.linalg.norm(up_W)
        u, v, _ = project(self.prim, 0, top_W)
        return outside(self.prim, u, v) or self._place(situation, u, v, near)


def lean_planners(asked: Asked) -> Planners:
    """One planner, of the wheel."""
    return _planners(asked, TOOL)


def prop_planners(asked: Asked) -> Planners:
    """One planner, of the foot."""
    return _planners(asked, FOOT)


def _planners(asked: Asked, frame: str) -> Planners:
    work = asked.task.work
    assert isinstance(work, Push)  # the registry has looked it up by its kind
    planner = PushPlanner(str(asked.number), work, frame, asked.prims[work.on])
    return Planners((planner,), asked.tip_W)
