"""The summary of a report: warnings, finding, key figures, checks and caveats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.coverage import extent
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Block, Box, Boxes, Heading, Notes, Paragraph
from inspect_cli.reporting.content.opening import finding
from inspect_cli.reporting.documents.checks_table import checks_table
from inspect_cli.reporting.words.published import SOURCE, published_of
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, number, say, sentences, significant
from inspect_cli.schema.result import Result, Status

STATUS_WORDS: dict[Status, Text] = {
    "completed": say("The flight was completed."),
    "aborted": say("The flight was aborted."),
    "diverged": say("The simulation diverged: the flight is not to be used."),
    "interrupted": say("The log was cut off: what follows ends there."),
}

AT_REST_MPS = 0.2
"""Above this a vehicle that should have landed is still moving."""


def summary(material: Material, chapters: Iterable[Chapter]) -> list[Block]:
    """What a reader must know who reads nothing else, from the chapters that apply."""
    result, written = material.result, tuple(chapters)
    checks = (
        checks_table(result.checks)
        if result.checks
        else Paragraph(say("The mission states no acceptance."))
    )
    return [
        *([Paragraph(extent(material.coverage.plan))] if material.coverage else []),
        *warnings(result, material.log.mission().expect_status),
        *finding([text for chapter in written for text in chapter.sentences(material)]),
        _key_figures(material, written),
        checks,
        Heading(say("What this report does not say")),
        _caveats(material, written),
    ]


def warnings(result: Result, expected: Status) -> list[Block]:
    """Warnings about the flight: how it ended, contact of the body, motion at the end."""
    found: list[Text] = []
    if result.status != "completed":
        why = recorded(result.status_reason)
        reason = say("Reason: {reason}.", reason=why) if why else ""
        found.append(sentences([STATUS_WORDS[result.status], reason]))
    if expected != "completed":
        found.append(_expectation(result.status, expected))
    touch_n = result.value("contact.body_force_max_n")
    if touch_n is not None and touch_n > 0.0:
        force = significant(touch_n, 3)
        found.append(say("The vehicle's body touched something: {force} N.", force=force))
    end_mps = result.value("flight.end_speed_mps")
    if end_mps is not None and end_mps > AT_REST_MPS:
        speed = significant(end_mps, 2)
        found.append(say("The vehicle was still moving at the end: {speed} m/s.", speed=speed))
    return [Notes(found, "warnings")] if found else []


def _expectation(status: Status, expected: Status) -> Text:
    wanted = recorded(expected)
    if status == expected:
        return say("The mission expects it to be {status}, as it was.", status=wanted)
    return say("The mission expects it to be {status}, which it was not.", status=wanted)


def _key_figures(material: Material, chapters: Sequence[Chapter]) -> Boxes:
    """The numbers that stand in the boxes under the finding."""
    result = material.result
    passed = sum(check.verdict == "pass" for check in result.checks)
    checks = [Box(say("acceptance checks passed"), f"{passed} / {len(result.checks)}")]
    duration = number(result.value("flight.duration_s"), 0)
    return Boxes(
        [
            *(box for chapter in chapters for box in chapter.boxes(material)),
            *(checks if result.checks or material.points else ()),
            Box(say("flight time"), duration, "s"),
        ]
    )


def is_simulated(log: RunLog) -> bool:
    """Whether the log came from the simulator: it then carries the seed and the truth."""
    return log.seed is not None or log.truth() is not None


SIMULATED_READINGS = say(
    "This is a simulated flight. The readings come from a model of the specimen and of the probe, "
    "not from a structure."
)
SIMULATED = say(
    "This is a simulated flight. Motion, contact and sensors are models; what their sources leave "
    "open was chosen and is listed below with the reason."
)
TRUTH_IS_SEEN = say(
    "What is called true is known to the simulator alone: no controller, estimator or planner of "
    "the flight could see it."
)
PUBLISHED_ELSEWHERE = say(
    "Published values are those of another vehicle in its own experiments ({source}). They stand "
    "beside ours for comparison; what passes is decided by the mission's bounds alone.",
    source=SOURCE,
)
WITHOUT_TRUTH = say("Without the truth, errors are against what the vehicle itself believed.")


def _caveats(material: Material, chapters: Sequence[Chapter]) -> Notes:
    """What the numbers do not say."""
    notes: list[Text] = []
    if is_simulated(material.log):
        notes += [SIMULATED_READINGS] if material.points else [SIMULATED, TRUTH_IS_SEEN]
    notes += [text for chapter in chapters for text in chapter.caveats(material)]
    if any(published_of(check.ref) for check in material.result.checks):
        notes.append(PUBLISHED_ELSEWHERE)
    return Notes(notes or [WITHOUT_TRUTH], "caveats")
