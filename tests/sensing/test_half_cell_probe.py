"""The simulated half-cell: what it reads in contact, while wetting, pressed lightly, and lifted."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.records import State, TrueContact
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.sensing.half_cell import (
    FLOATING_V,
    OVER_RANGE_OHM,
    HalfCellProbe,
    steady_readings,
)
from inspect_cli.sensing.reading import ReadingJudge
from inspect_cli.truth.snapshot import Truth

QUIET = HalfCellModel(
    kind="half_cell",
    rate_hz=50,
    potential_noise_v=0.0,
    resistance_noise=0.0,
    force_noise_n=0.0,
    cell_constant_m=0.05,
    wetting_s=0.5,
    dry_offset_v=0.04,
    cable_m=10.0,
)
NOISY = QUIET.model_copy(
    update={"potential_noise_v": 0.002, "resistance_noise": 0.03, "force_noise_n": 0.1}
)


class Bench:
    """A probe over a specimen of −350 mV and 80 Ω·m."""

    def __init__(self, model: HalfCellModel, seed: int = 0) -> None:
        self.probe = HalfCellProbe(model, np.random.default_rng(seed))
        self.state = State.create({"n_rotors": 0, "n_joints": 0})
        self.contact = TrueContact.create()
        self.contact.potential, self.contact.resistivity = -0.35, 80.0

    def press(self, force: float, seconds: float) -> np.ndarray:
        """Samples (n, 3) = (V, Ω, N) at 50 Hz."""
        out = []
        for _ in range(round(50 * seconds)):
            self.state.t_s += 0.02
            self.state.f_normal = force
            self.probe.sample(Truth(self.state, lambda: self.contact))
            m = self.probe.measurement
            assert m.t_s == self.state.t_s
            out.append((m.potential, m.resistance, m.force))
        return np.array(out)


def test_a_wetted_contact_reads_the_specimen() -> None:
    potential, resistance, force = Bench(QUIET).press(2.0, 10.0)[-1]
    assert potential == pytest.approx(-0.35, abs=1e-9)
    assert resistance == pytest.approx(80.0 / 0.05)
    assert force == 2.0


def test_wetting_decays_with_its_time_constant() -> None:
    samples = Bench(QUIET).press(2.0, 2.0)
    t = 0.02 * np.arange(1, 101)
    assert samples[:, 0] == pytest.approx(-0.35 + 0.04 * np.exp(-t / 0.5))
    assert samples[:, 1] == pytest.approx(1600.0 * (1.0 + np.exp(-t / 0.5)))


def test_light_pressing_raises_the_resistance() -> None:
    assert Bench(QUIET).press(0.4, 10.0)[-1, 1] == pytest.approx(1600.0 * 1.6)


def test_a_bounce_keeps_the_contact_wet_and_a_transit_dries_it() -> None:
    bench = Bench(QUIET)
    bench.press(2.0, 3.0)
    bench.press(0.0, 0.04)
    after_bounce = bench.press(2.0, 0.02)[0, 0]
    assert after_bounce == pytest.approx(-0.35, abs=0.001)
    bench.press(0.0, 5.0)
    assert bench.press(2.0, 0.02)[0, 0] == pytest.approx(-0.35 + 0.04, abs=0.002)


@pytest.mark.parametrize("why", ["lifted", "no specimen"])
def test_an_open_circuit_floats(why: str) -> None:
    bench = Bench(NOISY)
    if why == "no specimen":
        bench.contact.potential = bench.contact.resistivity = np.nan
    force = 0.0 if why == "lifted" else 2.0
    samples = bench.press(force, 400.0)
    assert (samples[:, 1] == OVER_RANGE_OHM).all()
    # 400 s hold some 600 independent values of the wandering potential.
    assert samples[:, 0].std() == pytest.approx(FLOATING_V, rel=0.2)
    assert abs(samples[:, 0].mean()) < 0.05
    assert samples[:, 2].mean() == pytest.approx(force, abs=0.01)


def test_noise_is_as_the_model_says() -> None:
    bench = Bench(NOISY)
    bench.press(2.0, 10.0)
    samples = bench.press(2.0, 200.0)  # 10,000 samples: sd within 0.7 %, five times that
    assert samples.std(axis=0) == pytest.approx([0.002, 0.03 * 1600.0, 0.1], rel=0.036)
    assert samples.mean(axis=0) == pytest.approx([-0.35, 1600.0, 2.0], rel=0.002)


def test_readings_without_a_flight_are_those_that_the_judge_accepts() -> None:
    """Mean and spread of 200 readings each, by the probe and the judge, and in one draw.

    The median of 50 samples spreads by 1.25 σ/√50; of 200 readings the mean is known to a
    fourteenth and the spread to a twentieth of that, both tolerances are five times as wide.
    """
    rng = np.random.default_rng(4)
    wanted = 200
    accepted = []
    for seed in range(wanted):
        bench, judge = Bench(NOISY, seed), ReadingJudge(NOISY, 3.0)
        judge.begin(0, 0.0)
        while not judge.done(bench.state.t_s):
            bench.press(2.0, 0.02)
            judge.feed(bench.probe.measurement, np.zeros(3))
        reading = judge.finish(bench.state.t_s)
        assert reading.valid == 1.0
        accepted.append((reading.potential, reading.resistance))
    flown = np.array(accepted)
    specimen = np.full(wanted, -0.35), np.full(wanted, 80.0)
    drawn = np.column_stack(steady_readings(NOISY, *specimen, 50.0, 3.0, rng))
    spread = 1.25 / np.sqrt(50) * np.array([0.002, 0.03 * 1600.0])
    for k in range(2):
        apart = abs(drawn[:, k].mean() - flown[:, k].mean())
        assert apart < 5.0 * spread[k] * np.sqrt(2.0 / wanted)
        for readings in (drawn, flown):
            assert readings[:, k].std() == pytest.approx(spread[k], rel=0.25)


def test_a_place_without_a_specimen_has_no_reading() -> None:
    volts, ohms = steady_readings(
        QUIET,
        np.array([np.nan, -0.35]),
        np.array([np.nan, 80.0]),
        50.0,
        10.0,
        np.random.default_rng(1),
    )
    assert np.isnan(volts[0])
    assert np.isnan(ohms[0])
    assert volts[1] == pytest.approx(-0.35, abs=1e-8)
    assert ohms[1] == pytest.approx(1600.0)


@pytest.mark.parametrize(
    ("electrode", "shift_v"),
    [("CSE", 0.0), ("SCE", 0.075), ("Ag/AgCl sat. KCl", 0.119), ("Ag/AgCl 0.1 M KCl", 0.0265)],
)
def test_it_reads_against_its_electrode(electrode: str, shift_v: float) -> None:
    """The specimen's −350 mV are against CSE; at 35 °C a CSE reads 11.52 mV less than others."""
    model = QUIET.model_copy(update={"electrode": electrode})
    bench = Bench(model)
    assert bench.press(2.0, 10.0)[-1, 0] == pytest.approx(-0.35 + shift_v, abs=1e-8)
    bench.probe = HalfCellProbe(model, np.random.default_rng(0), [22.2, 35.0])
    warm_v = 0.0 if electrode == "CSE" else 0.01152
    for surface, more_v in ((0, 0.0), (1, warm_v), (-1, 0.0)):
        bench.contact.surface = surface
        read_v = bench.press(2.0, 10.0)[-1, 0]
        assert read_v == pytest.approx(-0.35 + shift_v + more_v, abs=1e-8)
