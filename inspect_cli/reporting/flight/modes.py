"""Figure of the executive's modes over time, with its events."""

from __future__ import annotations

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Mode, Reference
from inspect_cli.reporting.figures.figure import Figure, Json, numbers, words
from inspect_cli.reporting.figures.palette import INK, MODE_COLOURS, MUTED, VERMILION
from inspect_cli.reporting.figures.rows import rows_of
from inspect_cli.reporting.flight.events_table import QUIET_LEVELS
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import say, together
from inspect_cli.spatial.arrays import Structured

ROW_PX = 24
EVENTS_ROW = say("EVENTS")
MODE_NAMES = {
    Mode.IDLE: say("IDLE"),
    Mode.TAKEOFF: say("TAKEOFF"),
    Mode.TRANSIT: say("TRANSIT"),
    Mode.HOLD: say("HOLD"),
    Mode.APPROACH: say("APPROACH"),
    Mode.PRESS: say("PRESS"),
    Mode.SLIDE: say("SLIDE"),
    Mode.RETREAT: say("RETREAT"),
    Mode.LAND: say("LAND"),
    Mode.LANDED: say("LANDED"),
    Mode.HOVER: say("HOVER"),
}


def modes_figure(log: RunLog) -> Figure | None:
    """A bar per stretch in a mode, one row per mode that was flown, events below."""
    reference = rows_of(log, Reference)
    if reference is None:
        return None
    stretches = _stretches(reference)
    flown = [mode for mode in Mode if any(m == mode for m, _, _ in stretches)]
    traces: list[Json] = [
        _bars(mode, [(start, end) for m, start, end in stretches if m == mode]) for mode in flown
    ]
    rows = [MODE_NAMES[mode] for mode in flown]
    if log.events:
        traces.append(_events(log))
        rows.append(EVENTS_ROW)
    layout: Json = {
        "showlegend": False,
        "margin": {"t": 8, "l": 84},
        "barmode": "overlay",
        "bargap": 0.25,
        "hovermode": "closest",
        "xaxis": {
            "title": {"text": say("time (s)")},
            "autorangeoptions": {
                "minallowed": float(reference["t_s"][0]),
                "maxallowed": float(reference["t_s"][-1]),
            },
        },
        "yaxis": {"type": "category", "categoryarray": rows[::-1], "categoryorder": "array"},
    }
    return Figure(
        "modes",
        say(
            "Modes of the mission executive, and events as markers; the table below spells them "
            "out."
        ),
        say("Timeline of the modes of the mission executive."),
        traces,
        layout,
        60 + ROW_PX * len(rows),
        timed=True,
    )


def _stretches(reference: Structured) -> list[tuple[Mode, float, float]]:
    """(mode, from, to) of every stretch in one mode."""
    t_s, mode = reference["t_s"], reference["mode"]
    starts = np.concatenate([[0], np.flatnonzero(np.diff(mode)) + 1])
    ends = np.concatenate([starts[1:], [len(mode) - 1]])
    known = {int(m) for m in Mode}
    return [
        (Mode(int(mode[a])), float(t_s[a]), float(t_s[b]))
        for a, b in zip(starts, ends, strict=True)
        if mode[a] in known
    ]


def _bars(mode: Mode, spans: list[tuple[float, float]]) -> Json:
    starts = np.array([start for start, _ in spans])
    ends = np.array([end for _, end in spans])
    return {
        "type": "bar",
        "orientation": "h",
        "y": [MODE_NAMES[mode]] * len(spans),
        "base": numbers(starts),
        "x": numbers(ends - starts),
        "customdata": numbers(ends),
        "marker": {"color": MODE_COLOURS[mode], "line": {"width": 0}},
        "hovertemplate": together(
            MODE_NAMES[mode], " %{base:.2f} – %{customdata:.2f} s<extra></extra>"
        ),
    }


def _events(log: RunLog) -> Json:
    return {
        "type": "scatter",
        "mode": "markers",
        "x": numbers([event.t_s for event in log.events]),
        "y": [EVENTS_ROW] * len(log.events),
        "text": [together(recorded(event.level), ": ", words(event.text)) for event in log.events],
        "marker": {
            "symbol": "diamond-tall",
            "size": 9,
            "color": [MUTED if event.level in QUIET_LEVELS else VERMILION for event in log.events],
            "line": {"width": 1, "color": INK},
        },
        "hovertemplate": "%{x:.2f} s %{text}<extra></extra>",
    }
