"""Figures of a drawing: all trials in the plane of the surface, and their course over time.

After Fig. 7 of Bodie et al., RSS 2019. Trials are laid upon each other by the time since each
first touched the surface.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.metrics.drawing import Repeat, repeats
from inspect_cli.metrics.flight import FlightData, NotMeasured, Rows
from inspect_cli.records import Estimate
from inspect_cli.reporting.figures.figure import Figure, Json, numbers
from inspect_cli.reporting.figures.palette import REFERENCE, LineStyle, trial_style
from inspect_cli.reporting.figures.rows import attitude_difference_mrad
from inspect_cli.reporting.figures.timeline import (
    Line,
    Mark,
    Panel,
    Span,
    Timeline,
    alike,
    stacked,
    stretches,
)
from inspect_cli.reporting.flight.scene import FAR_M
from inspect_cli.reporting.words.text import count, number, say, sentences, together
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.spatial.primitives import project

PATH_SAMPLES = 3000
"""Samples drawn of a line in the plane; a trial of a minute at 100 Hz has twice as many."""
AROUND_S = 2.0
"""Drawn before the first touch and after the last release of a trial."""
PANEL_PX = 84
WIDTH_PX = 1000.0
FRAME_PX = 110


@dataclass(frozen=True)
class Trial:
    """One repetition of a drawing."""

    number: int
    targets: tuple[Target, ...]
    sliding: tuple[Rows, ...]
    """Rows of the state in which each stroke was slid along."""
    contacts: tuple[Rows, ...]
    """Rows from first touch to release of each stroke."""

    def start_s(self, t_s: Vector) -> float:
        """Time of the first touch, s."""
        return float(t_s[self.contacts[0][0]])

    def end_s(self, t_s: Vector) -> float:
        """Time of the last release, s."""
        return float(t_s[self.contacts[-1][-1]])


def drawings_of(plan: Plan) -> list[int]:
    """The numbers of the drawings that are traced."""
    return sorted({target.stroke.drawing for target in plan.targets if target.stroke})


def trials_of(flight: FlightData, drawing: int) -> list[Trial]:
    """The trials of a drawing, strokes that were never slid along left out."""
    strokes = [t for t in flight.plan.targets if t.stroke and t.stroke.drawing == drawing]
    trials = []
    for k in sorted({t.stroke.trial for t in strokes if t.stroke}):
        own = [t for t in strokes if t.stroke and t.stroke.trial == k]
        tried = [(t, _sliding(flight, t), flight.contact_rows(t.index)) for t in own]
        drawn = [(t, slid, held) for t, slid, held in tried if len(slid) and len(held)]
        if drawn:
            trials.append(Trial(k, *zip(*drawn, strict=True)))
    return trials


def _sliding(flight: FlightData, target: Target) -> Rows:
    at_hand = flight.reference["target"] == target.index
    rows: Rows = np.flatnonzero(flight.during(Phase.CONTACT, slides=True) & at_hand)
    return rows


def drawing_figures(flight: FlightData, drawing: int) -> list[Figure]:
    """The drawing, how far its trials lie apart, and its course over time."""
    trials = trials_of(flight, drawing)
    if not trials:
        return []
    figures = [_in_the_plane(flight, drawing, trials)]
    figures += _apart(flight, drawing)
    return figures


def course_figures(flight: FlightData, drawing: int) -> list[Figure]:
    """Position above force, attitude error above torque, since each trial's first touch."""
    trials = trials_of(flight, drawing)
    return list(_over_time(flight, drawing, trials)) if trials else []


def _in_the_plane(flight: FlightData, drawing: int, trials: Sequence[Trial]) -> Figure:
    surface = trials[0].targets[0].surface
    prim = primitive_of(next(s.shape for s in flight.plan.surfaces if s.name == surface))
    reference = flight.reference["p_WT"]
    traces = []
    for first, rows in enumerate(trials[0].sliding):
        traces.append(_path(_uv(prim, reference, rows), REFERENCE, shown=first == 0))
    for trial in trials:
        style = trial_style(trial.number)
        for first, rows in enumerate(trial.sliding):
            traces.append(_path(_uv(prim, flight.state["p_WT"], rows), style, shown=first == 0))
    everywhere = np.vstack(
        [_uv(prim, flight.state["p_WT"], rows) for t in trials for rows in t.sliding]
    )
    low, high = extent(everywhere)
    room = 0.06 * float(max(high - low))
    width, height = np.maximum(high - low, 0.02) + 2.0 * room
    layout: Json = {
        "margin": {"t": 44},
        "hovermode": "closest",
        "xaxis": {
            "title": {"text": "u (m)"},
            "range": [low[0] - room, high[0] + room],
            "constrain": "domain",
        },
        "yaxis": {
            "title": {"text": "v (m)"},
            "range": [low[1] - room, high[1] + room],
            "scaleanchor": "x",
            "constrain": "domain",
        },
    }
    return Figure(
        f"drawing-{drawing + 1}",
        say(
            "The drawing in the plane of surface “{surface}”, seen from the side that was touched: "
            "the reference of the first trial and the true tip of the tool in each, while it slid; "
            "equal scales.",
            surface=surface or "",
        ),
        count(
            len(trials),
            "Plan view of a drawing: reference and one trial.",
            "Plan view of a drawing: reference and {n} trials.",
        ),
        traces,
        layout,
        FRAME_PX + int(np.clip(WIDTH_PX * height / width, 220.0, 560.0)),
        slope=float(height / width),
    )


def extent(points: Points) -> tuple[Vector, Vector]:
    """Least and largest coordinates of points (n, m); a diverged flight's infinities left out.

    Raises:
        NotMeasured: there is nothing that could be drawn.
    """
    kept = points[np.all(np.abs(np.nan_to_num(points, nan=np.inf)) < FAR_M, axis=1)]
    if len(kept) == 0:
        raise NotMeasured("the log holds no place that could be drawn")
    return kept.min(axis=0), kept.max(axis=0)


def _uv(prim: np.ndarray, p_W: Points, rows: Rows) -> Points:
    """Coordinates on the planned surface of what is to be drawn of a stroke, (n, 2) m."""
    kept = rows[:: max(1, -(-len(rows) // PATH_SAMPLES))]
    return np.array([project(prim, 0, p)[:2] for p in p_W[kept]]).reshape(-1, 2)


def _path(uv: Points, style: LineStyle, *, shown: bool) -> Json:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": style.label,
        "legendgroup": style.label,
        "showlegend": shown,
        "x": numbers(uv[:, 0]),
        "y": numbers(uv[:, 1]),
        "line": {"color": style.colour, "dash": style.dash, "width": style.width},
        "hovertemplate": together(style.label, "<br>u %{x:.4f} m, v %{y:.4f} m<extra></extra>"),
    }


def _apart(flight: FlightData, drawing: int) -> Iterator[Figure]:
    """How far two trials lie apart along the drawing."""
    try:
        found = [r for r in repeats(flight) if r.first.stroke and r.first.stroke.drawing == drawing]
    except NotMeasured:
        return
    if not found:
        return
    layout: Json = {
        "xaxis": {"title": {"text": say("way along the reference (m)")}},
        "yaxis": {"title": {"text": say("apart in the plane (mm)")}, "rangemode": "tozero"},
        "hovermode": "closest",
    }
    yield Figure(
        f"drawing-{drawing + 1}-apart",
        say(
            "How far two trials lie apart in the plane, at equal progress along the reference. "
            "Strokes follow each other."
        ),
        say("Distance in the plane between two trials along the drawing."),
        list(_apart_lines(found)),
        layout,
        240,
    )


def _apart_lines(found: Sequence[Repeat]) -> Iterator[Json]:
    """One line per pair of trials, strokes one after the other with a gap."""
    pairs = sorted({_trials(repeat) for repeat in found})
    for k, pair in enumerate(pairs):
        own = [repeat for repeat in found if _trials(repeat) == pair]
        before = np.cumsum([0.0, *(repeat.arc_m[-1] for repeat in own)])
        gap = np.array([np.nan])
        arcs = [np.append(r.arc_m + start, gap) for r, start in zip(own, before, strict=False)]
        values = [np.append(1e3 * repeat.apart_m, gap) for repeat in own]
        style = trial_style(k)
        yield {
            "type": "scatter",
            "mode": "lines",
            "name": say("trials {a} and {b}", a=number(pair[0] + 1, 0), b=number(pair[1] + 1, 0)),
            "showlegend": True,
            "x": numbers(np.concatenate(arcs)),
            "y": numbers(np.concatenate(values)),
            "connectgaps": False,
            "line": {"color": style.colour, "dash": style.dash, "width": style.width},
        }


def _trials(repeat: Repeat) -> tuple[int, int]:
    first, second = repeat.first.stroke, repeat.second.stroke
    return (first.trial if first else 0, second.trial if second else 0)


def _over_time(flight: FlightData, drawing: int, trials: Sequence[Trial]) -> Iterator[Figure]:
    t_s, state, reference = flight.state["t_s"], flight.state, flight.reference
    longest = max(trial.end_s(t_s) - trial.start_s(t_s) for trial in trials)
    timeline = _timeline(trials[0], t_s).within((-AROUND_S, longest + AROUND_S))
    window = timeline.window_s or (0.0, longest)
    error = 1e-3 * attitude_difference_mrad(reference["q_WB"], state["q_WB"])
    position = [
        Panel(
            f"{axis} (m)",
            [
                *_of_trials(trials[:1], t_s, reference["p_WT"][:, k], REFERENCE),
                *_of_trials(trials, t_s, state["p_WT"][:, k]),
            ],
            None,
            PANEL_PX,
            off_ground=True,
        )
        for k, axis in enumerate("xyz")
    ]
    attitude = [
        Panel(f"θ<sub>{axis}</sub> (rad)", _of_trials(trials, t_s, error[:, k]), None, PANEL_PX)
        for k, axis in enumerate("xyz")
    ]
    felt = flight.log.rows(Estimate)
    wrench = None if felt is None else flight.on_state_ticks(Estimate)["wrench_B"]
    for name, above, first, symbol, unit, (what, description) in (
        ("position", position, 0, "F", "N", POSITION),
        ("attitude", alike(attitude, window), 3, "τ", "N·m", ATTITUDE),
    ):
        below = [
            Panel(
                f"{symbol}<sub>{axis}</sub> ({unit})",
                _of_trials(trials, t_s, wrench[:, first + k]),
                None,
                PANEL_PX,
            )
            for k, axis in enumerate("xyz" if wrench is not None else "")
            if wrench is not None
        ]
        yield stacked(
            f"drawing-{drawing + 1}-{name}",
            sentences([what, SHADED]),
            description,
            [*above, *alike(below, window)],
            timeline,
        )


POSITION = (
    say(
        "Position of the tool's tip in the world, reference and truth, and the estimated external "
        "force in the axes of the body, over the time since each trial's first touch. Across the "
        "surface the reference lies behind it on purpose."
    ),
    say("Position and external force over time."),
)
ATTITUDE = (
    say(
        "Attitude error of the body as a rotation vector from reference to truth, and the "
        "estimated external torque about the body's origin, over the time since each trial's "
        "first touch."
    ),
    say("Attitude and external torque over time."),
)
SHADED = say("Shaded: contact in the first trial; (a) touch, (b) release.")


def _of_trials(
    trials: Sequence[Trial], t_s: Vector, values: Vector, style: LineStyle | None = None
) -> list[Line]:
    """A signal once for each trial, on its own clock, from a little before it to a little after."""
    lines = []
    for trial in trials:
        start, end = trial.start_s(t_s), trial.end_s(t_s)
        rows = (t_s >= start - AROUND_S) & (t_s <= end + AROUND_S)
        lines.append(Line(t_s[rows] - start, values[rows], style or trial_style(trial.number)))
    return lines


def _timeline(trial: Trial, t_s: Vector) -> Timeline:
    """Contacts of a trial on its own clock; the first touch and the last release are marked."""
    start = trial.start_s(t_s)
    phases = []
    for rows in trial.contacts:
        inside = np.zeros(len(t_s), bool)
        inside[rows] = True
        for first, end in stretches(inside):
            phases.append(Span(float(t_s[first]) - start, float(t_s[end - 1]) - start, ""))
    marks = (Mark(0.0, "(a)"), Mark(trial.end_s(t_s) - start, "(b)"))
    title = say("time since the first touch of the trial (s)")
    return Timeline(phases=tuple(phases), marks=marks, title=title, of_the_log=False)
