"""The law of progress: from rest to rest, smooth, within a speed and an acceleration."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.guidance.progress import Progress

LAWS = pytest.mark.parametrize(
    ("length_m", "speed_mps", "acceleration_mps2"),
    [(1.0, 0.1, 1.0), (0.5, 0.17, 0.5), (20.0, 1.0, 1.0), (0.01, 0.5, 1.0), (1e-4, 0.1, 1.0)],
)


def sampled(law: Progress, count: int = 20001) -> tuple[np.ndarray, np.ndarray]:
    times = np.linspace(-0.1, law.duration_s + 0.1, count)
    return times, np.array([law.at(t) for t in times])


@LAWS
def test_way_speed_and_acceleration_belong_together(
    length_m: float, speed_mps: float, acceleration_mps2: float
) -> None:
    """Trapezoids over the rates give the way and the speed: no jump up to the acceleration."""
    law = Progress.along(length_m, speed_mps, acceleration_mps2)
    times, rows = sampled(law)
    dt = times[1] - times[0]
    mean = 0.5 * (rows[1:] + rows[:-1])
    jerk = 10.0 * acceleration_mps2 / law.ramp_s
    np.testing.assert_allclose(np.diff(rows[:, 0]), dt * mean[:, 1], atol=jerk * dt**3)
    np.testing.assert_allclose(np.diff(rows[:, 1]), dt * mean[:, 2], atol=jerk * dt**2)
    assert np.abs(np.diff(rows[:, 2])).max() <= jerk * dt
    np.testing.assert_array_equal(rows[0], 0.0)
    np.testing.assert_array_equal(rows[-1], [length_m, 0.0, 0.0])
    assert (np.diff(rows[:, 0]) >= 0.0).all()


@LAWS
def test_limits_are_reached_but_not_passed(
    length_m: float, speed_mps: float, acceleration_mps2: float
) -> None:
    law = Progress.along(length_m, speed_mps, acceleration_mps2)
    _, rows = sampled(law)
    assert rows[:, 1].max() <= speed_mps * (1 + 1e-12)
    assert np.abs(rows[:, 2]).max() <= acceleration_mps2 * (1 + 1e-12)
    assert np.abs(rows[:, 2]).max() == pytest.approx(acceleration_mps2, rel=1e-3)


def test_a_short_line_allows_the_speed_that_it_allows() -> None:
    """ℓ = v T_r with T_r = 15/8 v/a."""
    law = Progress.along(0.01, 0.5, 1.0)
    assert law.speed_mps == pytest.approx(np.sqrt(8 * 0.01 / 15))
    assert law.duration_s == pytest.approx(2 * law.ramp_s)
    assert law.at(law.ramp_s)[0] == pytest.approx(0.005)


def test_no_way_takes_no_time() -> None:
    law = Progress.along(0.0, 0.1, 1.0)
    assert law.duration_s == 0.0
    assert law.at(0.5) == (0.0, 0.0, 0.0)
