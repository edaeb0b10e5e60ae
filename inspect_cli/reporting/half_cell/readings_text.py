"""The finding of half-cell readings in sentences, and their key figures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.content.blocks import Box
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.findings_text import (
    area_sentences,
    gradient_and_population_sentences,
)
from inspect_cli.reporting.words.naming import named
from inspect_cli.reporting.words.text import Text, count, number, say, together
from inspect_cli.schema.result import PointResult


def findings(points: Sequence[ReadPoint], evaluated: Sequence[SurfaceFindings] = ()) -> list[Text]:
    """The finding of the readings in sentences: how much is valid, what corrodes, and how much."""
    if not points:
        return []
    return [
        _validity(points),
        *area_sentences(evaluated),
        *_corrosion(points),
        *gradient_and_population_sentences(evaluated),
    ]


def _validity(points: Sequence[ReadPoint]) -> Text:
    if len(points) == 1:
        valid = points[0].point.valid
        return say("The one reading is valid.") if valid else say("The one reading is invalid.")
    return count(
        sum(p.point.valid for p in points),
        "{n} of {total} readings is valid.",
        "{n} of {total} readings are valid.",
        total=number(len(points), 0),
    )


def _corrosion(points: Sequence[ReadPoint]) -> list[Text]:
    read = [p.point for p in points if p.point.potential_mv is not None]
    if not read:
        return [say("Without a valid reading nothing can be said about corrosion.")]
    if not _has_resistivity(points):
        by_potential = [point.label for point in read if point.astm_class == "active"]
        undecided = [point.label for point in read if point.astm_class == "uncertain"]
        return [*_by_potential(by_potential, undecided), _worst(read)]
    active = [point.label for point in read if point.corrosion == "active"]
    slow = [p.label for p in read if p.corrosion != "active" and p.astm_class == "active"]
    possible = [p.label for p in read if p.corrosion == "possible" and p.astm_class != "active"]
    return [
        *_active(active),
        *_slow(slow),
        *_possible(possible, known=bool(active or slow)),
        *([] if active or slow or possible else [say("No valid reading indicates corrosion.")]),
        _worst(read),
    ]


def _has_resistivity(points: Sequence[ReadPoint]) -> bool:
    """Whether any resistivity is known; without one the verdict is by potential alone."""
    return any(p.point.resistivity_ohm_m is not None for p in points)


def _worst(read: Sequence[PointResult]) -> Text:
    worst = min(read, key=lambda point: point.potential_mv or 0.0)
    return say(
        "The most negative potential is {potential} mV CSE at point {label}.",
        potential=number(worst.potential_mv, 0),
        label=worst.label,
    )


def _by_potential(active: Sequence[str], undecided: Sequence[str]) -> Iterator[Text]:
    """What potentials alone say; resistivities were not measured."""
    if active:
        yield count(
            len(active),
            "By its potential (ASTM C876) point {labels} is active.",
            "By their potential (ASTM C876) points {labels} are active.",
            labels=named(active),
        )
    if undecided:
        yield count(
            len(undecided),
            "The potential at point {labels} does not decide.",
            "The potentials at points {labels} do not decide.",
            labels=named(undecided),
        )
    if not active and not undecided:
        yield say("By their potentials all points are passive (ASTM C876).")
    yield say("No resistivity was measured: how fast steel may corrode is not known.")


def _active(labels: Sequence[str]) -> Iterator[Text]:
    if labels:
        yield count(
            len(labels),
            "Active corrosion is indicated at point {labels}.",
            "Active corrosion is indicated at points {labels}.",
            labels=named(labels),
        )


def _slow(labels: Sequence[str]) -> Iterator[Text]:
    if labels:
        yield count(
            len(labels),
            "By potential alone (ASTM C876) point {labels} is active; the combined rule calls it "
            "possible.",
            "By potential alone (ASTM C876) points {labels} are active; the combined rule calls "
            "them possible.",
            labels=named(labels),
        )


def _possible(labels: Sequence[str], *, known: bool) -> Iterator[Text]:
    if not labels:
        return
    where = named(labels)
    if known:
        yield count(
            len(labels),
            "Corrosion is possible at point {labels}.",
            "Corrosion is possible at points {labels}.",
            labels=where,
        )
    else:
        yield count(
            len(labels),
            "No reading indicates active corrosion; it cannot be ruled out at point {labels}.",
            "No reading indicates active corrosion; it cannot be ruled out at points {labels}.",
            labels=where,
        )


def reading_boxes(points: Sequence[ReadPoint]) -> list[Box]:
    """The key figures of readings."""
    read = [p.point for p in points if p.point.potential_mv is not None]
    potentials = [point.potential_mv for point in read if point.potential_mv is not None]
    valid = sum(p.point.valid for p in points)
    by_both = say("active by potential and resistivity")
    by_potential = sum(p.astm_class == "active" for p in read)
    active = sum(p.corrosion == "active" for p in read)
    return [
        Box(say("valid readings"), together(number(valid, 0), " / ", number(len(points), 0))),
        Box(say("active by potential (ASTM C876)"), number(by_potential, 0)),
        *([Box(by_both, number(active, 0))] if _has_resistivity(points) else []),
        Box(say("most negative"), number(min(potentials, default=None), 0), "mV CSE"),
    ]
