"""Depth servoing: slides along a surface that only the depth camera knows."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.metrics.flight import FlightData
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.chapters.shared import (
    contact_kept,
    drawn_or_reason,
    metric_box,
    millimetres,
)
from inspect_cli.reporting.content.blocks import Block, Box, Facts, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.flight.servoing import servoing_figures, slides_of
from inspect_cli.reporting.words.text import Text, number, say, significant, together


def _blocks(material: Material) -> list[Block]:
    def shown() -> Iterator[Block]:
        flight = FlightData(material.log)
        for k, slide in enumerate(slides_of(flight), 1):
            yield from drawn(servoing_figures(flight, k, slide))

    return [
        *drawn_or_reason(shown),
        *_drift(material.result.value("estimation.drift_at_first_contact_m")),
        *metrics_table(say("Depth servoing."), material.result, CHAPTER.metric_groups),
    ]


def _drift(drift_m: float | None) -> list[Block]:
    if drift_m is None:
        return []
    name = say("Drift of the estimate at the first touch")
    return [Facts([(name, together(number(1e3 * drift_m, 1), " mm"))])]


def _boxes(material: Material) -> Iterator[Box]:
    result = material.result
    yield from metric_box(result, say("on the surface"), "slide.distance_m", "m")
    yield from metric_box(result, say("mean speed"), "slide.speed_mean_mps", "m/s")
    yield from metric_box(
        result, say("tool off the normal"), "slide.axis_error_mean_deg", "°", digits=2
    )
    yield from metric_box(result, say("variation of the force"), "contact.force_cv", "%", 100.0, 2)


def _sentences(material: Material) -> Iterator[Text]:
    result = material.result
    way, speed = result.value("slide.distance_m"), result.value("slide.speed_mean_mps")
    if way is None:
        yield say("A surface that the plan does not describe was to be followed.")
        return
    if speed is None:
        yield say(
            "The tool slid {way} m along a surface known by the depth camera alone.",
            way=number(way, 2),
        )
    else:
        yield say(
            "The tool slid {way} m along a surface known by the depth camera alone at {speed} m/s "
            "on average.",
            way=number(way, 2),
            speed=significant(speed, 2),
        )
    yield from contact_kept(result, "slide.gaps")
    drift = millimetres(result, "estimation.drift_at_first_contact_m")
    if drift:
        yield say("At the first touch the estimate was {drift} mm off.", drift=drift)


CHAPTER = Chapter(
    heading=say("Depth servoing"),
    applies=lambda material: bool(material.profile.followings),
    blocks=_blocks,
    subjects=lambda material: [say("depth servoing")],
    sentences=_sentences,
    boxes=_boxes,
    metric_groups=("slide",),
    shared_groups=("contact", "guidance"),
)
