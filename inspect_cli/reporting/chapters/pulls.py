"""Pulls at a cord that is tied to the vehicle."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.metrics.flight import FlightData
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.chapters.shared import (
    amount_in_words,
    drawn_or_reason,
    metric_box,
    millimetres,
)
from inspect_cli.reporting.content.blocks import Block, Box, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.flight.pulls import pull_figures, pull_phases, pull_table
from inspect_cli.reporting.words.text import Text, count, say, significant


def _blocks(material: Material) -> list[Block]:
    log = material.log
    caption = say("Pulls at the cord; of several the least favourable.")
    return [
        *drawn(pull_figures(log, pull_phases(log)), side_by_side=True),
        *drawn_or_reason(lambda: [pull_table(FlightData(log))]),
        *metrics_table(caption, material.result, CHAPTER.metric_groups),
    ]


def _boxes(material: Material) -> Iterator[Box]:
    result = material.result
    yield from metric_box(result, say("largest pull"), "pull.force_peak_n", "N")
    yield from metric_box(result, say("largest displacement"), "pull.displacement_max_m", "mm", 1e3)
    yield from metric_box(result, say("largest yaw"), "pull.yaw_max_rad", "rad")


def _sentence(material: Material) -> Text:
    result, pulls = material.result, material.profile.pulls
    force = result.value("pull.force_peak_n")
    moved = millimetres(result, "pull.displacement_max_m")
    yaw = result.value("pull.yaw_max_rad")
    amount = amount_in_words(pulls)
    if force is None:
        return count(pulls, "One pull at a cord.", "{amount} pulls at a cord.", amount=amount)
    strength = significant(force, 2)
    if not moved or yaw is None:
        return count(
            pulls,
            "One pull at a cord with up to {force} N.",
            "{amount} pulls at a cord with up to {force} N.",
            amount=amount,
            force=strength,
        )
    return count(
        pulls,
        "One pull at a cord with up to {force} N moved the body by up to {moved} mm and turned it "
        "by up to {yaw} rad.",
        "{amount} pulls at a cord with up to {force} N moved the body by up to {moved} mm and "
        "turned it by up to {yaw} rad.",
        amount=amount,
        force=strength,
        moved=moved,
        yaw=significant(yaw, 2),
    )


def _subject(material: Material) -> Text:
    return say("rope pulls in free flight") if material.profile.poses else say("rope pulls")


CHAPTER = Chapter(
    heading=say("Rope pulls"),
    applies=lambda material: bool(material.profile.pulls),
    blocks=_blocks,
    subjects=lambda material: [_subject(material)],
    sentences=lambda material: [_sentence(material)],
    boxes=_boxes,
    metric_groups=("pull",),
)
