"""One package outside adds a row to each registry; its vehicle is flown and reported.

Its instrument, with a judge, a metric and a chapter, reads the temperature of the surface: 20 °C
with 2 K less for each metre upwards. The rest of the package stands in ``outside_rows``.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import outside_rows
import outside_shown
import pytest

from inspect_cli.errors import SchemaError
from inspect_cli.log.reader import RunLog, read_log
from inspect_cli.schema.campaign import builtin_root
from inspect_cli.schema.loading import load_mission

MODULES = {
    "thermometer_model": '''
from typing import Literal
from inspect_cli.schema.vehicle.sensors.base import InstrumentModel

class ThermometerModel(InstrumentModel):
    """A contact thermometer."""

    kind: Literal["thermometer"]
    settles_s: float
''',
    "thermometer_records": '''
from inspect_cli.records import PointReading, Record, scalar

class Temperature(Record):
    """One sample."""

    topic = "/sensor/thermometer"
    temperature = scalar("°C", "of the surface")
    force = scalar("N", "on the probe")

class TemperatureReading(PointReading):
    """The temperature of a point."""

    topic = "/reading/thermometer"
    temperature = scalar("°C", "of the surface")
''',
    "thermometer_sensing": """
from functools import partial
from inspect_cli.interfaces import Judging
from inspect_cli.records import InvalidReason
from thermometer_records import Temperature, TemperatureReading

class Thermometer:
    def __init__(self):
        self.measurement = Temperature.create()

    def sample(self, truth):
        self.measurement.t_s = truth.state.t_s
        self.measurement.temperature = 20.0 - 2.0 * truth.state.p_WT[2]
        self.measurement.force = truth.state.f_normal
        return self.measurement

def thermometer(model, around):
    return Thermometer()

class Settled:
    def __init__(self, model, dwell_s):
        self._wait_s = max(model.settles_s, dwell_s)

    def begin(self, target, t_s):
        self._target, self._since_s, self._last = target, t_s, None

    def feed(self, sample, p_WT):
        self._last = sample.temperature, sample.force, p_WT.copy()

    def done(self, t_s):
        return t_s - self._since_s >= self._wait_s

    def finish(self, t_s):
        reading = TemperatureReading.create()
        reading.t_s, reading.target = t_s, self._target
        if self._last is None:
            reading.void(InvalidReason.NO_SIGNAL)
            return reading
        reading.temperature, reading.force_mean, reading.p_WT = self._last
        reading.valid = 1.0
        return reading

def judging(model):
    return Judging(Temperature, TemperatureReading, partial(Settled, model))
""",
    "thermometer_metrics": """
from inspect_cli.metrics.flight import mean
from inspect_cli.metrics.instrument import Instrument, PointReader
from inspect_cli.metrics.points import contact_points
from inspect_cli.metrics.spec import MetricSpec
from thermometer_records import TemperatureReading
import numpy as np

READER = PointReader("thermometer", TemperatureReading)

def mean_c(flight):
    points = contact_points(READER, flight)
    return mean(np.array([p.values["temperature"] for p in points if p.valid]))

ROW = Instrument(
    READER,
    {"thermometer.mean_c": MetricSpec("°C", mean_c, "mean temperature", (TemperatureReading,))},
)
""",
    "thermometer_chapter": """
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.content.blocks import Paragraph

def temperatures(material):
    points = [point for point in material.result.points if "temperature" in point.values]
    return [Paragraph(f"Point {p.label}: {p.values['temperature']:.2f} degrees.") for p in points]

CHAPTER = Chapter(
    heading="Temperatures of the surface",
    applies=lambda material: "thermometer" in material.plan.instruments,
    blocks=temperatures,
)
""",
}
ENTRY_POINTS = """
[inspect_cli.sensors]
thermometer = thermometer_model:ThermometerModel
barometer = barometer_model:BarometerModel
[inspect_cli.simulated_sensors]
thermometer = thermometer_sensing:thermometer
barometer = barometer_sensor:barometer
[inspect_cli.judges]
thermometer = thermometer_sensing:judging
[inspect_cli.instruments]
thermometer = thermometer_metrics:ROW
[inspect_cli.chapters]
temperatures = thermometer_chapter:CHAPTER
"""
PLATFORM = """\
schema: 1
extends: survey_rotor.yaml
name: with_thermometer
sensors:
  contact: {kind: thermometer, rate_hz: 50, settles_s: 1.0}
  altitude: {kind: barometer, rate_hz: 20, noise_m: 0.0}
"""
MISSION = """\
schema: 1
name: {name}
platform: with_thermometer
seeds: [1]
structure:
  - name: wall
    surface:
      shape: {{kind: plane, center_m: [2.0, 0.0, 1.2], normal: [-1, 0, 0], size_m: [2, 2]}}
tasks:
  - tap: {{on: {surface}, at_m: [0.0, 0.0], up_m: 0.1, dwell_s: 1.5}}
    sensor: thermometer
{more}truth:
  structure: {{wall: {{specimen: {{model: slope, slope_vpm: -0.5}}}}}}
  disturbances: [{{kind: updraught, force_n: 2.0}}]
  faults: [{{sensor: altitude, fault: nan, start_s: 2.0, end_s: 3.0}}]
acceptance:
  - {{metric: thermometer.mean_c, min: 17.4, max: 17.6}}
  - {{metric: contact.points_valid, min: {points}, max: {points}}}
"""
POTENTIAL = """\
  - contact_points: {on: wall, at_m: [[2.0, -0.1, 1.2]], dwell_s: 2}
    sensor: half_cell
"""


def mission(name: str, surface: str = "wall", *, potential: bool = True) -> str:
    """A mission that reads with the instrument of the package, and with a half-cell."""
    more, points = (POTENTIAL, 3) if potential else ("", 2)
    return MISSION.format(name=name, surface=surface, more=more, points=points)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package installed and a campaign of two missions."""
    folder = tmp_path_factory.mktemp("outside")
    site, campaign = folder / "site", folder / "campaign"
    metadata = site / "outside-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: outside\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS + outside_rows.ENTRY_POINTS)
    for name, text in (MODULES | outside_rows.MODULES).items():
        (site / f"{name}.py").write_text(text, encoding="utf-8")
    for name in ("missions", "platforms"):
        (campaign / name).mkdir(parents=True)
    (campaign / "platforms" / "with_thermometer.yaml").write_text(PLATFORM)
    base = builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml"
    text = base.read_text(encoding="utf-8").replace("kind: tilt_rotor\n", "kind: survey_rotor\n")
    text = text.replace(f"name: {base.stem}\n", "name: survey_rotor\n")
    (campaign / "platforms" / "survey_rotor.yaml").write_text(text, encoding="utf-8")
    for text, name in ((mission("both"), "both"), (mission("warm", potential=False), "warm")):
        (campaign / "missions" / f"{name}.yaml").write_text(text)
    return folder


def run(folder: Path, *arguments: str, exit_code: int = 0) -> str:
    """What ``inspect`` prints in a process that has the package."""
    done = python(folder, "-m", "inspect_cli", *arguments, exit_code=exit_code)
    return done.stdout if exit_code == 0 else done.stderr


def python(folder: Path, *arguments: str, exit_code: int = 0) -> subprocess.CompletedProcess[str]:
    """A process that has the package."""
    env = os.environ | {"PYTHONPATH": str(folder / "site"), "COLUMNS": "200"}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder / "campaign",
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == exit_code, done.stdout + done.stderr
    return done


REPORT = ("-m", "inspect_cli", "report", "--no-pictures", "--export", "geojson,ifc")


@pytest.fixture(scope="module")
def runs(folder: Path) -> dict[str, Path]:
    """The runs of two missions that two workers fly, by name."""
    out = folder / "runs"
    options = ("--jobs", "2", "--update", "--out", str(out), "--json")
    report = json.loads(run(folder, "regress", *options))
    assert [flight["verdict"] for flight in report["missions"]] == ["pass", "pass"]
    return {name: out / name / "with_thermometer-seed1" for name in ("both", "warm")}


@pytest.fixture(scope="module")
def in_terminal(folder: Path, runs: dict[str, Path]) -> dict[str, str]:
    """What the terminal shows when each run is reported."""
    return {name: python(folder, *REPORT, str(run)).stderr for name, run in runs.items()}


@pytest.fixture(scope="module")
def flown(runs: dict[str, Path], in_terminal: dict[str, str]) -> Path:
    """The run with both instruments, reported."""
    return runs["both"]


@pytest.fixture(scope="module")
def log(flown: Path) -> RunLog:
    return read_log(flown / "flight.mcap")


def test_its_instrument_is_read_beside_the_half_cell(flown: Path) -> None:
    metrics = json.loads((flown / "metrics.json").read_text())
    first, second, potential = metrics["points"]
    assert first["values"]["temperature"] == pytest.approx(20.0 - 2.0 * 1.2, abs=0.02)
    assert second["values"]["temperature"] == pytest.approx(20.0 - 2.0 * 1.3, abs=0.02)
    assert first["instrument"] == second["instrument"] == "thermometer"
    assert first["units"] == {"temperature": "°C"}
    assert not {"instrument", "values", "units"} & potential.keys()
    assert metrics["metrics"]["thermometer.mean_c"]["unit"] == "°C"
    # Its specimen: −0.2 V − 0.5 V/m · 0.1 m, and what a placement error of 5 mm and noise make.
    assert potential["potential_mv"] == pytest.approx(-250.0, abs=6.0)


def test_its_chapter_stands_in_the_report(flown: Path) -> None:
    page = (flown / "report.html").read_text(encoding="utf-8")
    assert "Temperatures of the surface" in page
    assert "Point 1: 17.60 degrees." in page or "Point 1: 17.59 degrees." in page


def test_its_points_are_shown_beside_those_of_the_half_cell(
    flown: Path, in_terminal: dict[str, str]
) -> None:
    outside_shown.in_terminal(in_terminal["both"])
    outside_shown.on_page((flown / "report.html").read_text(encoding="utf-8"))
    outside_shown.handed_out(flown)


def test_the_half_cell_is_silent_where_it_read_nothing(
    runs: dict[str, Path], in_terminal: dict[str, str]
) -> None:
    assert "potential" not in in_terminal["warm"]
    outside_shown.without_half_cell(runs["warm"])


def test_pictures_mark_the_points_of_both(folder: Path, flown: Path) -> None:
    legend = python(folder, "-c", outside_shown.LEGEND, str(flown / "flight.mcap")).stdout
    assert legend.strip() == "['uncertain', 'reading']"


def test_its_task_is_planned_for_its_kind_of_platform(flown: Path) -> None:
    plan = json.loads((flown / "plan.json").read_text())
    assert plan["platform"] == "with_thermometer"
    targets = plan["targets"]
    assert [target["label"] for target in targets] == ["1", "2", "3"]
    assert [target["uv_m"] for target in targets[:2]] == [[0.0, 0.0], [0.0, 0.1]]
    assert [target["sensor"] for target in targets] == ["thermometer", "thermometer", "half_cell"]
    assert targets[0]["law"]["depth_m"] == 0.1


def test_its_sensor_is_logged_at_its_rate_and_spoiled_by_its_fault(log: RunLog) -> None:
    rows, state = log.channels["/sensor/barometer"], log.channels["/truth/state"]
    rate_hz = (len(rows) - 1) / float(rows["t_s"][-1] - rows["t_s"][0])
    assert rate_hz == pytest.approx(20.0, rel=1e-6)
    lost = np.isnan(rows["height"])
    assert list(rows["t_s"][lost]) == pytest.approx([2.0 + 0.05 * k for k in range(20)])
    true = state["p_WB"][np.searchsorted(state["t_s"], rows["t_s"]), 2]
    assert np.nanmax(np.abs(rows["height"] - true)) < 1e-9


def test_its_disturbance_acts(log: RunLog) -> None:
    state = log.channels["/truth/state"]
    up_n = state["wrench_ext_B"][state["p_WB"][:, 2] > 0.6, 2]
    assert np.median(up_n) == pytest.approx(2.0, abs=0.2)


def test_the_surface_that_its_task_names_must_be_there(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "missions").mkdir()
    cold = tmp_path / "missions" / "cold.yaml"
    cold.write_text(mission("cold", surface="wal"))
    shutil.copytree(folder / "campaign" / "platforms", tmp_path / "platforms")
    message = " ".join(run(folder, "plan", str(cold), exit_code=2).split())
    line = cold.read_text().split("on: wal,")[0].count("\n") + 1
    assert f"cold.yaml:{line}:" in message
    assert "no surface is named 'wal'" in message


def test_without_the_package_its_kinds_are_refused(folder: Path) -> None:
    with pytest.raises(SchemaError, match="survey_rotor"):
        load_mission(folder / "campaign" / "missions" / "warm.yaml")
