"""An instrument of an installed package, with its judge, its metric and its chapter.

It reads the temperature of the surface: 20 °C with 2 K less for each metre upwards.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from inspect_cli.schema.campaign import builtin_root

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
[inspect_cli.simulated_sensors]
thermometer = thermometer_sensing:thermometer
[inspect_cli.judges]
thermometer = thermometer_sensing:judging
[inspect_cli.instruments]
thermometer = thermometer_metrics:ROW
[inspect_cli.chapters]
temperatures = thermometer_chapter:CHAPTER
"""
PLATFORM = """\
schema: 1
extends: tilt_rotor_hexarotor.yaml
name: with_thermometer
sensors: {contact: {kind: thermometer, rate_hz: 50, settles_s: 1.0}}
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
  - contact_points: {{on: wall, at_m: [[2.0, 0.0, 1.2], [2.0, 0.1, 1.3]], dwell_s: 1.5}}
    sensor: thermometer
  - contact_points: {{on: wall, at_m: [[2.0, 0.2, 1.2]], dwell_s: 2}}
    sensor: half_cell
truth:
  structure: {{wall: {{specimen: {{model: analytic}}}}}}
acceptance:
  - {{metric: thermometer.mean_c, min: 17.4, max: 17.6}}
  - {{metric: contact.points_valid, min: 3, max: 3}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the package installed and a campaign of two missions."""
    site, campaign = tmp_path / "site", tmp_path / "campaign"
    metadata = site / "thermometer-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: thermometer\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS)
    for name, text in MODULES.items():
        (site / f"{name}.py").write_text(text, encoding="utf-8")
    for name in ("missions", "platforms"):
        (campaign / name).mkdir(parents=True)
    (campaign / "platforms" / "with_thermometer.yaml").write_text(PLATFORM)
    base = builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml"
    (campaign / "platforms" / base.name).write_text(base.read_text(encoding="utf-8"))
    for name in ("warm", "warmer"):
        (campaign / "missions" / f"{name}.yaml").write_text(MISSION.format(name=name))
    return tmp_path


def run(folder: Path, *arguments: str) -> str:
    env = os.environ | {"PYTHONPATH": str(folder / "site")}
    command = [sys.executable, "-m", "inspect_cli", *arguments]
    done = subprocess.run(
        command, cwd=folder / "campaign", env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_an_instrument_of_a_package_is_flown_by_two_workers_and_reported(folder: Path) -> None:
    out = folder / "runs"
    options = ("--jobs", "2", "--update", "--out", str(out), "--json")
    report = json.loads(run(folder, "regress", *options))
    assert [flight["verdict"] for flight in report["missions"]] == ["pass", "pass"]
    flown = out / "warm" / "with_thermometer-seed1"
    metrics = json.loads((flown / "metrics.json").read_text())
    first, second, potential = metrics["points"]
    assert first["values"]["temperature"] == pytest.approx(20.0 - 2.0 * 1.2, abs=0.02)
    assert second["values"]["temperature"] == pytest.approx(20.0 - 2.0 * 1.3, abs=0.02)
    assert "values" not in potential
    assert potential["potential_mv"] == pytest.approx(-100.0, abs=6.0)
    assert metrics["metrics"]["thermometer.mean_c"]["unit"] == "°C"
    run(folder, "report", str(flown))
    page = (flown / "report.html").read_text(encoding="utf-8")
    assert "Temperatures of the surface" in page
    assert "Point 1: 17.60 degrees." in page or "Point 1: 17.59 degrees." in page
