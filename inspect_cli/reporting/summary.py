"""What a reader must know who reads nothing else: finding, key figures, caveats."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.points import ReadPoint
from inspect_cli.reporting.published import SOURCE, published_of
from inspect_cli.reporting.table import NOTHING, number, significant
from inspect_cli.reporting.works import Box, Works, boxes
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result, Status

STATUS_WORDS = {
    "completed": "The flight was completed.",
    "aborted": "The flight was aborted.",
    "diverged": "The simulation diverged: the flight is not to be used.",
    "interrupted": "The log was cut off: what follows ends there.",
}

AT_REST_MPS = 0.2
"""Above this a vehicle that should have landed is still moving."""


def warnings(result: Result, expected: Status) -> list[str]:
    """What spoils a flight whatever it read: its end, a body that touched, motion at the end."""
    sentences = []
    if result.status != "completed":
        reason = f" Reason: {result.status_reason}." if result.status_reason else ""
        sentences.append(STATUS_WORDS[result.status] + reason)
    if expected != "completed":
        kept = "as it was" if result.status == expected else "which it was not"
        sentences.append(f"The mission expects it to be {expected}, {kept}.")
    touch_n = _value(result, "contact.body_force_max_n")
    if touch_n is not None and touch_n > 0.0:
        sentences.append(f"The vehicle's body touched something: {significant(touch_n, 3)} N.")
    end_mps = _value(result, "flight.end_speed_mps")
    if end_mps is not None and end_mps > AT_REST_MPS:
        sentences.append(f"The vehicle was still moving at the end: {significant(end_mps, 2)} m/s.")
    return sentences


def warnings_markup(sentences: Sequence[str]) -> Markup:
    """The warnings as a list that cannot be overlooked; nothing without one."""
    if not sentences:
        return Markup("")
    items = (element("li", sentence) for sentence in sentences)
    return element("ul", *items, class_="warnings", role="note", aria_label="Warnings")


def _value(result: Result, name: str) -> float | None:
    metric = result.metrics.get(name)
    return metric.value if metric else None


def finding(points: Sequence[ReadPoint]) -> list[str]:
    """The finding of the readings in sentences: how much is valid, and what corrodes."""
    return [_validity(points), *_corrosion(points)] if points else []


def _validity(points: Sequence[ReadPoint]) -> str:
    valid = sum(p.point.valid for p in points)
    return f"{valid} of {len(points)} readings {'is' if valid == 1 else 'are'} valid."


def _corrosion(points: Sequence[ReadPoint]) -> list[str]:
    read = [p.point for p in points if p.point.potential_mv is not None]
    if not read:
        return ["Without a valid reading nothing can be said about corrosion."]
    active = [point.label for point in read if point.corrosion == "active"]
    slow = [p.label for p in read if p.corrosion != "active" and p.astm_class == "active"]
    possible = [p.label for p in read if p.corrosion == "possible" and p.astm_class != "active"]
    sentences = []
    if active:
        sentences.append(f"Active corrosion is indicated at {_points(active)}.")
    if slow:
        verb, them = ("is", "it") if len(slow) == 1 else ("are", "them")
        sentences.append(
            f"By potential alone (ASTM C876) {_points(slow)} {verb} active; "
            f"the combined rule calls {them} possible."
        )
    if possible:
        known = active or slow
        also = "Corrosion is possible" if known else "No active corrosion; it is possible"
        sentences.append(f"{also} at {_points(possible)}.")
    if not (active or slow or possible):
        sentences.append("No valid reading indicates corrosion.")
    worst = min(read, key=lambda point: point.potential_mv or 0.0)
    sentences.append(
        f"The most negative potential is {number(worst.potential_mv, 0)} mV CSE "
        f"at point {worst.label}."
    )
    return sentences


def _points(labels: Sequence[str]) -> str:
    if len(labels) == 1:
        return f"point {labels[0]}"
    return f"points {', '.join(labels[:-1])} and {labels[-1]}"


def key_figures(result: Result, works: Works, points: Sequence[ReadPoint]) -> Markup:
    """The numbers that stand in the boxes under the finding."""
    passed = sum(check.verdict == "pass" for check in result.checks)
    checks = [("acceptance checks passed", f"{passed} / {len(result.checks)}", "")]
    shown = [
        *(_reading_boxes(points) if points else ()),
        *boxes(works, result),
        *(checks if result.checks or points else ()),
        ("flight time", number(_value(result, "flight.duration_s"), 0), "s"),
    ]
    return element(
        "ul",
        *(
            element(
                "li",
                element("span", value, class_="value"),
                element("span", f" {unit}" if unit else "", class_="unit"),
                element("span", name, class_="name"),
            )
            for name, value, unit in shown
        ),
        class_="boxes",
    )


def _reading_boxes(points: Sequence[ReadPoint]) -> list[Box]:
    read = [p.point for p in points if p.point.potential_mv is not None]
    potentials = [point.potential_mv for point in read if point.potential_mv is not None]
    return [
        ("valid readings", f"{sum(p.point.valid for p in points)} / {len(points)}", ""),
        ("active by the combined rule", str(sum(p.corrosion == "active" for p in read)), ""),
        ("most negative", number(min(potentials, default=None), 0), "mV CSE"),
    ]


def is_simulated(log: RunLog) -> bool:
    """Whether the log came from the simulator: it then carries the seed and the truth."""
    return log.seed is not None or log.truth() is not None


OF_READINGS = (
    "ASTM C876 leaves the interpretation to a specialist who also knows the chloride "
    "content, the depth of carbonation, delamination, the rate of corrosion and the "
    "exposure of the structure. Potentials alone do not give the rate or the loss of steel.",
    "The class boundaries hold for uncoated steel in concrete that is not saturated; very "
    "dry, carbonated or water-saturated concrete and coated bars shift the potentials.",
    "Potentials are against copper/copper sulphate (CSE) and are not corrected for temperature.",
    "A reading is valid only after sufficient force for sufficient time and a stable "
    "potential. Invalid points are shown as such, never as values, and enter no statistics.",
)
FEW_READINGS = "With fewer than 20 valid readings, shares and cumulative frequencies are coarse."
SIMULATED_READINGS = (
    "This is a simulated flight. The readings come from a model of the specimen and of the "
    "probe, not from a structure."
)
SIMULATED = (
    "This is a simulated flight. Motion, contact and sensors are models; what their sources leave "
    "open was chosen and is listed below with the reason."
)
TRUTH_IS_SEEN = (
    "What is called true is known to the simulator alone: no controller, estimator or planner "
    "of the flight could see it."
)
PUBLISHED_ELSEWHERE = (
    f"Published values are those of another vehicle in its own experiments ({SOURCE}). They stand "
    "beside ours for comparison; what passes is decided by the mission's bounds alone."
)


def caveats(log: RunLog, result: Result, points: Sequence[ReadPoint]) -> Markup:
    """What the numbers do not say."""
    read = sum(p.point.potential_mv is not None for p in points)
    notes = []
    if is_simulated(log):
        notes += [SIMULATED_READINGS] if points else [SIMULATED, TRUTH_IS_SEEN]
    if points:
        notes += OF_READINGS
    if 0 < read < 20:
        notes.append(FEW_READINGS)
    if any(published_of(check.ref) for check in result.checks):
        notes.append(PUBLISHED_ELSEWHERE)
    if not notes:
        notes.append("Without the truth, errors are against what the vehicle itself believed.")
    return element("ul", *(element("li", note) for note in notes), class_="caveats")


def method(log: RunLog, plan: Plan) -> list[tuple[str, str]]:
    """How the readings were taken, in the order of an inspection report."""
    probe = log.platform().sensors.half_cell
    dwells = sorted({target.dwell_s for target in plan.targets if target.kind == "contact"})
    presses = sorted({target.press_m for target in plan.targets if target.kind == "contact"})
    forces = [target.expected_force_n for target in plan.targets if target.kind == "contact"]
    return [
        ("Method", "half-cell potential (ASTM C876) and resistance at each point of contact"),
        ("Reference electrode", "copper/copper sulphate (CSE)"),
        (
            "A reading counts when",
            f"the load cell shows ≥ {probe.min_force_n:g} N for ≥ {probe.min_contact_s:g} s and "
            f"the potential stays within {1e3 * probe.stable_v:g} mV over {probe.stable_s:g} s",
        ),
        ("Cell constant", f"{probe.cell_constant_m:g} m (resistivity = resistance × constant)"),
        ("Set-point behind the surface", _each(presses, "m")),
        ("Dwell", _each(dwells, "s")),
        ("Expected contact force", f"{number(max(forces), 2)} N" if forces else NOTHING),
        ("Cable", f"{probe.cable_m:g} m; the farthest point needs {number(plan.cable_m, 2)} m"),
    ]


def _each(values: Sequence[float], unit: str) -> str:
    return f"{', '.join(f'{value:g}' for value in values)} {unit}" if values else NOTHING


def finding_markup(sentences: Sequence[str]) -> Markup:
    """The finding as one paragraph, its first sentence standing out."""
    if not sentences:
        return Markup("")
    first, *rest = sentences
    return element("p", element("strong", first), joined(" ", " ".join(rest)), class_="finding")
