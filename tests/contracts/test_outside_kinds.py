"""A sensor, a disturbance and a specimen of an installed package, by the recipes of CONTRIBUTING.

They are flown in a process of its own, in which the package is installed from the start.
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
    "barometer_model": '''
from typing import Literal
from inspect_cli.schema.base import NonNegative
from inspect_cli.schema.vehicle.sensors.base import SensorModel

class BarometerModel(SensorModel):
    """Height by air pressure."""

    kind: Literal["barometer"]
    noise_m: NonNegative
''',
    "barometer_sensor": '''
from inspect_cli.records import Record, scalar

class Height(Record):
    """One height."""

    topic = "/sensor/barometer"
    height = scalar("m", "height of the body over the ground")

class Barometer:
    def __init__(self, model, rng):
        self.measurement = Height.create()
        self._model, self._rng = model, rng

    def sample(self, truth):
        self.measurement.t_s = truth.state.t_s
        noise = self._model.noise_m * self._rng.standard_normal()
        self.measurement.height = truth.state.p_WB[2] + noise
        return self.measurement

def barometer(model, around):
    return Barometer(model, around.rng)
''',
    "updraught_model": '''
from typing import Literal
from inspect_cli.schema.disturbances.base import DisturbanceModel

class Updraught(DisturbanceModel):
    """A steady force upwards."""

    kind: Literal["updraught"]
    force_n: float
''',
    "updraught_load": """
class UpdraughtLoad:
    def __init__(self, force_n):
        self._force_n = force_n

    def act(self, t_s, motion, load):
        load.force_W[2] += self._force_n

def updraught(entry, around):
    return UpdraughtLoad(entry.force_n)
""",
    "slope_model": '''
from typing import Literal
from inspect_cli.schema.specimens.base import SpecimenModel

class SlopeSpecimen(SpecimenModel):
    """A potential that falls along u."""

    model: Literal["slope"]
    slope_vpm: float
''',
    "slope_field": """
import numpy as np

class SlopeField:
    def __init__(self, model):
        self._model = model
        self.temperature_c = model.temperature_c

    def at(self, u, v):
        return -0.2 + self._model.slope_vpm * u, 100.0

    def active(self, uv_m):
        return np.zeros(len(uv_m), np.bool_)

def slope_field(model, root, patch):
    return SlopeField(model)
""",
}
ENTRY_POINTS = """
[inspect_cli.sensors]
barometer = barometer_model:BarometerModel
[inspect_cli.simulated_sensors]
barometer = barometer_sensor:barometer
[inspect_cli.disturbances]
updraught = updraught_model:Updraught
[inspect_cli.loads]
updraught = updraught_load:updraught
[inspect_cli.specimens]
slope = slope_model:SlopeSpecimen
[inspect_cli.specimen_fields]
slope = slope_field:slope_field
"""
PLATFORM = """\
schema: 1
extends: tilt_rotor_hexarotor.yaml
name: with_barometer
sensors: {barometer: {kind: barometer, rate_hz: 20, noise_m: 0.0}}
"""
MISSION = """\
schema: 1
name: outside
platform: with_barometer
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [2.0, 0.0, 1.2], normal: [-1, 0, 0], size_m: [2, 2]}}
tasks:
  - contact_points: {on: wall, at_m: [[2.0, -0.1, 1.2]], press_m: 0.1}
truth:
  structure: {wall: {specimen: {model: slope, slope_vpm: -0.5}}}
  disturbances: [{kind: updraught, force_n: 2.0}]
  faults: [{sensor: barometer, fault: nan, start_s: 2.0, end_s: 3.0}]
"""
READ_BACK = """
import json, sys
from pathlib import Path
import numpy as np
from barometer_sensor import Height
from inspect_cli.log.reader import read_log
from inspect_cli.records import Estimate, State
log = read_log(Path(sys.argv[1]))
rows, state, estimate = log.rows(Height), log.rows(State), log.rows(Estimate)
at = np.searchsorted(state["t_s"], rows["t_s"])
print(json.dumps({
    "rate_hz": (len(rows) - 1) / float(rows["t_s"][-1] - rows["t_s"][0]),
    "lost_s": [float(t) for t in rows["t_s"][np.isnan(rows["height"])]],
    "error_m": float(np.nanmax(np.abs(rows["height"] - state["p_WB"][at, 2]))),
    "up_n": float(np.median(state["wrench_ext_B"][state["p_WB"][:, 2] > 0.6, 2])),
    "specimen": log.truth().structure["wall"].specimen.model,
}))
"""


@pytest.fixture
def campaign_from_outside(tmp_path: Path) -> Path:
    site, campaign = tmp_path / "site", tmp_path / "campaign"
    metadata = site / "outside-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: outside\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS)
    for name, text in MODULES.items():
        (site / f"{name}.py").write_text(text)
    for name in ("missions", "platforms"):
        (campaign / name).mkdir(parents=True)
    (campaign / "platforms" / "with_barometer.yaml").write_text(PLATFORM)
    base = builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml"
    (campaign / "platforms" / base.name).write_text(base.read_text(encoding="utf-8"))
    (campaign / "missions" / "outside.yaml").write_text(MISSION)
    return tmp_path


def python(folder: Path, *arguments: str) -> str:
    env = os.environ | {"PYTHONPATH": str(folder / "site")}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder / "campaign",
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_kinds_of_an_installed_package_fly(campaign_from_outside: Path) -> None:
    folder = campaign_from_outside
    run = folder / "run"
    python(folder, "-m", "inspect_cli", "fly", "missions/outside.yaml", "--out", str(run))
    seen = json.loads(python(folder, "-c", READ_BACK, str(run / "flight.mcap")))
    assert seen["rate_hz"] == pytest.approx(20.0, rel=1e-6)
    assert seen["lost_s"] == pytest.approx([2.0 + 0.05 * k for k in range(20)])
    assert seen["error_m"] < 1e-9
    assert seen["up_n"] == pytest.approx(2.0, abs=0.2)
    assert seen["specimen"] == "slope"
    (point,) = json.loads((run / "metrics.json").read_text())["points"]
    assert point["valid"]
    # −0.2 V − 0.5 V/m · 0.1 m, and what a placement error of 5 mm and noise make of it.
    assert point["potential_mv"] == pytest.approx(-250.0, abs=6.0)


def test_without_the_package_its_kinds_are_refused(campaign_from_outside: Path) -> None:
    folder = campaign_from_outside
    for file in (folder / "site").glob("*/entry_points.txt"):
        file.unlink()
    with pytest.raises(AssertionError, match="no such kind: barometer"):
        python(folder, "-m", "inspect_cli", "plan", "missions/outside.yaml")
