"""A task and a sensor that are added to a copy of the package by following CONTRIBUTING's recipes.

The recipe says which files there are. What is written into each of them stands here: a file of
its own, or an import and a row. Nothing else of the copy is touched.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

Row = tuple[str, str, str]
"""The words after which a registry's rows stand; an import; a row."""

NOD: dict[str, str | Row] = {
    "schema/tasks/nod.py": '''\
from typing import Annotated
from pydantic import Field
from inspect_cli.schema.tasks.base import Place, TaskKind, Work

class Nod(Work):
    """Stays at a place for a while, several times."""

    at_m: Place
    times: Annotated[int, Field(ge=1)]

KIND = TaskKind(Nod, modes=frozenset({"hold"}))
''',
    "planning/tasks/nod.py": """\
from inspect_cli.planning.tasks.hold import HoldPlanner
from inspect_cli.planning.tasks.situation import Planners
from inspect_cli.schema.tasks.hold import Hold

def planners_of(asked):
    nod = asked.task.work
    hold = Hold(position_m=nod.at_m, duration_s=0.2)
    labels = [str(asked.number + k) for k in range(nod.times)]
    planners = tuple(HoldPlanner(label, hold, asked.impedance) for label in labels)
    return Planners(planners, asked.tip_W)
""",
    "schema/tasks/__init__.py": (
        '"inspect_cli.tasks",\n    {\n',
        "from inspect_cli.schema.tasks import nod\n",
        '        "nod": nod.KIND,\n',
    ),
    "planning/tasks/__init__.py": (
        '"inspect_cli.task_planners",\n    {\n',
        "from inspect_cli.planning.tasks import nod\n",
        '        "nod": nod.planners_of,\n',
    ),
}
ALTIMETER: dict[str, str | Row] = {
    "schema/vehicle/sensors/altimeter.py": '''\
from typing import Literal
from inspect_cli.schema.vehicle.sensors.base import SensorModel

class AltimeterModel(SensorModel):
    """Height over a level."""

    kind: Literal["altimeter"]
    level_m: float
''',
    "sensing/altimeter.py": '''\
from inspect_cli.records import Record, scalar

class Altitude(Record):
    """One height."""

    topic = "/sensor/altimeter"
    height = scalar("m", "height of the body over the level")

class Altimeter:
    def __init__(self, model):
        self.measurement = Altitude.create()
        self._level_m = model.level_m

    def sample(self, truth):
        self.measurement.t_s = truth.state.t_s
        self.measurement.height = truth.state.p_WB[2] - self._level_m
        return self.measurement

def altimeter(model, around):
    return Altimeter(model)
''',
    "schema/vehicle/sensors/__init__.py": (
        '"inspect_cli.sensors",\n    {\n',
        "from inspect_cli.schema.vehicle.sensors.altimeter import AltimeterModel\n",
        '        "altimeter": AltimeterModel,\n',
    ),
    "sensing/sensors.py": (
        '"inspect_cli.simulated_sensors",\n    {\n',
        "from inspect_cli.sensing.altimeter import altimeter\n",
        '        "altimeter": altimeter,\n',
    ),
}
PLATFORM = """\
schema: 1
extends: tilt_rotor_hexarotor.yaml
name: with_altimeter
sensors: {altitude: {kind: altimeter, rate_hz: 20, level_m: 0.5}}
"""
MISSION = """\
schema: 1
name: nodding
platform: with_altimeter
start: {takeoff_height_m: 0.5}
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [3, 0, 1], normal: [-1, 0, 0], size_m: [1, 1]}}
tasks:
  - nod: {at_m: [0.0, 0.0, 0.5], times: 2}
"""
FLOWN = """
import json, sys
from pathlib import Path
import inspect_cli
from inspect_cli.commands.fly import fly
from inspect_cli.commands.plan import plan
from inspect_cli.log.reader import read_log
from inspect_cli.records import State
from inspect_cli.schema.json_schema import schema_text
from inspect_cli.sensing.altimeter import Altitude

flown = fly(plan(Path("missions/nodding.yaml")).file)
log = read_log(flown.folder / "flight.mcap")
rows, state = log.rows(Altitude), log.rows(State)
true_z = dict(zip(state["t_s"].tolist(), state["p_WB"][:, 2].tolist()))
print(json.dumps({
    "package": str(Path(inspect_cli.__file__).parent),
    "in_schemas": ["nod" in schema_text("mission"), "altimeter" in schema_text("platform")],
    "status": flown.result.status,
    "held": [leg.target for leg in log.plan().legs if leg.kind == "hold"],
    "rate_hz": (len(rows) - 1) / float(rows["t_s"][-1] - rows["t_s"][0]),
    "level_m": [true_z[t] - h for t, h in zip(rows["t_s"].tolist(), rows["height"].tolist())],
}))
"""


def recipe(root: Path, name: str) -> str:
    """The words of a recipe, up to what concerns packages outside."""
    text = (root / "CONTRIBUTING.md").read_text(encoding="utf-8")
    [found] = re.findall(rf"^- \*\*{name}\*\*(.*?)(?=^- \*\*|^## )", text, re.MULTILINE | re.DOTALL)
    return str(found.partition("From another package")[0])


def named_files(root: Path, name: str, kind: str) -> set[str]:
    """The modules that a recipe names, for a new kind."""
    paths = re.findall(r"`([\w/<>]+\.py)`", recipe(root, name))
    return {path.replace("<kind>", kind) for path in paths}


def follow(package: Path, changes: dict[str, str | Row]) -> None:
    """Write the new files, and the new rows into files that are there."""
    for name, change in changes.items():
        file = package / name
        if isinstance(change, str):
            assert not file.exists()
            file.write_text(change)
            continue
        before_rows, imported, row = change
        text = file.read_text()
        assert text.count(before_rows) == 1
        text = text.replace(before_rows, before_rows + row)
        future = "from __future__ import annotations\n"
        file.write_text(text.replace(future, future + imported, 1))


@pytest.mark.parametrize(("name", "kind"), [("A task", "nod"), ("A sensor", "altimeter")])
def test_a_recipe_names_one_file_and_one_row_per_floor(root: Path, name: str, kind: str) -> None:
    changes = NOD if kind == "nod" else ALTIMETER
    assert named_files(root, name, kind) == set(changes)


def test_what_follows_the_recipes_is_planned_and_flown(root: Path, tmp_path: Path) -> None:
    package = tmp_path / "inspect_cli"
    shutil.copytree(root / "inspect_cli", package)  # with the times and machine code of its files
    shutil.copytree(root / "platforms", tmp_path / "platforms")
    follow(package, NOD)
    follow(package, ALTIMETER)
    (tmp_path / "missions").mkdir()
    (tmp_path / "missions" / "nodding.yaml").write_text(MISSION)
    (tmp_path / "platforms" / "with_altimeter.yaml").write_text(PLATFORM)
    done = subprocess.run(
        [sys.executable, "-c", FLOWN],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    seen = json.loads(done.stdout)
    assert seen["package"] == str(package)
    assert seen["in_schemas"] == [True, True]
    assert seen["status"] == "completed"
    assert seen["held"] == [0, 1]
    assert seen["rate_hz"] == pytest.approx(20.0, rel=1e-6)
    assert len(seen["level_m"]) > 20
    assert seen["level_m"] == pytest.approx([0.5] * len(seen["level_m"]), abs=1e-9)
