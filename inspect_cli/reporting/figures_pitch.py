"""Figures of the study ``pitch``: what a grid finds against its pitch and against its cost."""

from __future__ import annotations

from inspect_cli.reporting.figure import Figure, Json
from inspect_cli.reporting.figures_study import Curve, Level, Row, error_bars, sweep_panels
from inspect_cli.reporting.palette import BLUE, GREEN, INK, ORANGE, VERMILION
from inspect_cli.schema.study import StudyResult

POINTS, SORTIES = "study.points", "study.sorties"
DETECTED, SITES = "study.detected_share", "study.sites_found_share"
MISSED, FALSE = "study.missed_area_m2", "study.false_area_m2"
ENERGY, DURATION = "study.energy_wh", "study.duration_s"
FLOWN = "scoring.detected_share"
LEVEL = 0.95
"""The share below which a grid is said to miss."""


def pitch_figure(study: StudyResult) -> Figure:
    """Detected shares, and the areas missed and falsely judged, against the pitch."""
    shares = [
        Curve(DETECTED, "truly active area", BLUE, "circle"),
        Curve(SITES, "sites", GREEN, "square", "dot"),
    ]
    if _was_flown(study):
        shares.append(Curve(FLOWN, "truly active area, flown once", ORANGE, "diamond-open", "dash"))
    found = Row("share found", tuple(shares), Level(LEVEL, "95 %", "dot"), 0.55)
    areas = Row(
        "area (m²)",
        (
            Curve(MISSED, "missed", VERMILION, "circle"),
            Curve(FALSE, "falsely judged active", ORANGE, "square", "dot"),
        ),
        None,
        0.45,
    )
    return Figure(
        "pitch-detection",
        "What is found of what is truly active, against the pitch of the grid: above, the share "
        "of the active area judged active and the share of the active sites with a reading within "
        "that was judged so; below, the area missed and the area falsely judged active. Means "
        f"over {study.trials} offsets of the grid; bars are standard errors.",
        "Shares found and areas missed and falsely judged active against the pitch of the grid.",
        *sweep_panels(study, (found, areas)),
        560,
    )


def cost_figure(study: StudyResult) -> Figure:
    """The detected share against the energy that is planned for it, one point a pitch."""
    quantity = study.quantities[0]
    variants = study.sweep(quantity)
    names = [f"{variant.values[quantity.name]:g} m" for variant in variants]
    traces: list[Json] = [
        {
            "type": "scatter",
            "mode": "lines+markers" + ("+text" if metric == DETECTED else ""),
            "name": label,
            "x": [variant.value(ENERGY) for variant in variants],
            "y": [variant.value(metric) for variant in variants],
            "text": names,
            "textposition": "bottom center",
            "customdata": [
                [variant.values[quantity.name], (variant.value(DURATION) or 0.0) / 60.0]
                for variant in variants
            ],
            "line": {"color": colour, "dash": dash, "width": 1.6},
            "marker": {"symbol": symbol, "size": 9, "color": colour},
            "hovertemplate": (
                "%{customdata[0]:g} m: %{y:.3g} for %{x:.3g} Wh, %{customdata[1]:.0f} min"
                f"<extra>{label}</extra>"
            ),
        }
        | error_bars(variants, metric, colour)
        for metric, label, colour, symbol, dash in (
            (DETECTED, "truly active area", BLUE, "circle", "solid"),
            (SITES, "sites", GREEN, "square", "dot"),
        )
    ]
    ends = [variant.value(ENERGY) or 0.0 for variant in variants]
    traces.append(
        {
            "type": "scatter",
            "mode": "lines",
            "name": "95 %",
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
            "ticktext": [f"{end:.3g}" for end in ends],
            "title": {"text": "energy planned (Wh)"},
        },
        "yaxis": {"rangemode": "tozero", "title": {"text": "share found"}},
    }
    return Figure(
        "pitch-cost",
        "Cost against detection: the shares that are found against the energy of all sorties as "
        "planned, a point for each pitch.",
        "Shares of active area and of sites found against planned energy, by pitch.",
        traces,
        layout,
        380,
    )


def _was_flown(study: StudyResult) -> bool:
    return any(variant.value(FLOWN) is not None for variant in study.variants)
