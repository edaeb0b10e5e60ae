"""Drawings: strokes pressed onto a surface, trial upon trial."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.metrics.flight import FlightData
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.chapters.shared import (
    amount_in_words,
    contact_kept,
    drawn_or_reason,
    metric_box,
    millimetres,
)
from inspect_cli.reporting.content.blocks import Block, Box, Heading, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.flight.drawing import course_figures, drawing_figures, drawings_of
from inspect_cli.reporting.words.text import Amount, Text, count, number, say, significant


def _blocks(material: Material) -> list[Block]:
    def shown() -> Iterator[Block]:
        flight, drawings = FlightData(material.log), drawings_of(material.plan)
        for k, drawing in enumerate(drawings, 1):
            if len(drawings) > 1:
                yield Heading(say("Drawing {n}", n=number(k, 0)))
            yield from drawn(drawing_figures(flight, drawing))
            yield from drawn(course_figures(flight, drawing), side_by_side=True)

    table = metrics_table(say("Drawing."), material.result, CHAPTER.metric_groups)
    return [*drawn_or_reason(shown), *table]


def _boxes(material: Material) -> Iterator[Box]:
    result = material.result
    yield from metric_box(
        result, say("between trials, RMS in the plane"), "drawing.repeat_rms_m", "mm", 1e3
    )
    yield from metric_box(
        result, say("tip off its reference, RMS"), "drawing.tracking_rms_m", "mm", 1e3
    )
    yield from metric_box(
        result, say("largest attitude error"), "drawing.attitude_error_max_rad", "rad"
    )
    if not material.profile.followings:  # the chapter on servoing has the same box
        yield from metric_box(
            result, say("variation of the force"), "contact.force_cv", "%", 100.0, 2
        )


def _sentences(material: Material) -> Iterator[Text]:
    result = material.result
    strokes = [target.stroke for target in material.profile.strokes if target.stroke]
    drawings = {stroke.drawing for stroke in strokes}
    trials = {(stroke.drawing, stroke.trial) for stroke in strokes}
    yield from _trials(len(trials), len(drawings), millimetres(result, "drawing.repeat_rms_m"))
    error = millimetres(result, "drawing.tracking_rms_m")
    turn = result.value("drawing.attitude_error_max_rad")
    if error and turn is not None:
        yield say(
            "The tip kept to its reference within {error} mm RMS, the attitude within {turn} rad.",
            error=error,
            turn=significant(turn, 2),
        )
    elif error:
        yield say("The tip kept to its reference within {error} mm RMS.", error=error)
    yield from contact_kept(result, "contact.bounce_gaps")


def _trials(trials: int, drawings: int, apart: Amount | None) -> Iterator[Text]:
    of = count(drawings, "one drawing", "{amount} drawings", amount=amount_in_words(drawings, 1))
    words = amount_in_words(trials)
    if apart:
        yield count(
            trials,
            "One trial of {drawings}; they differ by {apart} mm RMS in the plane.",
            "{amount} trials of {drawings}; they differ by {apart} mm RMS in the plane.",
            amount=words,
            drawings=of,
            apart=apart,
        )
    elif trials > drawings:
        yield say(
            "{amount} trials of {drawings}; their difference was not measured.",
            amount=words,
            drawings=of,
        )
    else:
        yield count(
            trials,
            "One trial of {drawings}.",
            "{amount} trials of {drawings}.",
            amount=words,
            drawings=of,
        )


CHAPTER = Chapter(
    heading=say("Drawing"),
    applies=lambda material: bool(material.profile.strokes),
    blocks=_blocks,
    subjects=lambda material: [say("push-and-slide drawing")],
    sentences=_sentences,
    boxes=_boxes,
    metric_groups=("drawing",),
    shared_groups=("contact", "guidance"),
)
