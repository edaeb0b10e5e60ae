"""Marks that appear on the structure during the flight: points to touch, readings, strokes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.instruments import INSTRUMENTS
from inspect_cli.records import Reference
from inspect_cli.scene.materials import PLANNED, TRACE, Rgba
from inspect_cli.scene.motion import Motion
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.result import PointResult, Result
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.spatial.primitives import normal_at, point_at, project

LEAST_READING_M, MOST_READING_M = 0.012, 0.035
PLANNED_SHARE, TRACE_M = 0.3, 0.005
TRACE_SPACING_M = 0.008
MOST_TRACES = 600
UNCLASSED = "unclassed"
INVALID = "invalid"


class MarkStyle(Protocol):
    """How a class of readings is drawn: its name for people, colour (#rrggbb) and shape."""

    @property
    def label(self) -> str:
        """What the legend calls it."""
        ...

    @property
    def colour(self) -> str:
        """As #rrggbb."""
        ...

    @property
    def symbol(self) -> str:
        """``circle``, ``square``, ``diamond``; anything else is a small disc."""
        ...


@dataclass(frozen=True, eq=False)
class Mark:
    """A flat shape on a surface."""

    p_W: Vector
    n_W: Vector
    radius_m: float
    rgba: Rgba
    symbol: str
    from_s: float
    """Time from which it is visible, s."""
    until_s: float = np.inf
    """Time at which it vanishes, s."""
    meaning: str = ""
    """The class of readings that it stands for."""


def marks_of(
    log: RunLog, plan: Plan, result: Result, motion: Motion, styles: Mapping[str, MarkStyle]
) -> list[Mark]:
    """Every mark of a flight.

    ``styles`` by ASTM class, with 'invalid' for readings that do not count.
    """
    radius = _reading_radius(plan)
    readings = _readings(log, plan, result, styles, radius)
    taken = {target: mark.from_s for target, mark in readings.items()}
    touched = [t for t in plan.targets if t.kind == "contact"]
    planned = [
        Mark(
            np.array(target.p_WC),
            np.array(target.n_W),
            PLANNED_SHARE * radius,
            PLANNED,
            "circle",
            -np.inf,
            taken.get(target.index, np.inf),
        )
        for target in touched
    ]
    return [*planned, *readings.values(), *_traces(log, plan, motion)]


def _reading_radius(plan: Plan) -> float:
    """Radius of a reading's mark, m: 0.36 of the least distance between two points, within
    bounds."""
    p_W = np.array([t.p_WC for t in plan.targets if t.kind == "contact"])
    if len(p_W) < 2:
        return MOST_READING_M
    apart = np.linalg.norm(p_W[:, None] - p_W[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    return float(np.clip(0.36 * apart.min(), LEAST_READING_M, MOST_READING_M))


def _readings(
    log: RunLog, plan: Plan, result: Result, styles: Mapping[str, MarkStyle], radius: float
) -> dict[int, Mark]:
    """By the target's index: its last reading."""
    kinds = (INSTRUMENTS[name].reader.reading for name in plan.instruments)
    found = (rows for rows in map(log.rows, kinds) if rows is not None)
    points = {point.index: point for point in result.points}
    marks: dict[int, Mark] = {}
    for row in (row for rows in found for row in rows):
        index = int(row["target"]) if np.isfinite(row["target"]) else -1
        if index not in points or not np.all(np.isfinite(row["p_WT"])):
            continue
        target, point = plan.targets[index], points[index]
        meaning = _meaning(point)
        style = styles.get(meaning)
        p_W, n_W = _on_surface(plan, target, row["p_WT"])
        rgba = rgba_of(style.colour) if style else PLANNED
        symbol = style.symbol if style else "circle"
        size = radius if symbol in ("circle", "square", "diamond") else 0.6 * radius
        mark = Mark(p_W, n_W, size, rgba, symbol, float(row["t_s"]), meaning=meaning)
        marks[index] = mark
    return marks


def _meaning(point: PointResult) -> str:
    if not point.valid:
        return INVALID
    return point.astm_class or UNCLASSED


def rgba_of(colour: str) -> Rgba:
    """A colour written #rrggbb as four numbers from 0 to 1."""
    red, green, blue = (int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5))
    return (red, green, blue, 1.0)


def _on_surface(plan: Plan, target: Target, p_W: Vector) -> tuple[Vector, Vector]:
    """(p_W, n_W) of a mark: where the tool was, never hidden behind the surface."""
    surface = next((s for s in plan.surfaces if s.name == target.surface), None)
    if surface is None:
        return np.array(p_W), np.array(target.n_W)
    patch = primitive_of(surface.shape)
    u, v, w = project(patch, 0, np.array(p_W))
    n = normal_at(patch, 0, u, v)
    return point_at(patch, 0, u, v) + max(float(w), 0.0) * n, n


def _traces(log: RunLog, plan: Plan, motion: Motion) -> list[Mark]:
    """Dots along what the tool slid over, as close as ``MOST_TRACES`` of them allow."""
    rows = log.rows(Reference)
    if rows is None:
        return []
    sliding = rows[log.modes().within(rows["mode"], {Phase.CONTACT}, slides=True)]
    sliding = sliding[sliding["t_s"] <= motion.t_s[-1]]
    places = [int(k) for k in motion.at(sliding["t_s"])]
    dots: list[Mark] = []
    for k, row in zip(places, sliding, strict=True):
        index = int(row["target"])
        if not 0 <= index < len(plan.targets):
            continue
        p_W = motion.p_WT[k]
        if dots and np.linalg.norm(p_W - dots[-1].p_W) < TRACE_SPACING_M:
            continue
        on_W, n_W = _on_surface(plan, plan.targets[index], p_W)
        dots.append(Mark(on_W, n_W, TRACE_M, TRACE, "circle", float(row["t_s"])))
    return dots[:: -(-len(dots) // MOST_TRACES)] if dots else []


def places(marks: Sequence[Mark]) -> Points:
    """Positions (n, 3) of the marks, W, m."""
    return np.array([mark.p_W for mark in marks]).reshape(-1, 3)
