"""The study of the pitch: against a Monte Carlo of its own, its words, and what is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from inspect_cli import cli
from inspect_cli.commands import study_pitch
from inspect_cli.commands.fly import FlyOutcome
from inspect_cli.commands.study import study
from inspect_cli.commands.study_pitch import PITCH
from inspect_cli.commands.sweeps import variants
from inspect_cli.errors import InfeasibleError, InputError
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.schema.loading import Loaded, load_mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric, Result
from inspect_cli.schema.study import StudyResult
from inspect_cli.simulation.loop import Ending
from inspect_cli.truth.rasters import UnderSurface

MISSION = """\
schema: 1
name: pitched
platform: tilt_rotor_hexarotor
seeds: [5]
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [1.8, 0, 1.3], normal: [-1, 0, 0], size_m: [1.2, 0.9]}}
tasks:
  - coverage: {on: wall, pitch_m: 0.3, refine: {difference_mv: 150}}
truth:
  structure:
    wall:
      specimen:
        model: analytic
        potential_v: -0.12
        resistivity_ohm_m: 220.0
        spots: [{at_m: [0.05, -0.03], depth_v: 0.38, radius_m: 0.25, resistivity_factor: 0.15}]
"""
DISC_M = 0.25 * np.sqrt(-2.0 * np.log(120.0 / 187.0))
"""Radius of the truly active disc: there ρ = 220 (1 − 0.85 g) is 100 Ω·m, g the Gaussian."""
MIDDLE = np.array([0.05, -0.03])
COVERAGE = "coverage: {on: wall, pitch_m: 0.3, refine: {difference_mv: 150}}"
GRID = "contact_grid: {on: wall, rows: 3, columns: 4, pitch_m: 0.3, offset_m: [0, 0]}"
MISSED, DETECTED = "study.missed_area_m2", "study.detected_share"
FALSE, SITES = "study.false_area_m2", "study.sites_found_share"


@pytest.fixture
def mission(tmp_path: Path, root: Path) -> Path:
    shutil.copytree(root / "platforms", tmp_path / "platforms")
    (tmp_path / "missions").mkdir()
    file = tmp_path / "missions" / "pitched.yaml"
    file.write_text(MISSION)
    return file


def rewritten(mission: Path, old: str, new: str) -> Path:
    text = mission.read_text()
    assert old in text
    mission.write_text(text.replace(old, new))
    return mission


class FakeFly:
    """Detects as much as half the pitch leaves; remembers what it was asked to fly."""

    def __init__(self) -> None:
        self.flown: list[tuple[Loaded, Plan, int, Path]] = []

    def __call__(self, loaded: Loaded, plan: Plan, *, seed: int, out: Path) -> FlyOutcome:
        self.flown.append((loaded, plan, seed, out))
        share = 1.0 - 0.5 * loaded.mission.tasks[0].work.pitch_m
        result = Result(
            mission=loaded.mission.name,
            platform=loaded.platform.name,
            seed=seed,
            status="completed",
            checks=(),
            metrics={name: Metric(value=share, unit=spec.unit) for name, spec in METRICS.items()},
            points=(),
        )
        return FlyOutcome(result, out, Ending("completed", "", 1.0, 1.0, 0.0))


def expected(pitch_m: float, offsets: int = 400) -> tuple[float, float, float, float]:
    """Mean and deviation over offsets of missed and false area; nothing is shared with the code.

    Every pixel of the wall takes the verdict of its nearest point of a lattice on the wall.
    """
    rng = np.random.default_rng(11)
    step = 0.0075
    u = np.arange(-0.6 + step / 2, 0.6, step)
    v = np.arange(-0.45 + step / 2, 0.45, step)
    U, V = np.meshgrid(u, v)
    active = np.hypot(U - MIDDLE[0], V - MIDDLE[1]) <= DISC_M
    missed, false = [], []
    for ou, ov in rng.uniform(0.0, pitch_m, (offsets, 2)):
        lines_u = np.arange(-0.6 + ou, 0.6, pitch_m)
        lines_v = np.arange(-0.45 + ov, 0.45, pitch_m)
        near_u = lines_u[np.abs(U[..., None] - lines_u).argmin(axis=-1)]
        near_v = lines_v[np.abs(V[..., None] - lines_v).argmin(axis=-1)]
        said = np.hypot(near_u - MIDDLE[0], near_v - MIDDLE[1]) <= DISC_M
        missed.append(step**2 * np.sum(active & ~said))
        false.append(step**2 * np.sum(~active & said))
    return (
        float(np.mean(missed)),
        float(np.std(missed)),
        float(np.mean(false)),
        float(np.std(false)),
    )


def test_missed_and_false_areas_are_those_of_a_monte_carlo(mission: Path) -> None:
    """Means of 20 offsets within 4 standard errors of the mean of 400, plus what noise moves.

    The tool's error of 2 mm moves the ring of a third of a metre's radius by less than a tenth
    of a millimetre on the mean: 1e-3 m² is ample for it and for the raster.
    """
    result = study("pitch", mission, asked={"pitch": "0.1,0.2,0.3,0.45"}).result
    assert result.trials == 20
    missed = []
    for variant in result.sweep(result.quantities[0]):
        mean, spread, false, false_spread = expected(variant.values["pitch"])
        found = variant.value(MISSED)
        assert found == pytest.approx(mean, abs=4.0 * spread / np.sqrt(20) + 1e-3)
        assert variant.value(FALSE) == pytest.approx(
            false, abs=4.0 * false_spread / np.sqrt(20) + 1e-3
        )
        # Strata can only lower the error below that of independent offsets; 20 tell it to 60 %.
        assert 0.4 < variant.standard_errors[MISSED] / (spread / np.sqrt(20)) < 1.6
        area_m2 = np.pi * DISC_M**2
        assert variant.value(DETECTED) == pytest.approx(1.0 - found / area_m2, abs=0.01)
        missed.append(found)
    # A wider grid misses more of a disc: nobody sorts these.
    assert missed == sorted(missed)
    assert result.sweep(result.quantities[0])[0].value(SITES) == 1.0


def test_readings_are_taken_beside_their_points(
    mission: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a deviation of 2 mm along u and v; those too far from their point are not valid.

    Of errors of two axes exp(−r²/2σ²) are larger than r: 88 % than 1 mm, which then read nothing.
    """
    read: list[np.ndarray] = []
    at = UnderSurface.at

    def recording(beneath: UnderSurface, uv_m: np.ndarray):
        read.append(uv_m)
        return at(beneath, uv_m)

    monkeypatch.setattr(UnderSurface, "at", recording)
    rewritten(mission, "pitch_m: 0.3,", "pitch_m: 0.3, off_target_m: 0.001,")
    found = study("pitch", mission, asked={"pitch": "0.1"}).result.variants[0]
    grids = [uv for uv in read if len(uv) < 1000]
    assert len(grids) == 20
    beside = []
    for uv in grids:
        away = uv - uv[0]
        away -= 0.1 * np.round(away / 0.1)
        beside.append(away - away.mean(axis=0))
    assert np.concatenate(beside).std(axis=0) == pytest.approx([0.002, 0.002], rel=0.1)
    # Of some 1900 readings 12 % are valid; a disc holds 20 of them per grid.
    valid = 1.0 - np.exp(-(0.001**2) / (2.0 * 0.002**2))
    assert found.value(DETECTED) == pytest.approx(valid, abs=0.06)


def test_what_it_costs_is_planned_and_told_in_words(mission: Path) -> None:
    fly = FakeFly()
    outcome = study("pitch", mission, asked={"pitch": "0.15,0.3"}, fly=fly)
    assert fly.flown == []
    assert outcome.exit_code == 0
    folder = mission.parents[1] / "reports" / "pitched" / "study-pitch"
    result = StudyResult.model_validate_json((folder / "study.json").read_text())
    assert result == outcome.result
    fine, wide = result.sweep(result.quantities[0])
    assert (fine.value("study.points"), wide.value("study.points")) == (48.0, 12.0)
    assert fine.value("study.energy_wh") > 2.0 * wide.value("study.energy_wh")
    assert fine.value("study.duration_s") > 2.0 * wide.value("study.duration_s")
    assert {v.status for v in result.variants} == {"sampled"}
    assert {v.folder for v in result.variants} == {None}
    by_area, by_site = result.thresholds
    assert (by_area.metric, by_area.first_below, by_area.level) == (DETECTED, 0.15, 0.95)
    assert (by_site.metric, by_site.first_below) == (SITES, None)
    area, sites, falsely = result.findings
    false_m2, active_m2 = (
        fine.value("study.false_area_m2"),
        result.common["study.active_area_m2"].value,
    )
    assert false_m2
    assert falsely == (
        f"Beside {active_m2:.3f} m² that are truly active, {false_m2:.3f} m² of sound surface are "
        "judged active at 0.15 m already."
    )
    assert area.startswith("Detection is below 95 % at the finest pitch already, 0.15 m:")
    assert sites.startswith("Detection of whole sites stays at 95 % or above up to the widest")
    page = outcome.page.read_text()
    assert area in page
    assert sites in page
    assert "sampled 20 times each" in page
    assert "pitch-cost" in page
    assert study("pitch", mission, asked={"pitch": "0.15,0.3"}).result == result
    other = study("pitch", mission, asked={"pitch": "0.15,0.3"}, seed=6).result
    assert other.variants[0].metrics != result.variants[0].metrics


def test_the_first_pitch_that_misses_is_named(mission: Path) -> None:
    """A site of 0.1 m is always hit at 0.05 m, and at 0.3 m for a ninth of the offsets."""
    rewritten(mission, "radius_m: 0.25", "radius_m: 0.053")
    result = study("pitch", mission, asked={"pitch": "0.05,0.3"}).result
    assert result.thresholds[1].first_below == 0.3
    assert "first drops below 95 % at a pitch of 0.3 m" in result.findings[1]
    fine, wide = result.sweep(result.quantities[0])
    assert fine.value(SITES) == 1.0
    hit = np.pi * 0.05**2 / 0.09
    assert wide.value(SITES) == pytest.approx(hit, abs=4.0 * np.sqrt(hit * (1.0 - hit) / 20))


def test_a_solved_field_is_studied_and_what_its_rule_misses_is_told(
    root: Path, tmp_path: Path
) -> None:
    """In 150 Ω·m no site is too resistive; in 200 Ω·m the outer parts of all are.

    200 Ω·m at 20 °C are 185.3 Ω·m at 22.2 °C. Alone, a site with 185.3 (1 − 0.7 g) Ω·m passes
    100 Ω·m at g = 0.6576, at 0.9156 of its radius, so that 1 − 0.9156² = 16.2 % of it lie beyond;
    neighbours' chlorides take a little of that away.
    """
    shutil.copytree(root / "platforms", tmp_path / "platforms")
    (tmp_path / "missions").mkdir()
    for name in ("wall_pitch_study.yaml", "wall_pitch_macro_cell.yaml"):
        shutil.copy(root / "missions" / name, tmp_path / "missions" / name)
    file = tmp_path / "missions" / "wall_pitch_macro_cell.yaml"
    result = study("pitch", file).result
    missed = [variant.value(MISSED) for variant in result.sweep(result.quantities[0])]
    assert missed == sorted(missed)
    assert result.thresholds[0].first_below == 0.25
    assert result.common["study.too_resistive_area_m2"].value == 0.0
    assert not any("Ω·m" in finding for finding in result.findings)
    rewritten(file, "resistivity_ohm_m: 150.0", "resistivity_ohm_m: 200.0")
    result = study("pitch", file, asked={"pitch": "0.5"}).result
    common = {name: metric.value for name, metric in result.common.items()}
    share = common["study.too_resistive_area_m2"] / common["study.active_area_m2"]
    assert 0.14 < share < 0.165
    assert f"({100.0 * share:.1f} %) of the truly active area" in result.findings[-1]
    assert "only one beside it can be judged active" in result.findings[-1]


@pytest.mark.parametrize("electrode", ["CSE", "SCE"])
def test_verdicts_are_on_the_standards_scale(mission: Path, electrode: str) -> None:
    """In concrete of 40 °C a CSE reads 16.02 mV less; what it reads is −120 mV − 380 mV g.

    Active is where that is below −366 mV, g above 0.6475: a disc of 0.233 m. A SCE's readings
    are not corrected and need not be, its own coefficient being neglected. Verdicts on what a CSE
    reads at 40 °C would end at 0.250 m instead, 0.025 m² further; a grid of 30 mm strays by less
    than half of a tenth of that, its noise of 1 mV by a millimetre.
    """
    platform = mission.parents[1] / "platforms" / "tilt_rotor_hexarotor.yaml"
    given = platform.read_text()
    assert given.count("    kind: half_cell\n") == 1
    platform.write_text(
        given.replace("    kind: half_cell\n", f"    kind: half_cell\n    electrode: {electrode}\n")
    )
    rewritten(mission, "  - name: wall\n", "  - name: wall\n    temperature_c: 40.0\n")
    rewritten(mission, "potential_v: -0.12", "potential_v: -0.12\n        temperature_c: 40.0")
    rewritten(mission, "resistivity_ohm_m: 220.0", "resistivity_ohm_m: 60.0")
    result = study("pitch", mission, asked={"pitch": "0.05"}).result
    radius_m = 0.25 * np.sqrt(-2.0 * np.log((0.35 + 0.9e-3 * 17.8 - 0.12) / 0.38))
    found = result.variants[0]
    assert result.common["study.active_area_m2"].value == pytest.approx(
        np.pi * radius_m**2, rel=0.01
    )
    # Both errors of a grid lie along the rim and are alike.
    assert found.value(FALSE) - found.value(MISSED) == pytest.approx(0.0, abs=0.008)


@pytest.mark.parametrize(
    ("rows", "columns", "pitch_m", "found"),
    [(3, 4, 0.15, (6, 8)), (3, 4, 0.2, (4, 6)), (1, 9, 0.1, (1, 27)), (5, 1, 0.6, (2, 1))],
)
def test_rows_and_columns_keep_the_extent(
    mission: Path, rows: int, columns: int, pitch_m: float, found: tuple[int, int]
) -> None:
    text = GRID.replace("rows: 3", f"rows: {rows}").replace("columns: 4", f"columns: {columns}")
    loaded = load_mission(rewritten(mission, COVERAGE, text))
    (variant,) = variants("pitch", PITCH, loaded, {"pitch": (pitch_m,)})
    grid = variant.loaded.mission.tasks[0].contact_grid
    assert (grid.rows, grid.columns, grid.pitch_m) == (*found, pitch_m)
    assert variant.loaded.truth == loaded.truth


def test_a_coverage_is_not_refined_on_the_way(mission: Path) -> None:
    loaded = load_mission(mission)
    for variant in variants("pitch", PITCH, loaded, {}):
        coverage = variant.loaded.mission.tasks[0].coverage
        assert coverage.refine is None
        assert coverage.pitch_m == variant.values["pitch"]
    assert [v.values["pitch"] for v in variants("pitch", PITCH, loaded, {})] == [
        0.1,
        0.15,
        0.25,
        0.5,
    ]


def test_a_grid_and_a_line_are_sampled_over_what_they_cover(mission: Path) -> None:
    rewritten(mission, COVERAGE, GRID)
    result = study("pitch", mission, asked={"pitch": "0.3"}).result
    covered = result.variants[0]
    mean, spread, *_ = expected(0.3)
    assert covered.value(MISSED) == pytest.approx(mean, abs=4.0 * spread / np.sqrt(20) + 1e-3)
    # A line through the disc's middle, 0.3 m high, keeps its height and slides along u.
    line = "rows: 1, columns: 4, pitch_m: 0.3, offset_m: [0, -0.03]"
    rewritten(mission, "rows: 3, columns: 4, pitch_m: 0.3, offset_m: [0, 0]", line)
    result = study("pitch", mission, asked={"pitch": "0.05,0.3"}).result
    fine, wide = result.sweep(result.quantities[0])
    assert (fine.value("study.points"), wide.value("study.points")) == (24.0, 4.0)
    assert fine.value(SITES) == wide.value(SITES) == 1.0
    assert fine.value(DETECTED) > wide.value(DETECTED)


@pytest.mark.parametrize(
    ("option", "text", "words"),
    [
        ("pitch", "0.3,wide", "'wide' is not a finite number"),
        ("pitch", "inf", "'inf' is not a finite number"),
        ("pitch", "0", "0 m cannot be had"),
        ("pitch", "-0.1", "-0.1 m cannot be had"),
        ("gains", "1", "does not vary --gains"),
        ("pitch", "2", "pitch-2: coverage: no point of 'wall' is 1 m from its edge"),
        ("pitch", "0.001", "pitch-0.001: coverage: 'wall' holds some 1080000 points"),
    ],
)
def test_bad_values_are_refused(mission: Path, option: str, text: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        study("pitch", mission, asked={option: text})
    assert words in str(refused.value)
    assert not (mission.parents[1] / "reports").exists()


def test_a_grid_with_a_pitch_beyond_its_extent_is_refused(mission: Path) -> None:
    rewritten(mission, COVERAGE, GRID)
    with pytest.raises(InputError, match="not even one would be left"):
        study("pitch", mission, asked={"pitch": "1"})
    with pytest.raises(InfeasibleError, match=r"pitch-0\.03: .*the battery holds"):
        study("pitch", mission, asked={"pitch": "0.03"})


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (COVERAGE, "hold: {position_m: [0, 0, 1], duration_s: 5}", "a coverage or a contact_grid"),
        (COVERAGE, f"{GRID}\n  - {GRID}", "with a single task"),
        (COVERAGE, "contact_points: {on: wall, at_m: [[1.8, 0, 1.3]]}", "single task"),
        (COVERAGE, f"{GRID}\n    sensor: none", "needs readings"),
        ("    wall:\n      specimen:", "    other:\n      specimen:", ""),
        (COVERAGE, GRID.replace("rows: 3, columns: 4", "rows: 1, columns: 1"), "a single point"),
        ("depth_v: 0.38", "depth_v: 0.1", "nothing is truly active beneath the points on 'wall'"),
    ],
)
def test_missions_without_a_grid_or_a_specimen_are_refused(
    mission: Path, old: str, new: str, words: str
) -> None:
    rewritten(mission, old, new)
    if "other:" in new:
        shape = "{kind: plane, center_m: [9, 0, 1], normal: [-1, 0, 0], size_m: [1, 1]}"
        rewritten(mission, "    other:\n", f"    other:\n      geometry: {shape}\n")
        words = "needs a specimen beneath 'wall'"
    with pytest.raises(InputError) as refused:
        study("pitch", mission, asked={"pitch": "0.3"})
    assert words in str(refused.value)
    assert str(mission) in str(refused.value)


def test_an_instrument_that_cannot_be_sampled_is_refused(
    mission: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study_pitch, "VERDICTS", {"gauge": None})
    with pytest.raises(InputError, match="cannot sample this task's instrument"):
        study("pitch", mission, asked={"pitch": "0.3"})


def test_each_pitch_can_be_flown_besides(mission: Path) -> None:
    fly = FakeFly()
    outcome = study("pitch", mission, asked={"pitch": "0.3,0.45"}, fly_sampled=True, fly=fly)
    assert [out.name for *_, out in fly.flown] == ["pitch-0.3", "pitch-0.45"]
    assert [v.value("scoring.detected_share") for v in outcome.result.variants] == [0.85, 0.775]
    assert [v.status for v in outcome.result.variants] == ["completed"] * 2
    assert outcome.exit_code == 0
    assert "flown once" in outcome.page.read_text()
    with pytest.raises(InputError, match="'force' flies in any case"):
        study("force", mission, fly_sampled=True)


def test_the_command_line(mission: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["study", "pitch", str(mission), "--pitch", "0.3", "--json"]) == 0
    told = capsys.readouterr()
    result = json.loads(told.out)
    assert told.err == ""
    assert result["variants"][0]["name"] == "pitch-0.3"
    assert result["findings"][0].startswith("Detection is below 95 %")
    assert result["thresholds"][0] == {
        "metric": DETECTED,
        "quantity": "pitch",
        "level": 0.95,
        "first_below": 0.3,
    }
    assert cli.run(["study", "pitch", str(mission), "--pitch", "0.3"]) == 0
    told = capsys.readouterr()
    assert told.out == ""
    assert "Detection is below 95 %" in told.err.replace("\n", " ")
    assert "±" in told.err
    assert cli.run(["study", "pitch", str(mission), "--pitch", "x"]) == 2


@pytest.mark.xdist_group("flights")
def test_a_flight_finds_what_a_sample_can_find(mission: Path) -> None:
    """The truth is in its logs, and its detection within the samples' range.

    The flight is one offset of those that are sampled, so it lies within four of their deviations.
    """
    outcome = study("pitch", mission, asked={"pitch": "0.3"}, fly_sampled=True)
    (variant,) = outcome.result.variants
    assert variant.status == "completed"
    deviation = variant.standard_errors[DETECTED] * np.sqrt(20)
    flown = variant.value("scoring.detected_share")
    assert flown == pytest.approx(variant.value(DETECTED), abs=4.0 * deviation)
    folder = outcome.folder / variant.folder
    logs = sorted(folder.glob("sortie-*/flight.mcap"))
    assert logs
    for log in logs:
        (raster,) = read_log(log).true_rasters()
        area_m2 = raster.active.sum() * np.prod(raster.step_m)
        assert area_m2 == pytest.approx(np.pi * DISC_M**2, rel=0.01)
    saved = Result.model_validate_json((folder / "metrics.json").read_text())
    assert saved.scoring is not None
    assert saved.scoring.confusion().region_m2 == pytest.approx(1.08)
    assert saved.metrics["scoring.sites_found"].value == 1.0
