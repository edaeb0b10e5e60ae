"""What a reader must know who reads nothing else: finding, key figures, caveats."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.content import Block, Box, Boxes, Facts, Notes, Paragraph
from inspect_cli.reporting.evaluated import Evaluated
from inspect_cli.reporting.evaluation_told import (
    areas_told,
    few_readings,
    reading_caveats,
    told_of,
)
from inspect_cli.reporting.naming import named
from inspect_cli.reporting.points import ReadPoint
from inspect_cli.reporting.published import SOURCE, published_of
from inspect_cli.reporting.recorded import recorded
from inspect_cli.reporting.text import (
    NOTHING,
    Listed,
    Text,
    count,
    number,
    say,
    sentences,
    significant,
    strong,
    together,
)
from inspect_cli.reporting.works import Works, boxes
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import PointResult, Result, Status
from inspect_cli.schema.vehicle import HalfCellModel

STATUS_WORDS: dict[Status, Text] = {
    "completed": say("The flight was completed."),
    "aborted": say("The flight was aborted."),
    "diverged": say("The simulation diverged: the flight is not to be used."),
    "interrupted": say("The log was cut off: what follows ends there."),
}

AT_REST_MPS = 0.2
"""Above this a vehicle that should have landed is still moving."""


def warnings(result: Result, expected: Status) -> list[Block]:
    """What spoils a flight whatever it read: its end, a body that touched, motion at the end."""
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


def finding(told: Sequence[Text]) -> list[Block]:
    """The finding as one paragraph, its first sentence standing out."""
    if not told:
        return []
    first, *rest = told
    return [Paragraph(sentences([strong(first), *rest]), "finding")]


def findings(points: Sequence[ReadPoint], evaluated: Sequence[Evaluated] = ()) -> list[Text]:
    """The finding of the readings in sentences: how much is valid, what corrodes, and how much."""
    if not points:
        return []
    return [
        _validity(points),
        *areas_told(evaluated),
        *_corrosion(points),
        *told_of(evaluated),
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
    """Without any there is no verdict but that of the potentials."""
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


def key_figures(result: Result, works: Works, points: Sequence[ReadPoint]) -> Boxes:
    """The numbers that stand in the boxes under the finding."""
    passed = sum(check.verdict == "pass" for check in result.checks)
    checks = [Box(say("acceptance checks passed"), f"{passed} / {len(result.checks)}")]
    duration = number(result.value("flight.duration_s"), 0)
    return Boxes(
        [
            *(reading_boxes(points) if points else ()),
            *boxes(works, result),
            *(checks if result.checks or points else ()),
            Box(say("flight time"), duration, "s"),
        ]
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


SIGNED = (say("Place and date"), say("Name and signature of who answers for the evaluation"))
"""What a report of a real structure is handed over with."""


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


def caveats(
    log: RunLog,
    result: Result,
    points: Sequence[ReadPoint],
    evaluated: Sequence[Evaluated] = (),
) -> Notes:
    """What the numbers do not say."""
    read = sum(p.point.potential_mv is not None for p in points)
    notes: list[Text] = []
    if is_simulated(log):
        notes += [SIMULATED_READINGS] if points else [SIMULATED, TRUTH_IS_SEEN]
    if points:
        notes += [*reading_caveats(evaluated), *few_readings(read)]
    if any(published_of(check.ref) for check in result.checks):
        notes.append(PUBLISHED_ELSEWHERE)
    return Notes(notes or [WITHOUT_TRUTH], "caveats")


def method(log: RunLog, plan: Plan) -> Facts:
    """How the readings were taken, in the order of an inspection report."""
    probe = log.platform().sensor(HalfCellModel)
    pressed = [target for target in plan.targets if target.kind == "contact"]
    force = number(max((t.expected_force_n for t in pressed), default=None), 2)
    counts = say(
        "the load cell shows ≥ {force} N for ≥ {time} s and the potential stays within {band} mV "
        "over {stable} s",
        force=significant(probe.min_force_n, 6),
        time=significant(probe.min_contact_s, 6),
        band=significant(1e3 * probe.stable_v, 6),
        stable=significant(probe.stable_s, 6),
    )
    return Facts(
        [
            (
                say("Method"),
                say("half-cell potential (ASTM C876) and resistance at each point of contact"),
            ),
            (say("Reference electrode"), say("copper/copper sulphate (CSE)")),
            (say("A reading counts when"), counts),
            (
                say("Cell constant"),
                say(
                    "{constant} m (resistivity = resistance × constant)",
                    constant=significant(probe.cell_constant_m, 6),
                ),
            ),
            (say("Set-point behind the surface"), _each([t.press_m for t in pressed], "m")),
            (say("Dwell"), _each([t.dwell_s for t in pressed], "s")),
            (say("Expected contact force"), together(force, " N") if pressed else NOTHING),
            (
                say("Cable"),
                say(
                    "{length} m; the farthest point needs {needed} m",
                    length=significant(probe.cable_m, 6),
                    needed=number(plan.cable_m, 2),
                ),
            ),
        ]
    )


def _each(values: Iterable[float], unit: str) -> Text:
    different = tuple(significant(value, 6) for value in sorted(set(values)))
    return together(Listed(different), f" {unit}") if different else NOTHING
