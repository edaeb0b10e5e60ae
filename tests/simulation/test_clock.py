"""The schedule against brute force over every physics step."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from inspect_cli.schema.vehicle import Rates
from inspect_cli.simulation.clock import Clock

FLIGHT = {"imu": 250, "pose": 100, "tof": 10, "probe": 50, "guidance": 5, "log": 100}


def is_due(step: int, physics_hz: int, hz: int) -> bool:
    """Whether some k/hz lies in the step that ends here, after the one before."""
    return step * hz // physics_hz > (step - 1) * hz // physics_hz


@pytest.mark.parametrize(
    ("physics_hz", "rates"),
    [
        (1000, FLIGHT | {"odometry": 30}),
        (4000, FLIGHT | {"odometry": 30, "wall": 800}),
        (1000, {"odd": 333, "prime": 7, "a": 999}),
        (1000, {"odometry": 30}),
        (1000, FLIGHT),
        (1000, {"only": 8}),
        (1000, {"a": 1000, "b": 125}),
        (600, {"a": 200, "b": 120, "c": 75}),
        (1000, {"slow": 1, "odd": 40}),
    ],
)
def test_every_tick_and_no_other(physics_hz: int, rates: dict[str, int]) -> None:
    limit_s = 3.0
    expected = []
    for step in range(int(limit_s * physics_hz) + 1):
        due = {name for name, hz in rates.items() if is_due(step, physics_hz, hz)}
        if due:
            expected.append((step, due))
    ticks = list(Clock(physics_hz, rates).ticks(limit_s))
    assert [(tick.step, set(tick.due)) for tick in ticks] == expected
    for tick, following in itertools.pairwise(ticks):
        assert tick.step + tick.steps_to_next == following.step
    assert [tick.t_s for tick in ticks] == [tick.step / physics_hz for tick in ticks]


def test_the_first_tick_has_everything_due() -> None:
    first = next(Clock(1000, FLIGHT).ticks(1.0))
    assert (first.step, first.t_s, set(first.due)) == (0, 0.0, set(FLIGHT))


def test_hours_later_the_time_is_not_accumulated() -> None:
    *_, last = Clock(1000, {"slow": 1}).ticks(20_000.0)
    assert last.t_s == 20_000.0


@pytest.mark.parametrize("hz", [0, -5, 1001, 2000])
def test_rates_that_no_step_can_keep_are_refused(hz: int) -> None:
    with pytest.raises(ValueError, match="between 1 and 1000 Hz"):
        Clock(1000, {"fine": 100, "bad": hz})


def test_an_uneven_rate_is_never_early_and_less_than_a_step_late() -> None:
    times = [tick.t_s for tick in Clock(1000, {"odometry": 30}).ticks(100.0)]
    late = np.array(times) - np.arange(len(times)) / 30.0
    assert len(times) == 3001
    assert late.min() >= -1e-9
    assert late.max() < 1e-3
    assert times[:4] == [0.0, 0.034, 0.067, 0.100]


@pytest.mark.parametrize("name", sorted(set(Rates.model_fields) - {"physics_hz"}))
def test_a_platform_with_such_rates_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match=name):
        Rates(**{name: 300})
