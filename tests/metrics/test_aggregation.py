"""Several flights as one: every rule by hand, and what is missing stays missing."""

from __future__ import annotations

import math

import pytest
from synthetic import nine_points

from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.survey import joined_metrics, joined_result
from inspect_cli.schema.mission import Acceptance
from inspect_cli.schema.result import Metric, Result


@pytest.fixture(scope="module")
def flown() -> Result:
    return evaluate(nine_points().log())


def changed(result: Result, **values: float | None) -> Result:
    """The result with other values, by the last part of the metrics' names."""
    metrics = dict(result.metrics)
    for name in metrics:
        key = name.split(".")[1]
        if key in values:
            metrics[name] = Metric(value=values[key], unit=metrics[name].unit, why="changed")
    return result.model_copy(update={"metrics": metrics})


def value(metrics: dict[str, Metric], name: str) -> float:
    found = metrics[name].value
    assert found is not None, metrics[name].why
    return found


def test_two_equal_flights_double_what_adds_up_and_keep_the_rest(flown: Result) -> None:
    joined = joined_metrics([flown, flown])
    assert joined.keys() == METRICS.keys()
    for name, spec in METRICS.items():
        alone = flown.metrics[name].value
        if spec.joined.rule in ("none", "anew"):
            assert joined[name].value is None
        elif alone is not None:
            share = 2.0 if spec.joined.rule == "sum" else 1.0
            assert value(joined, name) == pytest.approx(share * alone, rel=1e-12), name


def test_each_rule_by_hand(flown: Result) -> None:
    first = changed(
        flown,
        duration_s=100.0,
        energy_wh_planned=10.0,
        energy_wh_flown=8.0,
        energy_planned_over_flown=1.25,
        points_total=2.0,
        valid_share=1.0,
        force_peak_n=5.0,
        force_mean_min_n=1.7,
        position_rmse_x_m=0.003,
        saturated_share=0.0,
    )
    second = changed(
        flown,
        duration_s=300.0,
        energy_wh_planned=30.0,
        energy_wh_flown=32.0,
        energy_planned_over_flown=0.9375,
        points_total=6.0,
        valid_share=0.5,
        force_peak_n=4.0,
        force_mean_min_n=1.6,
        position_rmse_x_m=0.005,
        saturated_share=0.04,
    )
    joined = joined_metrics([first, second])
    assert value(joined, "flight.duration_s") == 400.0
    assert value(joined, "flight.energy_planned_over_flown") == pytest.approx(40.0 / 40.0)
    assert value(joined, "contact.valid_share") == pytest.approx(5.0 / 8.0)
    assert value(joined, "contact.force_peak_n") == 5.0
    assert value(joined, "contact.force_mean_min_n") == 1.6
    assert value(joined, "flight.saturated_share") == pytest.approx(0.03)
    # √((100 · 9 + 300 · 25) / 400) mm
    assert value(joined, "tracking.position_rmse_x_m") == pytest.approx(1e-3 * math.sqrt(21.0))


def test_what_one_flight_lacks_is_not_measured(flown: Result) -> None:
    joined = joined_metrics([flown, changed(flown, force_peak_n=None)])
    assert joined["contact.force_peak_n"].value is None
    assert joined["contact.force_peak_n"].why.startswith("sortie 2: ")
    weightless = joined_metrics([flown, changed(flown, duration_s=None)])
    assert weightless["tracking.position_rmse_x_m"].value is None
    assert weightless["contact.force_peak_n"].value is not None


def test_points_of_flights_that_were_not_flown(flown: Result) -> None:
    targets = nine_points().plan.targets[:3]
    accepted = [Acceptance(metric="contact.valid_share", min=1.0)]
    joined = joined_result([flown], targets, accepted, 7)
    assert joined.status == "interrupted"
    assert joined.seed == 7
    assert [point.index for point in joined.points] == list(range(12))
    assert [point.reason for point in joined.points[9:]] == ["not visited"] * 3
    assert value(joined.metrics, "contact.points_total") == 12.0
    assert value(joined.metrics, "contact.points_valid") == 9.0
    assert value(joined.metrics, "contact.valid_share") == 0.75
    assert value(joined.metrics, "half_cell.map_mismatches") == 3.0
    assert joined.checks[0].verdict == "fail"
    assert not joined.passed


def test_the_first_flight_that_was_not_completed_gives_the_status(flown: Result) -> None:
    aborted = flown.model_copy(update={"status": "aborted", "status_reason": "lost its pose"})
    joined = joined_result([flown, aborted], nine_points().plan.targets[:1], [], 1)
    assert joined.status == "aborted"
    assert joined.status_reason == "sortie 2 was aborted: lost its pose"
    assert joined_result([flown, flown], [], [], 1).status == "completed"
