"""Estimates of pose and force against what measured them: tracker and sensor in the wall."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.metrics.flight import FlightData
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.chapters.shared import metric_box
from inspect_cli.reporting.content.blocks import Block, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.flight.ground_truth import force_figure, position_figure, rmse_table
from inspect_cli.reporting.words.text import Text, number, say, significant


def _blocks(material: Material) -> list[Block]:
    figures = list(position_figure(material.log, material.timeline))
    caption = say("Force against the sensor in the wall.")
    return [
        *drawn(figures[:1]),
        *drawn(figures[1:], side_by_side=True),
        *drawn(force_figure(FlightData(material.log), material.timeline)),
        *rmse_table(material.result),
        *metrics_table(caption, material.result, CHAPTER.metric_groups),
    ]


def _sentences(material: Material) -> Iterator[Text]:
    result = material.result
    force = {axis: result.value(f"force_sensor.rmse_f{axis}_n") for axis in "xyz"}
    if all(value is not None for value in force.values()):
        yield say(
            "The estimated force is off the wall's sensor by {x}, {y}, {z} N RMS along x, y, z.",
            **{axis: significant(value, 2) for axis, value in force.items()},
        )
    place = {axis: result.value(f"estimation.rmse_{axis}_m") for axis in "xyz"}
    if all(value is not None for value in place.values()):
        yield say(
            "The estimated position is off by {x}, {y}, {z} mm RMS.",
            **{axis: number(1e3 * (value or 0.0), 1) for axis, value in place.items()},
        )


CHAPTER = Chapter(
    heading=say("Estimates against ground truth"),
    applies=lambda material: material.profile.ground_truth,
    blocks=_blocks,
    subjects=lambda material: [say("estimates against ground truth")],
    sentences=_sentences,
    boxes=lambda material: metric_box(
        material.result, say("force error along x, RMS"), "force_sensor.rmse_fx_n", "N"
    ),
    metric_groups=("force_sensor",),
)
