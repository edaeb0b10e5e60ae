"""Figures of a survey: where each sortie went on the surface, and the energy that it took."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from inspect_cli.reporting.figures.figure import Figure, Json, words
from inspect_cli.reporting.figures.palette import (
    BLUE,
    GREEN,
    INK,
    MUTED,
    ORANGE,
    PURPLE,
    SKY_BLUE,
    VERMILION,
)
from inspect_cli.reporting.words.text import Text, number, say, together
from inspect_cli.schema.coverage import CoveragePlan, Sortie
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result

SORTIE_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY_BLUE, INK)
SORTIE_SYMBOLS = ("circle", "square", "diamond", "triangle-up", "triangle-down", "star", "hexagon")
"""Marker symbols of sorties in turn, so that they differ without colours, too."""
WIDTH_PX = 1000.0
FRAME_PX = 170


def tour_figures(survey: CoveragePlan, plan: Plan) -> Iterator[Figure]:
    """For each surface the points in the order of the flights, and those left out."""
    names = {target.surface for target in plan.targets} | {p.surface for p in survey.skipped}
    for k, surface in enumerate(s.name for s in plan.surfaces if s.name in names):
        traces = [*_paths(survey, surface), *_left_out(survey, surface)]
        u = [x for trace in traces for x in trace["x"]]
        v = [y for trace in traces for y in trace["y"]]
        share = (max(v) - min(v) + 0.2) / (max(u) - min(u) + 0.2)
        yield Figure(
            f"tour-{k + 1}",
            say(
                "The sorties over surface “{surface}”, seen from the side that was touched: each "
                "line is one flight from its first point to its last; crosses are points left out.",
                surface=surface,
            ),
            say(
                "Paths of {n} sorties over the surface.",
                n=number(len(survey.sorties), 0),
            ),
            traces,
            {
                "hovermode": "closest",
                "xaxis": {"title": {"text": "u (m)"}, "constrain": "domain"},
                "yaxis": {
                    "title": {"text": "v (m)"},
                    "scaleanchor": "x",
                    "constrain": "domain",
                },
            },
            FRAME_PX + int(min(max(WIDTH_PX * share, 160.0), 520.0)),
        )


def _paths(survey: CoveragePlan, surface: str) -> Iterator[Json]:
    for k, sortie in enumerate(survey.sorties):
        targets = [t for t in sortie.plan.targets if t.surface == surface and t.uv_m]
        if not targets:
            continue
        colour = SORTIE_COLOURS[k % len(SORTIE_COLOURS)]
        yield {
            "type": "scatter",
            "mode": "lines+markers",
            "name": _named(sortie),
            "x": [t.uv_m[0] for t in targets if t.uv_m],
            "y": [t.uv_m[1] for t in targets if t.uv_m],
            "line": {"color": colour, "width": 1.6, "dash": "dot" if sortie.added else "solid"},
            "marker": {
                "symbol": SORTIE_SYMBOLS[k % len(SORTIE_SYMBOLS)],
                "size": 8,
                "color": colour,
            },
            "customdata": [
                say(
                    "point {label}, stop {place} of sortie {n}",
                    label=words(t.label),
                    place=number(place, 0),
                    n=number(sortie.number, 0),
                )
                for place, t in enumerate(targets, 1)
            ],
            "hovertemplate": "%{customdata}<extra></extra>",
        }


def _named(sortie: Sortie) -> Text:
    n = number(sortie.number, 0)
    return say("sortie {n}, added", n=n) if sortie.added else say("sortie {n}", n=n)


def _left_out(survey: CoveragePlan, surface: str) -> Iterator[Json]:
    points = [point for point in survey.skipped if point.surface == surface]
    if points:
        yield {
            "type": "scatter",
            "mode": "markers",
            "name": say("left out"),
            "x": [point.uv_m[0] for point in points],
            "y": [point.uv_m[1] for point in points],
            "marker": {"symbol": "x-thin", "size": 10, "line": {"width": 2, "color": INK}},
            "customdata": [together(words(p.label), ": ", words(p.reason)) for p in points],
            "hovertemplate": "%{customdata}<extra></extra>",
        }


def energy_figure(survey: CoveragePlan, flown: Sequence[Result]) -> Figure:
    """Planned beside flown energy of each sortie, under what a sortie may plan with."""
    names = [say("sortie {n}", n=number(sortie.number, 0)) for sortie in survey.sorties]
    metrics = [result.metrics.get("flight.energy_wh_flown") for result in flown]
    took = [metric.value if metric else None for metric in metrics]
    took += [None] * (len(names) - len(took))
    bars: list[Json] = [
        {
            "type": "bar",
            "name": say("planned"),
            "x": names,
            "y": [sortie.plan.energy_wh for sortie in survey.sorties],
            "marker": {"color": MUTED, "pattern": {"shape": "/"}},
        },
        {"type": "bar", "name": say("flown"), "x": names, "y": took, "marker": {"color": GREEN}},
        {
            "type": "scatter",
            "mode": "lines",
            "name": say("battery less reserve"),
            "x": names,
            "y": [survey.budget_wh] * len(names),
            "line": {"color": INK, "dash": "dash", "width": 1.2},
        },
    ]
    return Figure(
        "sortie-energy",
        say(
            "Energy of each sortie: as planned from hover powers, and as flown from the true "
            "speeds of the rotors. Dashed: what a sortie may plan with; what it takes beyond that "
            "is from the reserve."
        ),
        say("Bars of planned and flown energy for each sortie."),
        bars,
        {
            "barmode": "group",
            "yaxis": {"title": {"text": say("energy (Wh)")}, "rangemode": "tozero"},
        },
        300,
    )
