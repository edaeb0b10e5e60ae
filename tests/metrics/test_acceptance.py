"""Acceptance entries: bounds, known failures, quotients and what cannot be told."""

from __future__ import annotations

import json
from typing import Any

import pytest
from synthetic import nine_points

from inspect_cli.metrics.acceptance import answer
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.schema.mission import Acceptance
from inspect_cli.schema.result import Metric, Result

METRICS = {
    "contact.force_mean_n": Metric(value=1.8, unit="N"),
    "contact.force_cv": Metric(value=None, unit="1", why="the log has no /truth/state"),
    "pull.metres_per_newton": Metric(value=0.06, unit="m/N"),
    "pull.distance_m": Metric(value=0.6, unit="m"),
}


def entry(**fields: Any) -> Acceptance:
    return Acceptance.model_validate_json(json.dumps({"metric": "contact.force_mean_n"} | fields))


def other(value: float | None) -> Result:
    metrics = {
        "pull.metres_per_newton": Metric(value=value, unit="m/N", why="" if value else "no pull"),
        "pull.force_n": Metric(value=10.0, unit="N"),
    }
    return Result(
        mission="rope-pull-1",
        platform="hexarotor",
        seed=1,
        status="completed",
        checks=(),
        metrics=metrics,
        points=(),
    )


@pytest.mark.parametrize(
    ("bounds", "verdict"),
    [
        ({"min": 1.44, "max": 2.16}, "pass"),
        ({"min": 1.8}, "pass"),
        ({"max": 1.8}, "pass"),
        ({"min": 1.8000001}, "fail"),
        ({"max": 1.7999999}, "fail"),
        ({"max": 0.0}, "fail"),
    ],
)
def test_bounds_belong_to_the_range(bounds: dict[str, float], verdict: str) -> None:
    assert answer(entry(**bounds), METRICS).verdict == verdict


def test_check_repeats_what_was_asked() -> None:
    check = answer(entry(min=1.44, max=2.16, ref="A8.force"), METRICS)
    assert (check.metric, check.value, check.unit) == ("contact.force_mean_n", 1.8, "N")
    assert (check.min, check.max, check.ref, check.reason) == (1.44, 2.16, "A8.force", "")


def test_known_failure_is_counted_apart_and_noted_when_it_holds() -> None:
    failing = answer(entry(min=3.0, known_failure="the arm is too light"), METRICS)
    assert (failing.verdict, failing.reason) == ("fail-known", "the arm is too light")
    holding = answer(entry(min=1.0, known_failure="the arm is too light"), METRICS)
    assert holding.verdict == "pass"
    assert "known failure" in holding.reason


def test_missing_never_passes_even_as_known_failure() -> None:
    for extra in ({}, {"known_failure": "reason"}):
        check = answer(entry(metric="contact.force_cv", max=1.0, **extra), METRICS)
        assert check.verdict == "not_measured"
        assert check.reason == "the log has no /truth/state"


def test_unknown_metric_suggests_the_nearest() -> None:
    check = answer(entry(metric="contact.force_maen_n", max=1.0), METRICS)
    assert check.verdict == "not_measured"
    assert "did you mean 'contact.force_mean_n'" in check.reason


PULL = {
    "metric": "pull.metres_per_newton",
    "min": 1.5,
    "over": {"mission": "rope-pull-1", "metric": "pull.metres_per_newton"},
}


def test_over_divides_by_the_other_mission() -> None:
    check = answer(entry(**PULL), METRICS, {"rope-pull-1": other(0.03)}.get)
    assert (check.verdict, check.unit) == ("pass", "1")
    assert check.value == pytest.approx(2.0)
    assert check.over == "rope-pull-1:pull.metres_per_newton"
    assert answer(entry(**PULL), METRICS, {"rope-pull-1": other(0.05)}.get).verdict == "fail"


def test_over_of_different_units() -> None:
    over = {"mission": "rope-pull-1", "metric": "pull.force_n"}
    check = answer(
        entry(metric="pull.distance_m", min=0.0, over=over), METRICS, lambda _: other(0.03)
    )
    assert check.unit == "m/(N)"
    assert check.value == pytest.approx(0.06)


def test_over_without_its_divisor_is_not_measured() -> None:
    nothing = answer(entry(**PULL), METRICS)
    not_flown = answer(entry(**PULL), METRICS, lambda _: None)
    unmeasured = answer(entry(**PULL), METRICS, lambda _: other(None))
    zero = answer(entry(**PULL), METRICS, lambda _: other(0.0))
    assert "inspect regress" in nothing.reason
    assert "not flown" in not_flown.reason
    assert "no pull" in unmeasured.reason
    assert "zero" in zero.reason
    assert {c.verdict for c in (nothing, not_flown, unmeasured, zero)} == {"not_measured"}


def test_evaluate_answers_the_mission() -> None:
    flight = nine_points(
        (
            {"metric": "contact.force_mean_n", "min": 1.44, "max": 2.16, "ref": "A8.force"},
            {"metric": "tracking.position_rmse_max_axis_m", "max": 0.01},
            {"metric": "half_cell.active_mask", "min": 6, "max": 6, "ref": "A8.map"},
        )
    )
    verdicts = [check.verdict for check in evaluate(flight.log()).checks]
    assert verdicts == ["pass", "fail", "pass"]
