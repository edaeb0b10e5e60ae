"""A campaign on measured concrete: a real slab's potentials, read by the flying probe."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import numpy as np
import pytest

from inspect_cli.commands.fly import fly
from inspect_cli.commands.report import report
from inspect_cli.log.reader import read_log
from inspect_cli.records import Reading, TrueContact
from inspect_cli.schema.result import Result

PITCH_M = 0.1016
EVERY = 3
MISSION = f"""\
schema: 1
name: slab
platform: tilt_rotor_hexarotor
start: {{takeoff_height_m: 1.0}}
structure:
  - name: slab
    surface:
      shape: {{kind: plane, center_m: [2.5, 0, 1.9], normal: [-1, 0, 0], size_m: [2.4, 3.2]}}
tasks:
  - contact_grid:
      on: slab
      rows: 10
      columns: 3
      pitch_m: {EVERY * PITCH_M}
      # Rows 0, 3, … 27 of 0 … 28 have their middle half a pitch above the grid's.
      offset_m: [0.0, {0.5 * PITCH_M}]
truth:
  structure:
    slab:
      specimen:
        model: grid
        potential_mv: slab1.csv
        resistivity_kohm_cm: resistivity_S1AC.txt
        pitch_m: {PITCH_M}
"""


@pytest.fixture(scope="module")
def campaign(shared_data: Path, root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slab")
    (folder / "missions").mkdir()
    shutil.copytree(root / "platforms", folder / "platforms")
    for name in ("slab1.csv", "resistivity_S1AC.txt"):
        shutil.copy(shared_data / "half_cell" / name, folder / "missions")
    (folder / "missions" / "slab.yaml").write_text(MISSION)
    return folder


@pytest.fixture(scope="module")
def flown(campaign: Path) -> tuple[Result, Path]:
    outcome = fly(campaign / "missions" / "slab.yaml", seed=1)
    return outcome.result, outcome.folder


@pytest.fixture(scope="module")
def measured(campaign: Path) -> np.ndarray:
    """The slab's potentials (29, 9), mV, read without the project's code."""
    with (campaign / "missions" / "slab1.csv").open() as file:
        rows = list(csv.reader(file))
    return np.array([[float(cell) for cell in row[1:]] for row in rows[1:]])


@pytest.mark.real_data
def test_every_point_reads_the_field_at_its_true_contact(flown: tuple[Result, Path]) -> None:
    result, folder = flown
    assert result.status == "completed"
    assert [p.label for p in result.points if not p.valid] == []
    log = read_log(folder / "flight.mcap")
    contact, readings = log.rows(TrueContact), log.rows(Reading)
    assert contact is not None
    assert readings is not None
    assert len(readings) == 30
    for reading in readings:
        during = (contact["t_s"] > reading["t_s"] - 1.0) & (contact["t_s"] <= reading["t_s"])
        field = float(np.median(contact["potential"][during]))
        assert abs(reading["potential"] - field) < 0.010


@pytest.mark.real_data
def test_every_point_reads_the_slab(flown: tuple[Result, Path], measured: np.ndarray) -> None:
    result, _ = flown
    down, across = np.gradient(measured, PITCH_M)
    slope = np.hypot(down, across)
    for point in result.points:
        index = int(point.label) - 1  # points are visited in another order than they are counted
        row, column = EVERY * (index // 3), 1 + EVERY * (index % 3)
        assert point.potential_mv is not None
        assert point.position_error_m is not None
        # Between nodes the field is steeper than the gradient at a node at most by its neighbours'.
        around = slope[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].max()
        allowed = 10.0 + around * point.position_error_m
        assert abs(point.potential_mv - measured[row, column]) < allowed, point.label


@pytest.mark.real_data
def test_the_slab_is_reported(flown: tuple[Result, Path]) -> None:
    _, folder = flown
    (outcome,) = report([folder])
    assert outcome.page.stat().st_size > 1e6
    with (folder / "readings.csv").open() as file:
        assert sum(1 for _ in csv.reader(file)) == 31
