"""What readings say, in results of flights and surveys; the numbers are worked out here anew."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
import pytest
from synthetic import PRESS_S, READING_ERROR_V, SyntheticFlight, nine_points, specimen

from inspect_cli.metrics.assessed import assess_points, assessor, with_uncertainty
from inspect_cli.metrics.catalogue_assessment import FINDINGS
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.planned_cells import planned_cells
from inspect_cli.metrics.survey import joined_result
from inspect_cli.records import Reading
from inspect_cli.schema.base import Strict
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.result import PointResult, Result
from inspect_cli.schema.vehicle import HalfCellModel

Model = TypeVar("Model", bound=Strict)
READ_V = np.array([specimen(k)[0] + READING_ERROR_V * (-1) ** k for k in range(9)])
SINGLE_MV = 10.0 / (1.96 * np.sqrt(2.0))
"""ASTM C876: 95 % of the differences of two readings are below 10 mV."""
MODEST_MV = 5e-4
"""1.96 is rounded."""


def changed(model: Model, path: str, value: object) -> Model:
    """A copy with another value at a path such as ``sensors.probe.electrode``."""
    name, _, rest = path.partition(".")
    if name == "sensors":
        sensor, _, rest = rest.partition(".")
        sensors = model.sensors
        value = sensors | {sensor: changed(sensors[sensor], rest, value)}
    elif rest:
        value = changed(getattr(model, name), rest, value)
    return model.model_copy(update={name: value})


def at_temperature(flight: SyntheticFlight, temperature_c: float) -> None:
    """Let the mission state the wall's temperature."""
    (wall,) = flight.mission.structure
    flight.mission = changed(
        flight.mission, "structure", (changed(wall, "temperature_c", temperature_c),)
    )


def reading_sd_mv(read_mv: np.ndarray, ohm: np.ndarray) -> np.ndarray:
    """Noise 1 mV; even within ±2.5 mV of drift; what wetting leaves of 5 mV after 1 s; 10 MΩ."""
    wetting = 5.0 / (np.exp(1.0 / 0.4) - 1.0)
    load = np.abs(read_mv) * ohm / 1e7
    return np.sqrt(1.0 + 2.5**2 / 3.0 + wetting**2 / 3.0 + load**2 / 3.0)


def test_what_nine_points_say() -> None:
    result = evaluate(nine_points().log())
    value = {name: result.metrics[name].value for name in FINDINGS}
    ohm = np.array([p.resistance_ohm for p in result.points])
    sd_mv = np.sqrt(reading_sd_mv(1e3 * READ_V, ohm) ** 2 + SINGLE_MV**2 + (0.9 * 5.5) ** 2 / 3.0)
    assert [p.potential_sd_mv for p in result.points] == pytest.approx(sd_mv, abs=MODEST_MV)
    assert value["assessment.uncertainty_median_v"] == pytest.approx(
        1e-3 * np.median(sd_mv), abs=1e-3 * MODEST_MV
    )
    assert value["assessment.potential_median_v"] == pytest.approx(np.median(READ_V))
    # Points 2 and 3 read −422 and −418 mV in 70 Ω·m: one minimum, with a step on either side.
    assert value["assessment.astm_active_share"] == 2 / 9
    assert value["assessment.active_area_m2"] == pytest.approx(2 * 0.05**2)
    assert value["assessment.gradient_active_count"] == 1.0
    assert value["assessment.proposals_count"] == 2.0
    threshold = result.metrics["assessment.mixture_threshold_v"]
    assert threshold.value is None
    assert threshold.why.startswith("valid readings: 9; two populations ask for at least")
    (wall,) = result.assessment
    assert (wall.surface, wall.points, wall.spacing_m) == ("wall", 9, (0.05, 0.05))
    assert wall.area_m2 == pytest.approx(9 * 0.05**2)
    assert {p.surface for p in result.points} == {"wall"}
    assert [p.read_mv for p in result.points] == [p.potential_mv for p in result.points]
    assert Result.model_validate_json(result.model_dump_json(by_alias=True)) == result


def test_a_firm_dry_contact_is_less_sure() -> None:
    """1 MΩ over 10 MΩ takes a tenth of the potential: of −422 mV, 42 mV / √3."""
    flight = nine_points()
    flight.rows(Reading)["resistance"][1] = 1e6
    dry = evaluate(flight.log()).points[1].potential_sd_mv
    base = SINGLE_MV**2 + (0.9 * 5.5) ** 2 / 3.0
    expected = np.sqrt(reading_sd_mv(np.array(-422.0), np.array(1e6)) ** 2 + base)
    assert dry == pytest.approx(expected, abs=MODEST_MV)
    assert expected > 24.0


def test_readings_in_warm_concrete_are_corrected_and_so_is_the_truth() -> None:
    flight = nine_points()
    flight.rows(Reading)["potential"][0] = -0.355
    at_temperature(flight, 35.0)
    result = evaluate(flight.log())
    shift_mv = 0.9 * (35.0 - 22.2)
    read_mv = 1e3 * np.r_[-0.355, READ_V[1:]]
    assert [p.read_mv for p in result.points] == pytest.approx(read_mv)
    assert [p.potential_mv for p in result.points] == pytest.approx(read_mv + shift_mv)
    assert result.points[0].astm_class == "uncertain"  # −355 mV is −343 mV at 22.2 °C
    true_mv = [1e3 * specimen(k)[0] + shift_mv for k in range(9)]
    assert [p.true_potential_mv for p in result.points] == pytest.approx(true_mv)
    error_v = result.metrics["half_cell.potential_error_max_v"].value
    assert error_v == pytest.approx(0.235)  # of the reading that was spoilt, −355 for −120 mV
    (wall,) = result.assessment
    assert (wall.basis.temperature_c, wall.basis.electrode) == (35.0, "CSE")
    assert wall.basis.temperature_correction_mv == pytest.approx(shift_mv)
    assert wall.uncertainty.temperature_mv == pytest.approx(0.9 / np.sqrt(3.0))


@pytest.mark.parametrize("temperature_c", [None, 20.0, 35.0])
def test_another_electrode_comes_back_to_the_scale_of_the_standard(
    temperature_c: float | None,
) -> None:
    """A calomel electrode reads 75 mV more; it is not corrected, what the truth says of CSE is."""
    flight = nine_points()
    if temperature_c is not None:
        at_temperature(flight, temperature_c)
    warm_v = 0.9e-3 * ((temperature_c or 22.2) - 22.2)
    flight.platform = changed(flight.platform, "sensors.probe.electrode", "SCE")
    flight.rows(Reading)["potential"] += 0.075 + warm_v
    result = evaluate(flight.log())
    evaluated_mv = 1e3 * (READ_V + warm_v)
    assert [p.potential_mv for p in result.points] == pytest.approx(evaluated_mv)
    assert [p.read_mv for p in result.points] == pytest.approx(evaluated_mv + 75.0)
    error_v = result.metrics["half_cell.potential_error_max_v"].value
    assert error_v == pytest.approx(READING_ERROR_V)
    (wall,) = result.assessment
    assert (wall.basis.electrode, wall.basis.conversion_mv) == ("SCE", -75.0)
    # One electrode agrees with itself, whichever it is; what is added for it holds to ±5 mV.
    assert wall.uncertainty.single_reading_mv == pytest.approx(SINGLE_MV, abs=MODEST_MV)
    assert wall.uncertainty.conversion_mv == pytest.approx(5.0 / np.sqrt(3.0))


def flown_apart(flight: SyntheticFlight) -> list[Result]:
    """Points 1 and 2 by one flight, the others by a second."""
    whole = evaluate(flight.log())
    return [
        whole.model_copy(update={"points": points})
        for points in (whole.points[:2], whole.points[2:])
    ]


def test_a_survey_is_assessed_anew_over_all_points() -> None:
    flight = nine_points()
    flight.rows(Reading)["potential"][:] = [-0.1, -0.1, -0.4, *[-0.1] * 6]
    apart = flown_apart(flight)
    assess_all = assessor(flight.mission, flight.platform, flight.plan.targets)
    alone = [len(assess_all(result.points)[0].steps.pairs) for result in apart]
    assert alone == [0, 1]
    joined = joined_result(apart, [], [], 1, None, assess_all)
    # The step from point 2 to 3 is between the flights.
    assert joined.metrics["assessment.proposals_count"].value == 2.0
    assert joined.assessment == evaluate(flight.log()).assessment
    assert all(p.potential_sd_mv for p in joined.points)
    without = joined_result(apart, [], [], 1)
    assert without.assessment == ()
    assert all(without.metrics[name].value is None for name in FINDINGS)


def test_points_that_nobody_came_to_are_unread_area() -> None:
    flight = nine_points()
    targets = flight.plan.targets
    first = flown_apart(flight)[:1]
    joined = joined_result(
        first,
        targets[2:],
        [],
        1,
        None,
        assessor(flight.mission, flight.platform, flight.plan.targets),
    )
    (wall,) = joined.assessment
    assert (wall.points, wall.valid, wall.invalid) == (9, 2, 7)
    assert wall.invalid_area_m2 == pytest.approx(7 * 0.05**2)
    assert [p.potential_sd_mv is None for p in joined.points] == [False] * 2 + [True] * 7


def test_a_place_that_was_read_in_two_flights_is_one_point() -> None:
    """And its failed reading spoils neither potential nor uncertainty of the other."""
    flight = nine_points()
    flight.rows(Reading)["valid"][0] = 0.0
    failed = evaluate(flight.log())
    read = evaluate(nine_points().log())
    joined = joined_result(
        [failed, read],
        [],
        [],
        1,
        None,
        assessor(flight.mission, flight.platform, flight.plan.targets),
    )
    (wall,) = joined.assessment
    assert (wall.readings, wall.points, wall.valid) == (18, 9, 9)
    assert wall.basis.merged_readings == 9
    assert joined.points[0].potential_sd_mv is None
    # Eight places read the same twice, and eight degrees of freedom are too few to believe it.
    assert wall.repeatability.degrees_of_freedom == 8
    assert joined.points[9].potential_sd_mv == pytest.approx(read.points[0].potential_sd_mv)
    assert wall.uncertainty.max_mv is not None
    assert joined.metrics["assessment.active_area_m2"].value == pytest.approx(2 * 0.05**2)


def on_surfaces(names: Sequence[str]) -> tuple[tuple[PointResult, ...], Mission]:
    """The nine points, each on the surface named; they all know 35 °C but the first."""
    flight = nine_points()
    points = evaluate(flight.log()).points
    placed = tuple(
        point.model_copy(update={"surface": name})
        for point, name in zip(points, names, strict=True)
    )
    (wall,) = flight.mission.structure
    known = [
        wall.model_copy(update={"name": name, "temperature_c": 35.0 if name == "b" else None})
        for name in dict.fromkeys(names)
        if name
    ]
    return placed, flight.mission.model_copy(update={"structure": tuple(known)})


def test_each_surface_is_assessed_by_itself() -> None:
    points, mission = on_surfaces(["b", "b", "a", "a", "a", "", "b", "b", "a"])
    probe = nine_points().platform.sensor(HalfCellModel)
    assessed = assess_points(points, mission, probe, planned_cells(nine_points().plan.targets))
    assert [one.summary.surface for one in assessed] == ["b", "a"]
    assert [one.summary.valid for one in assessed] == [4, 4]
    assert [one.summary.basis.temperature_c for one in assessed] == [35.0, None]
    active = [FINDINGS["assessment.astm_active_share"].value([one]) for one in assessed]
    assert active == [1 / 4, 1 / 4]
    assert FINDINGS["assessment.astm_active_share"].value(assessed) == 2 / 8
    own = [p.potential_mv for p in points if p.surface]
    median_v = FINDINGS["assessment.potential_median_v"].value(assessed)
    assert median_v == pytest.approx(1e-3 * np.median(np.array(own, float)))
    told = with_uncertainty(points, assessed)
    assert [p.potential_sd_mv is None for p in told] == [p.surface == "" for p in points]
    warm, cool = told[0].potential_sd_mv, told[2].potential_sd_mv
    assert warm is not None
    assert cool is not None
    assert cool**2 - warm**2 == pytest.approx(0.9**2 * (5.5**2 - 1.0) / 3.0, abs=1e-3)


def test_without_readings_there_is_nothing_to_assess() -> None:
    flight = nine_points()
    del flight.channels[Reading.topic]
    result = evaluate(flight.log())
    assert result.assessment == ()
    assert all(p.potential_sd_mv is None for p in result.points)
    assert {result.metrics[name].why for name in FINDINGS} == {"the log has no /reading"}


def test_without_a_valid_reading_the_surface_is_there_and_says_nothing() -> None:
    flight = nine_points()
    flight.rows(Reading)["valid"] = 0.0
    result = evaluate(flight.log())
    (wall,) = result.assessment
    assert (wall.valid, wall.invalid) == (0, 9)
    assert {result.metrics[name].why for name in FINDINGS} == {"no reading is valid"}
    assert all(result.metrics[name].value is None for name in FINDINGS)


def test_the_library_is_not_loaded_before_there_is_something_to_assess() -> None:
    program = (
        "import sys\n"
        "import inspect_cli.commands.fly\n"
        "from inspect_cli.metrics.assessed import assess_points\n"
        "assert assess_points((), None, None, {}) == ()\n"
        "loaded = [n for n in sys.modules if n.startswith(('shapely', 'inspect_cli.assessment'))]\n"
        "print(*sorted(loaded))\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    loaded = set(run.stdout.split())
    assert "inspect_cli.assessment.electrodes" in loaded
    for name in ("shapely", "inspect_cli.assessment.assess", "inspect_cli.assessment.mixture"):
        assert name not in loaded


def test_the_flight_presses_long_enough_for_its_rule() -> None:
    """What the expected uncertainties take for granted: a contact of more than stable_s."""
    probe = nine_points().platform.sensor(HalfCellModel)
    assert (probe.stable_v, probe.stable_s, probe.wetting_s) == (0.005, 1.0, 0.4)
    assert probe.stable_s < PRESS_S
