"""Poses held in free flight. Where a cord is pulled meanwhile, the pulls are what counts."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.chapters.shared import amount_in_words, metric_box, millimetres
from inspect_cli.reporting.content.blocks import Box
from inspect_cli.reporting.words.text import Text, count, say, significant


def _sentences(material: Material) -> Iterator[Text]:
    poses = material.profile.poses
    yield count(
        len(poses),
        "One pose held in free flight for {time} s.",
        "{amount} poses held in free flight for {time} s.",
        amount=amount_in_words(len(poses)),
        time=significant(sum(target.dwell_s for target in poses), 6),
    )
    error = millimetres(material.result, "tracking.tool_error_p95_m")
    if material.profile.pulls or not error:
        return
    if material.profile.touches:
        yield say(
            "Out of contact the tip was within {error} mm of its reference 95 % of the time.",
            error=error,
        )
    else:
        yield say(
            "From take-off to landing the tip was within {error} mm of its reference 95 % of the "
            "time.",
            error=error,
        )


def _boxes(material: Material) -> Iterator[Box]:
    if material.profile.pulls:
        return
    result = material.result
    yield from metric_box(
        result, say("tip off its reference, 95 %"), "tracking.tool_error_p95_m", "mm", 1e3
    )
    yield from metric_box(result, say("largest attitude error"), "tracking.attitude_max_rad", "rad")


CHAPTER = Chapter(
    heading=say("Holding a pose"),
    applies=lambda material: bool(material.profile.poses),
    subjects=lambda material: [] if material.profile.pulls else [say("holding a pose")],
    sentences=_sentences,
    boxes=_boxes,
)
