"""An instrument of an installed package, with its judge, its metric and its chapter.

It reads the temperature of the surface: 20 °C with 2 K less for each metre upwards.
"""

from __future__ import annotations

import csv
import html
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import ifcopenshell
import ifcopenshell.util.element
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
{more}truth:
  structure: {{wall: {{specimen: {{model: analytic}}}}}}
acceptance:
  - {{metric: thermometer.mean_c, min: 17.4, max: 17.6}}
  - {{metric: contact.points_valid, min: {points}, max: {points}}}
"""
POTENTIAL = """\
  - contact_points: {on: wall, at_m: [[2.0, 0.2, 1.2]], dwell_s: 2}
    sensor: half_cell
"""
MISSIONS = {
    "both": MISSION.format(name="both", more=POTENTIAL, points=3),
    "warm": MISSION.format(name="warm", more="", points=2),
}
"""One reads with both instruments, one with that of the package alone."""


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
    for name, mission in MISSIONS.items():
        (campaign / "missions" / f"{name}.yaml").write_text(mission)
    return tmp_path


LEGEND = """
import sys
from pathlib import Path
from inspect_cli.commands.pictures import mark_styles
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.pictures.direction import direct

log = read_log(Path(sys.argv[1]))
print([entry.label for entry in direct(log, evaluate(log), mark_styles("en")).script.legend])
"""
"""Prints what the pictures of a flight explain."""


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return python(folder, "-m", "inspect_cli", *arguments)


def python(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    env = os.environ | {"PYTHONPATH": str(folder / "site"), "COLUMNS": "200"}
    command = [sys.executable, *arguments]
    done = subprocess.run(
        command, cwd=folder / "campaign", env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done


def test_an_instrument_of_a_package_is_flown_by_two_workers_and_reported(folder: Path) -> None:
    out = folder / "runs"
    options = ("--jobs", "2", "--update", "--out", str(out), "--json")
    report = json.loads(run(folder, "regress", *options).stdout)
    assert [flight["verdict"] for flight in report["missions"]] == ["pass", "pass"]
    both, warm = (out / name / "with_thermometer-seed1" for name in MISSIONS)
    metrics = json.loads((both / "metrics.json").read_text())
    first, second, potential = metrics["points"]
    assert first["values"]["temperature"] == pytest.approx(20.0 - 2.0 * 1.2, abs=0.02)
    assert second["values"]["temperature"] == pytest.approx(20.0 - 2.0 * 1.3, abs=0.02)
    assert first["instrument"] == second["instrument"] == "thermometer"
    assert first["units"] == {"temperature": "°C"}
    assert not {"instrument", "values", "units"} & potential.keys()
    assert potential["potential_mv"] == pytest.approx(-100.0, abs=6.0)
    assert metrics["metrics"]["thermometer.mean_c"]["unit"] == "°C"
    shown = ("--no-pictures", "--export", "geojson,ifc")
    in_terminal(run(folder, "report", str(both), *shown).stderr)
    on_page((both / "report.html").read_text(encoding="utf-8"))
    handed_out(both)
    said = run(folder, "report", str(warm), *shown).stderr
    assert "potential" not in said
    without_half_cell(warm)
    legend = python(folder, "-c", LEGEND, str(both / "flight.mcap")).stdout
    assert legend.strip() == "['passive', 'reading']"


def in_terminal(said: str) -> None:
    """Each instrument has a table of its own points."""
    values, potentials = said.split("points of thermometer")[1].split("points ", 1)
    rows = [line.split() for line in values.splitlines() if "valid" in line]
    assert [row[:2] for row in rows] == [["1", "valid"], ["2", "valid"]]
    assert [float(row[2]) for row in rows] == pytest.approx([17.6, 17.4], abs=0.02)
    assert "temperature" in values
    assert "/°C" in values
    assert [line.split()[0] for line in potentials.splitlines() if " valid  " in line] == ["3"]


def section(page: str, name: str) -> str:
    """The text of a section, its cells apart; empty where the page has no such section."""
    found = re.search(rf'<section id="{name}".*?</section>', page, re.DOTALL)
    text = re.sub(r"<script.*?</script>", "", found.group() if found else "", flags=re.DOTALL)
    return re.sub(r"(\s*\|\s*)+", " | ", html.unescape(re.sub(r"<[^>]+>", "|", text)))


def scene(page: str) -> dict[str, list[str]]:
    """What the view of the structure shows under the pointer, by the names of its traces."""
    found = re.search(r'data-plot="plot-scene"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert found
    return {t["name"]: t["customdata"] for t in json.loads(found[1])["data"] if "customdata" in t}


def on_page(page: str) -> None:
    """A generic table beside the package's own chapter; the half-cell's shows its own point."""
    readings, potentials = section(page, "readings"), section(page, "survey")
    assert "temperature | °C" in readings
    for label, celsius in (("1", 17.6), ("2", 17.4)):
        row = re.search(rf"\| {label} \| wall \| [^|]+ \| [^|]+ \| ([0-9.]+) \|", readings)
        assert row
        assert float(row[1]) == pytest.approx(celsius, abs=0.02)
    assert readings.count("| valid |") == 2
    assert "| 1 | wall |" not in potentials
    assert "| 3 | wall |" in potentials
    assert "2 of 2 readings of the instrument “thermometer” are valid." in section(page, "summary")
    assert re.search(r"Point 1: 17\.(59|60|61) degrees\.", section(page, "temperatures"))
    marks = scene(page)
    assert len(marks["valid readings"]) == 1
    first, second = marks["valid readings of thermometer"]
    assert re.fullmatch(r"1<br>temperature 17\.[0-9]+ °C", first)
    assert second.startswith("2<br>")
    assert "invalid readings" not in marks


def handed_out(flown: Path) -> None:
    """Every export has name, value and unit, and whether the reading is valid."""
    with (flown / "readings.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["instrument"] for row in rows] == ["thermometer", "thermometer", ""]
    assert [row["temperature_unit"] for row in rows] == ["°C", "°C", ""]
    assert [row["valid"] for row in rows] == ["true"] * 3
    assert float(rows[1]["temperature"]) == pytest.approx(17.4, abs=0.02)
    features = json.loads((flown / "readings.geojson").read_text(encoding="utf-8"))["features"]
    first, _, potential = (feature["properties"] for feature in features)
    assert first["temperature"] == pytest.approx(17.6, abs=0.02)
    assert (first["temperature_unit"], first["valid"]) == ("°C", True)
    assert potential["temperature"] is None
    model = ifcopenshell.open(str(flown / "readings.ifc"))
    sets = [
        ifcopenshell.util.element.get_psets(proxy)
        for proxy in model.by_type("IfcBuildingElementProxy")
    ]
    assert [list(found) for found in sets] == [
        ["InstrumentReading"],
        ["InstrumentReading"],
        ["HalfCellPotential"],
    ]
    held = sets[0]["InstrumentReading"]
    assert held["temperature"] == pytest.approx(17.6, abs=0.02)
    assert (held["temperature unit"], held["Valid"]) == ("°C", True)


def without_half_cell(flown: Path) -> None:
    """The half-cell has no chapter, no marks and no potentials where it read nothing."""
    page = (flown / "report.html").read_text(encoding="utf-8")
    assert not section(page, "survey")
    assert "Half-cell readings" not in section(page, "flight")
    assert set(scene(page)) == {"valid readings of thermometer"}
    handed = json.loads((flown / "readings.geojson").read_text(encoding="utf-8"))
    assert "potential_reference" not in handed
    assert "potential_mv" not in handed["features"][0]["properties"]
