"""Figures over time: panels on one time axis, thinned for the screen, contacts shaded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inspect_cli.reporting.figures.figure import Figure, Json, merged, numbers, words
from inspect_cli.reporting.figures.palette import CONTACT_SHADE, MUTED, LineStyle
from inspect_cli.reporting.words.text import Text, say
from inspect_cli.schema.modes import OFF_GROUND, ModeTable, Phase
from inspect_cli.schema.plan import Plan
from inspect_cli.spatial.arrays import Mask, Structured, Vector

BUCKETS = 800
"""Buckets per line; each keeps its smallest and largest sample. About one per pixel."""
MAX_LABELLED_PHASES = 40
LARGEST_DRAWN = 1e6
"""Larger values come from a diverged simulation; an axis that includes them shows nothing else."""
TIME = say("time (s)")
PANEL_GAP_PX = 14
TOP_PX = 64
BOTTOM_PX = 44


@dataclass(frozen=True)
class Span:
    """A stretch of time in contact, and the label of the point that was touched."""

    start_s: float
    end_s: float
    label: Text


@dataclass(frozen=True)
class Mark:
    """A moment with a label, and which end of the label is at it."""

    t_s: float
    label: Text
    anchor: str = "center"


@dataclass(frozen=True)
class Timeline:
    """The common time axis of figures: contacts, drawn window, time off the ground."""

    phases: tuple[Span, ...] = ()
    """The contacts, or other stretches to shade."""
    off_ground_s: tuple[float, float] | None = None
    """From the end of the take-off to the beginning of the landing."""
    marks: tuple[Mark, ...] = ()
    window_s: tuple[float, float] | None = None
    """The stretch that is drawn; without it, everything."""
    title: Text = TIME
    of_the_log: bool = True
    """Whether times are the log's; such figures zoom together."""

    def within(self, window_s: tuple[float, float]) -> Timeline:
        """The same, drawn and scaled for a stretch of time."""
        return replace(self, window_s=window_s, off_ground_s=window_s)


@dataclass(frozen=True)
class Line:
    """One signal: times (n,), values (n,), and how it looks."""

    t_s: Vector
    values: Vector
    style: LineStyle
    extra: Json | None = None
    """Entries of the plotly trace that differ from a plain line's."""


@dataclass(frozen=True)
class Panel:
    """Signals that share a value axis."""

    title: Text
    lines: Sequence[Line]
    axis: Json | None = None
    """Entries of the plotly axis that differ from the defaults."""
    height_px: int = 120
    off_ground: bool = False
    """Whether the value axis is scaled to the time off the ground, where the forces of the
    ground and a reference below it would hide everything else."""


def thinned(t_s: Vector, values: Vector) -> tuple[Vector, Vector]:
    """At most two samples per bucket of equal sample count: its smallest and its largest.

    Unlike a plain stride this keeps every peak. A bucket that holds nothing but NaN stays a
    gap. Shorter series are returned as they are.
    """
    n = len(t_s)
    if n <= 2 * BUCKETS:
        return t_s, values
    size = -(-n // BUCKETS)
    starts = np.arange(0, n, size)
    padded = np.full(len(starts) * size, np.nan)
    padded[:n] = values
    rows = padded.reshape(-1, size)
    lowest = np.where(np.isnan(rows), np.inf, rows).argmin(axis=1)
    highest = np.where(np.isnan(rows), -np.inf, rows).argmax(axis=1)
    keep = np.unique(np.concatenate([starts + lowest, starts + highest]))
    return t_s[keep], values[keep]


def timeline_of(reference: Structured | None, plan: Plan, modes: ModeTable) -> Timeline:
    """Contacts and time off the ground, by the modes of the mission executive."""
    if reference is None:
        return Timeline()
    return Timeline(_contact_phases(reference, plan, modes), _off_ground_s(reference, modes))


def _off_ground_s(reference: Structured, modes: ModeTable) -> tuple[float, float] | None:
    """From the end of the take-off to the landing, or the take-off if nothing came after it."""
    t_s, mode = reference["t_s"], reference["mode"]
    rows = np.flatnonzero(modes.within(mode, OFF_GROUND | {Phase.SAFE}))
    if len(rows) == 0:
        rows = np.flatnonzero(modes.within(mode, {Phase.NEAR_GROUND}))
        return (float(t_s[rows[0]]), float(t_s[rows[-1]])) if len(rows) else None
    low = modes.within(mode[rows[0] :], {Phase.NEAR_GROUND, Phase.GROUND})
    end = rows[0] + int(np.argmax(low)) - 1 if low.any() else rows[-1]
    return float(t_s[rows[0]]), float(t_s[end])


def _contact_phases(reference: Structured, plan: Plan, modes: ModeTable) -> tuple[Span, ...]:
    """The stretches in which the executive was pressing, with the label of their point."""
    t_s = reference["t_s"]
    labels = {target.index: target.label for target in plan.targets}
    return tuple(
        Span(
            float(t_s[first]),
            float(t_s[min(end, len(t_s) - 1)]),
            labels.get(int(reference["target"][first]), ""),
        )
        for first, end in stretches(modes.within(reference["mode"], {Phase.CONTACT}))
    )


def stretches(inside: Mask) -> list[tuple[int, int]]:
    """First row of each stretch of True, and the row after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(np.int8)))
    return [(int(first), int(end)) for first, end in edges.reshape(-1, 2)]


def alike(panels: Sequence[Panel], window_s: tuple[float, float]) -> list[Panel]:
    """The panels with one range of values for all, so that they can be compared by eye."""
    lines = [line for panel in panels for line in panel.lines]
    axis = _value_range(lines, window_s)
    return [replace(panel, axis=merged(axis, panel.axis or {})) for panel in panels]


def stacked(
    name: str,
    caption: Text,
    description: Text,
    panels: Sequence[Panel],
    timeline: Timeline,
) -> Figure:
    """Panels one under the other on one time axis."""
    heights = np.array([panel.height_px for panel in panels], dtype=float)
    drawn_px = heights.sum() + PANEL_GAP_PX * (len(panels) - 1)
    tops = drawn_px - np.concatenate([[0.0], np.cumsum(heights + PANEL_GAP_PX)[:-1]])
    traces: list[Json] = []
    layout: Json = {
        "margin": {"t": TOP_PX, "b": BOTTOM_PX},
        "hovermode": "x unified",
        "hoversubplots": "axis",
        "legend": {"y": 1.0 + 20.0 / drawn_px},
        "shapes": [*map(_shade, timeline.phases), *map(_rule, timeline.marks)],
        "annotations": [*_phase_labels(timeline.phases), *map(_mark_label, timeline.marks)],
        "xaxis": {"title": {"text": timeline.title}, "anchor": _axis(len(panels) - 1)},
    }
    if timeline.window_s is not None:
        layout["xaxis"]["range"] = list(timeline.window_s)
    shown: list[Text] = []
    for k, (panel, top, height) in enumerate(zip(panels, tops, heights, strict=True)):
        domain = [max(0.0, float((top - height) / drawn_px)), float(top / drawn_px)]
        axis: Json = {"title": {"text": panel.title}, "domain": domain, "nticks": 5}
        if panel.off_ground and timeline.off_ground_s is not None:
            axis |= _value_range(panel.lines, timeline.off_ground_s)
        layout["yaxis" if k == 0 else f"yaxis{k + 1}"] = merged(axis, panel.axis or {})
        for line in panel.lines:
            traces.append(_trace(_cut(line, timeline), _axis(k), line.style.label not in shown))
            shown.append(line.style.label)
    height_px = int(drawn_px) + TOP_PX + BOTTOM_PX
    timed = timeline.of_the_log
    return Figure(name, caption, description, traces, layout, height_px, timed=timed)


def _cut(line: Line, timeline: Timeline) -> Line:
    """The part of the line within the window, so that thinning keeps its samples there."""
    if timeline.window_s is None:
        return line
    t_s = np.asarray(line.t_s)
    within = (t_s >= timeline.window_s[0]) & (t_s <= timeline.window_s[1])
    return replace(line, t_s=t_s[within], values=np.asarray(line.values)[within])


def _axis(panel: int) -> str:
    return "y" if panel == 0 else f"y{panel + 1}"


def _trace(line: Line, axis: str, in_legend: bool) -> Json:
    t_s, values = thinned(np.asarray(line.t_s), np.asarray(line.values))
    style = line.style
    trace: Json = {
        "type": "scatter",
        "mode": "lines",
        "name": words(style.label),
        "legendgroup": words(style.label),
        "showlegend": in_legend,
        "x": numbers(t_s),
        "y": numbers(values),
        "yaxis": axis,
        "connectgaps": False,
        "line": {"color": style.colour, "dash": style.dash, "width": style.width},
    }
    return merged(trace, line.extra or {})


def _value_range(lines: Sequence[Line], window_s: tuple[float, float]) -> Json:
    """A range that shows all values within a stretch of time; plotly's own if there are none."""
    low, high = np.inf, -np.inf
    for line in lines:
        within = (line.t_s >= window_s[0]) & (line.t_s <= window_s[1])
        values = line.values[within & (np.abs(line.values) < LARGEST_DRAWN)]
        if len(values):
            low, high = min(low, float(values.min())), max(high, float(values.max()))
    if low >= high:
        return {}
    room = 0.06 * (high - low)
    return {"range": [low - room, high + room]}


def _shade(phase: Span) -> Json:
    return {
        "type": "rect",
        "xref": "x",
        "yref": "paper",
        "x0": phase.start_s,
        "x1": phase.end_s,
        "y0": 0,
        "y1": 1,
        "fillcolor": CONTACT_SHADE,
        "line": {"width": 0},
        "layer": "below",
    }


def _rule(mark: Mark) -> Json:
    return {
        "type": "line",
        "xref": "x",
        "yref": "paper",
        "x0": mark.t_s,
        "x1": mark.t_s,
        "y0": 0,
        "y1": 1,
        "line": {"width": 1, "color": MUTED, "dash": "dash"},
    }


def _mark_label(mark: Mark) -> Json:
    return _label(mark.label, mark.t_s) | {"xanchor": mark.anchor}


def _label(text: Text, t_s: float) -> Json:
    return {
        "text": words(text),
        "x": t_s,
        "y": 1,
        "xref": "x",
        "yref": "paper",
        "yanchor": "bottom",
        "showarrow": False,
        "font": {"size": 11, "color": MUTED},
    }


def _phase_labels(phases: Sequence[Span]) -> list[Json]:
    if len(phases) > MAX_LABELLED_PHASES:
        return []
    return [_label(phase.label, 0.5 * (phase.start_s + phase.end_s)) for phase in phases]
