"""Documents of every kind of report, of plausible flights and studies."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from example_flights import Flight, spoil
from experiment_flights import drawing, force_evaluation, hold, servoing

from inspect_cli.commands.study import STUDIES
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.records import InvalidReason, Reading
from inspect_cli.reporting.content.blocks import Document
from inspect_cli.reporting.documents.flight import report_document, survey_document
from inspect_cli.reporting.studies.document import study_document
from inspect_cli.schema.coverage import CoveragePlan, Skipped, Sortie
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric
from inspect_cli.schema.study import Quantity, StudyResult, StudyVariant

Fly = Callable[..., Flight]

ACCEPTANCE = (
    {"metric": "contact.points_valid", "min": 9, "ref": "A8.map"},
    {"metric": "contact.force_mean_n", "min": 1.44, "max": 2.16, "ref": "A8.force"},
    {"metric": "contact.force_peak_n", "max": 0.5, "known_failure": "it presses with 1.8 N"},
    {"metric": "force_sensor.rmse_fy_n", "max": 2.5, "ref": "A9.force"},
)


def flown(flight: Flight) -> Document:
    """The report of a flight."""
    log = flight.log()
    evaluation = evaluate_with_arrays(log)
    result = evaluation.result
    evaluated = with_maps(evaluation.assessed)
    return report_document(log, result, flight.plan, evaluated)


def coverage(plan: Plan) -> CoveragePlan:
    """Three sorties of the same plan, and a point left out."""
    added = Sortie(number=2, added=True, plan=plan)
    sorties = [Sortie(number=1, plan=plan), added, Sortie(number=3, plan=plan)]
    left = Skipped(
        label="z-9", surface="wall", uv_m=(0.0, 0.1), p_WC=(2.0, 0.0, 1.3), reason="zu weit"
    )
    return CoveragePlan.of(sorties, [left], 12.3, 40.0)


def surveyed(flight: Flight) -> Document:
    """The report of a survey of which the second sortie was aborted."""
    log = flight.log()
    evaluation = evaluate_with_arrays(log)
    result = evaluation.result
    late = result.model_copy(update={"status": "aborted", "status_reason": "das Seil riss"})
    evaluated = with_maps(evaluation.assessed)
    survey = coverage(flight.plan)
    return survey_document(log, result, [result, late], survey, flight.plan, evaluated)


def study_result(name: str) -> StudyResult:
    """Two flown variants of a study, with a number for everything that it shows."""
    study = STUDIES[name]
    columns = study.columns + study.flown_columns
    metrics = {c.metric: Metric(value=0.5, unit=c.unit) for c in columns}
    quantities = tuple(
        Quantity(name=f.name, symbol=f.symbol, unit=f.unit, base=1.0) for f in study.factors
    )
    values = {quantity.name: 1.0 for quantity in quantities}
    other = values | {quantities[0].name: 2.0}
    errors = {c.metric: 0.1 for c in columns}
    made = {"metrics": metrics, "status": "completed", "standard_errors": errors}
    variants = tuple(
        StudyVariant(name=f"variant-{k}", folder=f"variant-{k}", values=chosen, **made)
        for k, chosen in enumerate((values, other))
    )
    result = StudyResult(
        study=name,
        title=study.title,
        mission="example-survey",
        platform="tilt_rotor_hexarotor",
        seed=1,
        expect_status="completed",
        quantities=quantities,
        columns=columns,
        variants=variants,
        trials=20 if study.sampler else 0,
    )
    return study.concluded(result) if study.concluded else result


def studied(result: StudyResult) -> Document:
    """The page of a study."""
    study = STUDIES[result.study]
    return study_document(result, study.explained, [figure(result) for figure in study.figures])


def invalid(flight: Flight) -> Flight:
    """The flight with a point for each reason to be invalid."""
    for k in range(1, 9):
        spoil(flight, k, InvalidReason(k))
    flight.status, flight.status_reason = "aborted", "no surface within reach of target 1"
    return flight


def resistive(flight: Flight) -> Flight:
    """The flight over concrete of a middling resistivity."""
    flight.rows(Reading)["resistance"] = 150.0 / 0.08
    return flight


FLIGHTS: dict[str, Callable[[Fly, Path], Flight]] = {
    "nine": lambda fly, _: fly(acceptance=ACCEPTANCE),
    "invalid": lambda fly, _: invalid(fly(3, 3)),
    "resistive": lambda fly, _: resistive(fly()),
    "real": lambda fly, _: fly().without_truth(),
    "cut": lambda fly, _: fly().cut_at(20.0),
    "drawing": lambda _, platform: drawing(platform),
    "servoing": lambda _, platform: servoing(platform),
    "pulls": lambda _, platform: hold(platform),
    "hold": lambda _, platform: hold(platform, pulls=0),
    "forces": lambda _, platform: force_evaluation(platform),
}
