"""Figures of the study ``pitch``: what a grid finds against its pitch and against its cost."""

from __future__ import annotations

from inspect_cli.reporting.figures.figure import Figure, Json
from inspect_cli.reporting.figures.palette import BLUE, GREEN, INK, ORANGE, VERMILION
from inspect_cli.reporting.studies.sweep_figures import Curve, Level, Row, error_bars, sweep_panels
from inspect_cli.reporting.words.text import number, say, significant, together
from inspect_cli.schema.study import StudyResult

POINTS, SORTIES = "study.points", "study.sorties"
DETECTED, SITES = "study.detected_share", "study.sites_found_share"
MISSED, FALSE = "study.missed_area_m2", "study.false_area_m2"
ENERGY, DURATION = "study.energy_wh", "study.duration_s"
ACTIVE, TOO_RESISTIVE = "study.active_area_m2", "study.too_resistive_area_m2"
FLOWN = "scoring.detected_share"
LEVEL = 0.95
"""The share below which a grid is said to miss."""
LEVEL_SHOWN = together(number(100.0 * LEVEL, 0), " %")
AREA, WHOLE = say("truly active area"), say("sites")
COSTS = say("%{{customdata[0]:g}} m: %{{y:.3g}} for %{{x:.3g}} Wh, %{{customdata[1]:.0f}} min")


def pitch_figure(study: StudyResult) -> Figure:
    """Detected shares, and the areas missed and falsely judged, against the pitch."""
    shares = [
        Curve(DETECTED, AREA, BLUE, "circle"),
        Curve(SITES, WHOLE, GREEN, "square", "dot"),
    ]
    if _was_flown(study):
        flown = say("truly active area, flown once")
        shares.append(Curve(FLOWN, flown, ORANGE, "diamond-open", "dash"))
    found = Row(say("share found"), tuple(shares), Level(LEVEL, LEVEL_SHOWN, "dot"), 0.55)
    areas = Row(
        say("area (m²)"),
        (
            Curve(MISSED, say("missed"), VERMILION, "circle"),
            Curve(FALSE, say("falsely judged active"), ORANGE, "square", "dot"),
        ),
        None,
        0.45,
    )
    return Figure(
        "pitch-detection",
        say(
            "What is found of what is truly active, against the pitch of the grid: above, the "
            "share of the active area judged active and the share of the active sites with a "
            "reading within that was judged so; below, the area missed and the area falsely "
            "judged active. Means over {n} offsets of the grid; bars are standard errors.",
            n=number(study.trials, 0),
        ),
        say("Shares found and areas missed and falsely judged active against the pitch."),
        *sweep_panels(study, (found, areas)),
        560,
    )


def cost_figure(study: StudyResult) -> Figure:
    """The detected share against the energy that is planned for it, one point a pitch."""
    quantity = study.quantities[0]
    variants = study.sweep(quantity)
    names = [together(significant(v.values[quantity.name]), " m") for v in variants]
    traces: list[Json] = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": label,
            "x": [variant.value(ENERGY) for variant in variants],
            "y": [variant.value(metric) for variant in variants],
            "customdata": [
                [variant.values[quantity.name], (variant.value(DURATION) or 0.0) / 60.0]
                for variant in variants
            ],
            "line": {"color": colour, "dash": dash, "width": 1.6},
            "marker": {"symbol": symbol, "size": 9, "color": colour},
            "hovertemplate": together(COSTS, "<extra>", label, "</extra>"),
        }
        | error_bars(variants, metric, colour)
        for metric, label, colour, symbol, dash in (
            (DETECTED, AREA, BLUE, "circle", "solid"),
            (SITES, WHOLE, GREEN, "square", "dot"),
        )
    ]
    ends = [variant.value(ENERGY) or 0.0 for variant in variants]
    traces.append(
        {
            "type": "scatter",
            "mode": "lines",
            "name": LEVEL_SHOWN,
            "x": [min(ends), max(ends)],
            "y": [LEVEL, LEVEL],
            "line": {"color": INK, "dash": "dot", "width": 1.2},
            "hoverinfo": "skip",
        }
    )
    layout: Json = {
        "hovermode": "closest",
        "xaxis": {
            "type": "log",
            "tickvals": ends,
            "ticktext": [
                together(significant(end, 3), "<br>", name)
                for end, name in zip(ends, names, strict=True)
            ],
            "title": {"text": say("energy planned (Wh) and pitch")},
        },
        "yaxis": {"rangemode": "tozero", "title": {"text": say("share found")}},
    }
    return Figure(
        "pitch-cost",
        say(
            "Cost against detection: the shares that are found against the energy of all sorties "
            "as planned, a point for each pitch, which stands beneath its energy."
        ),
        say("Shares of active area and of sites found against planned energy, by pitch."),
        traces,
        layout,
        380,
    )


def _was_flown(study: StudyResult) -> bool:
    return any(variant.value(FLOWN) is not None for variant in study.variants)
