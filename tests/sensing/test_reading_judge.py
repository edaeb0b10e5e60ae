"""When a visit makes a reading: scripts of measured force, potential and resistance over time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from inspect_cli.records import InvalidReason, Probe, Reading, State, TrueContact
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.sensing.half_cell import OVER_RANGE_OHM, HalfCellProbe
from inspect_cli.sensing.reading import FORCE_MEAN_S, ReadingJudge
from inspect_cli.truth.snapshot import Truth

MODEL = HalfCellModel(
    kind="half_cell",
    rate_hz=50,
    potential_noise_v=0.002,
    resistance_noise=0.03,
    force_noise_n=0.05,
    cell_constant_m=0.05,
    wetting_s=0.5,
    dry_offset_v=0.04,
    cable_m=10.0,
)
DWELL = 3.0
Script = Callable[[float], float]


def visit(
    force: Script,
    potential: Script = lambda _t: -0.3,
    resistance: Script = lambda _t: 1500.0,
    *,
    model: HalfCellModel = MODEL,
    start: float = 7.0,
) -> tuple[Reading, float]:
    """The verdict of a visit and how long it took; the scripts count from its beginning."""
    judge = ReadingJudge(model, DWELL)
    judge.begin(4, start)
    probe = Probe.create()
    k = 0
    while not judge.done(start + 0.02 * k):
        t = 0.02 * k
        probe.t_s = start + t
        probe.force, probe.potential, probe.resistance = force(t), potential(t), resistance(t)
        judge.feed(probe, np.array([1.0, 2.0, 3.0 + t]))
        k += 1
    return judge.finish(start + 0.02 * k), 0.02 * k


def reason(reading: Reading) -> InvalidReason:
    return InvalidReason(int(reading.reason))


def test_a_steady_press_is_accepted_after_the_dwell() -> None:
    reading, took = visit(lambda _t: 1.8)
    assert reason(reading) is InvalidReason.NONE
    assert (reading.valid, reading.target) == (1.0, 4.0)
    assert (reading.potential, reading.resistance) == (-0.3, 1500.0)
    assert reading.force_mean == pytest.approx(1.8)
    assert took == pytest.approx(DWELL + FORCE_MEAN_S, abs=0.05)
    assert reading.contact_s == pytest.approx(DWELL, abs=0.03)
    middle = took - 0.5 * MODEL.stable_s
    assert reading.p_WT == pytest.approx([1.0, 2.0, 3.0 + middle], abs=0.04)


def test_values_are_medians_of_the_last_second() -> None:
    """A spike of 20 % of the samples does not show; what was before the last second neither."""

    def wave(t: float) -> float:
        return 0.2 if round(t / 0.02) % 5 == 0 else -0.3

    reading, _ = visit(lambda _t: 1.8, wave, lambda t: 1500.0 if t > 2.0 else 9000.0)
    assert reading.potential == pytest.approx(-0.3)
    assert reading.resistance == 1500.0


@pytest.mark.parametrize(
    ("force", "expected", "contact_s"),
    [
        (lambda _t: 0.0, InvalidReason.NO_CONTACT, 0.0),
        (lambda _t: 0.9, InvalidReason.FORCE, 0.0),
        (lambda t: 1.8 if t < 1.5 else 0.0, InvalidReason.FORCE, 1.45),
        # Sufficient for 60 % of the time, but never for two seconds on end.
        (lambda t: 1.8 if t % 2.5 < 1.5 else 0.0, InvalidReason.FORCE, 1.45),
        (lambda _t: np.nan, InvalidReason.NO_SIGNAL, 0.0),
    ],
)
def test_force_that_does_not_last(force: Script, expected: InvalidReason, contact_s: float) -> None:
    reading, took = visit(force)
    assert reason(reading) is expected
    assert reading.valid == 0.0
    assert np.isnan(reading.potential)
    assert np.isnan(reading.resistance)
    assert took == pytest.approx(DWELL + MODEL.timeout_s, abs=0.021)
    assert reading.contact_s == pytest.approx(contact_s, abs=0.15)


def test_a_short_lift_is_bridged_by_the_mean_and_a_long_one_is_not() -> None:
    """At 1.8 N the 0.2 s mean stays above 1 N for lifts of up to 0.2 s (1 − 1/1.8) = 89 ms."""
    short, took = visit(lambda t: 0.0 if 2.0 <= t < 2.08 else 1.8)
    assert short.valid == 1.0
    assert took == pytest.approx(DWELL + FORCE_MEAN_S, abs=0.05)
    long, took = visit(lambda t: 0.0 if 2.0 <= t < 2.12 else 1.8)
    assert long.valid == 1.0
    assert took > 4.0  # two seconds on end have to follow the lift


def test_a_gap_in_the_samples_breaks_the_time() -> None:
    judge = ReadingJudge(MODEL, DWELL)
    judge.begin(0, 0.0)
    probe = Probe.create()
    probe.force, probe.resistance = 1.8, 1500.0
    for k in [*range(150), *range(200, 290)]:
        probe.t_s = 0.02 * k
        judge.feed(probe, np.zeros(3))
        assert not judge.done(probe.t_s)
    assert reason(judge.finish(6.0)) is InvalidReason.FORCE


def test_a_potential_that_moves_is_unstable() -> None:
    drift, _ = visit(lambda _t: 1.8, lambda t: -0.3 + 0.010 * t)
    assert reason(drift) is InvalidReason.UNSTABLE
    slow, _ = visit(lambda _t: 1.8, lambda t: -0.3 + 0.004 * t)
    assert slow.valid == 1.0
    lost, _ = visit(lambda _t: 1.8, lambda t: np.nan)
    assert reason(lost) is InvalidReason.UNSTABLE


def test_a_potential_that_settles_is_waited_for() -> None:
    """Moving until 5 s, then steady: accepted once the last second holds the steady part alone."""
    reading, took = visit(lambda _t: 1.8, lambda t: -0.3 + 0.1 * max(0.0, 5.0 - t))
    assert reading.valid == 1.0
    assert 5.8 < took <= 6.1
    assert reading.potential == pytest.approx(-0.3, abs=0.005)


@pytest.mark.parametrize("ohm", [OVER_RANGE_OHM, 1.1e7, np.nan, np.inf])
def test_an_open_circuit_is_no_reading(ohm: float) -> None:
    reading, _ = visit(lambda _t: 1.8, resistance=lambda _t: ohm)
    assert reason(reading) is InvalidReason.OPEN_CIRCUIT


def test_a_judge_begins_anew() -> None:
    judge = ReadingJudge(MODEL, DWELL)
    probe = Probe.create()
    probe.force, probe.potential, probe.resistance = 1.8, -0.2, 900.0
    judge.begin(0, 0.0)
    for k in range(200):
        probe.t_s = 0.02 * k
        judge.feed(probe, np.zeros(3))
    assert judge.finish(4.0).valid == 1.0
    judge.begin(1, 4.0)
    assert not judge.done(4.0)
    untouched = judge.finish(4.0)
    assert reason(untouched) is InvalidReason.NO_SIGNAL
    assert untouched.target == 1.0
    assert np.isnan(untouched.p_WT).all()


def simulated_visit(force_n: float, specimen: bool, seed: int) -> Reading:
    """A visit with the simulated probe, pressed with a steady true force."""
    probe = HalfCellProbe(MODEL, np.random.default_rng(seed))
    state, contact = State.create({"n_rotors": 0, "n_joints": 0}), TrueContact.create()
    state.f_normal = force_n
    contact.potential, contact.resistivity = (-0.35, 80.0) if specimen else (np.nan, np.nan)
    judge = ReadingJudge(MODEL, DWELL)
    judge.begin(0, 0.0)
    while not judge.done(state.t_s):
        probe.sample(Truth(state, lambda: contact))
        judge.feed(probe.measurement, np.zeros(3))
        state.t_s += 0.02
    return judge.finish(state.t_s)


@pytest.mark.parametrize("seed", range(20))
def test_the_simulated_probe_is_read_right(seed: int) -> None:
    reading = simulated_visit(1.8, True, seed)
    assert reading.valid == 1.0
    # What is left of the dry offset after 2 s at least: 40 mV e⁻⁴ = 0.7 mV, and noise.
    assert reading.potential == pytest.approx(-0.35, abs=0.003)
    assert reading.resistance == pytest.approx(1600.0, rel=0.05)


@pytest.mark.parametrize("seed", range(20))
def test_no_reading_without_enough_true_force_or_specimen(seed: int) -> None:
    assert reason(simulated_visit(0.9, True, seed)) is InvalidReason.FORCE
    assert reason(simulated_visit(0.0, True, seed)) is InvalidReason.NO_CONTACT
    assert reason(simulated_visit(1.8, False, seed)) is InvalidReason.OPEN_CIRCUIT
