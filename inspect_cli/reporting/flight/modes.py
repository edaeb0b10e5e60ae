"""Figure of the executive's modes over time, with its events."""

from __future__ import annotations

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Reference
from inspect_cli.reporting.figures.figure import Figure, Json, numbers, words
from inspect_cli.reporting.figures.palette import INK, MUTED, VERMILION, mode_colours
from inspect_cli.reporting.figures.rows import rows_of
from inspect_cli.reporting.flight.events_table import QUIET_LEVELS
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, say, together
from inspect_cli.schema.modes import ModeTable
from inspect_cli.spatial.arrays import Structured

ROW_PX = 24
EVENTS_ROW = say("EVENTS")
MODE_NAMES = {
    "idle": say("IDLE"),
    "takeoff": say("TAKEOFF"),
    "transit": say("TRANSIT"),
    "hold": say("HOLD"),
    "approach": say("APPROACH"),
    "press": say("PRESS"),
    "slide": say("SLIDE"),
    "retreat": say("RETREAT"),
    "land": say("LAND"),
    "landed": say("LANDED"),
    "hover": say("HOVER"),
}
"""Words for modes that several vehicles have; another mode is called by its own name."""


def modes_figure(log: RunLog) -> Figure | None:
    """A bar per stretch in a mode, one row per mode that was flown, events below."""
    reference = rows_of(log, Reference)
    if reference is None:
        return None
    table = log.modes()
    stretches = _stretches(reference, table)
    flown = [row.name for row in table.modes if any(name == row.name for name, _, _ in stretches)]
    colours = mode_colours(table)
    traces: list[Json] = [
        _bars(name, colours[name], [(start, end) for m, start, end in stretches if m == name])
        for name in flown
    ]
    rows = [_word(name) for name in flown]
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


def _word(mode: str) -> Text:
    return MODE_NAMES.get(mode, mode.replace("_", " ").upper())


def _stretches(reference: Structured, table: ModeTable) -> list[tuple[str, float, float]]:
    """(mode's name, from, to) of every stretch in one mode."""
    t_s, mode = reference["t_s"], reference["mode"]
    starts = np.concatenate([[0], np.flatnonzero(np.diff(mode)) + 1])
    ends = np.concatenate([starts[1:], [len(mode) - 1]])
    return [
        (table.by_number[int(mode[a])].name, float(t_s[a]), float(t_s[b]))
        for a, b in zip(starts, ends, strict=True)
        if mode[a] in table.by_number
    ]


def _bars(mode: str, colour: str, spans: list[tuple[float, float]]) -> Json:
    starts = np.array([start for start, _ in spans])
    ends = np.array([end for _, end in spans])
    return {
        "type": "bar",
        "orientation": "h",
        "y": [_word(mode)] * len(spans),
        "base": numbers(starts),
        "x": numbers(ends - starts),
        "customdata": numbers(ends),
        "marker": {"color": colour, "line": {"width": 0}},
        "hovertemplate": together(_word(mode), " %{base:.2f} – %{customdata:.2f} s<extra></extra>"),
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
