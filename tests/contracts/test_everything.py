"""For every platform a mission with one of everything, and one with nothing but defaults, flown.

``everything/`` holds the missions. A test walks the models behind them and names each kind and each
option that no mission there states, so that a newcomer cannot be left out.
"""

from __future__ import annotations

import shutil
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import BaseModel

from inspect_cli.commands.fly import FlyOutcome, fly
from inspect_cli.schema.base import Strict
from inspect_cli.schema.disturbances import DISTURBANCES
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.mission import MissionFile
from inspect_cli.schema.specimens import SPECIMENS
from inspect_cli.schema.strict_yaml import read_yaml
from inspect_cli.schema.tasks import TASK_KINDS
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.schema.vehicle.sensors import SENSORS

HERE = Path(__file__).parent / "everything"
PLATFORMS = sorted((Path(__file__).parents[2] / "platforms").glob("*.yaml"))
FILES = ("everything.yaml", "survey.yaml")
STEEP_DEG = 120.0
"""A tool that points further upwards works under a soffit."""

Given = dict[type[BaseModel], set[str]]


def models_in(value: object) -> Iterator[BaseModel]:
    """The models in a value, itself included."""
    if isinstance(value, BaseModel):
        yield value
        for name in type(value).model_fields:
            yield from models_in(getattr(value, name))
    elif isinstance(value, dict):
        for entry in value.values():
            yield from models_in(entry)
    elif isinstance(value, tuple | list):
        for entry in value:
            yield from models_in(entry)


def given() -> Given:
    """By model, the keys that the missions state."""
    found: Given = defaultdict(set)
    for file in FILES:
        mission = MissionFile.model_validate(read_yaml(HERE / file).plain)
        for model in models_in(mission):
            found[type(model)] |= model.model_fields_set
    found[MissionFile].add("extends")  # by everything_overhead.yaml
    return found


def test_the_missions_state_every_kind_and_every_option() -> None:
    found = given()
    kinds = [*(kind.model for kind in TASK_KINDS.values()), *DISTURBANCES.values()]
    missing = {kind.__name__ for kind in (*kinds, *SPECIMENS.values())} - {
        model.__name__ for model in found
    }
    assert not missing, f"no mission in {HERE.name}/ has: {', '.join(sorted(missing))}"
    for model, keys in found.items():
        if issubclass(model, Strict):
            left_out = set(model.model_fields) - keys
            assert not left_out, f"no mission in {HERE.name}/ gives {model.__name__} {left_out}"


def test_the_shipped_platforms_have_every_sensor() -> None:
    carried = {s.kind for file in PLATFORMS for s in load_platform(file).sensors.values()}
    assert carried == set(SENSORS)


@pytest.fixture(scope="module")
def campaign(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign with these missions and the shipped platforms and scans."""
    folder = tmp_path_factory.mktemp("everything")
    shutil.copytree(HERE, folder / "missions")
    shutil.copytree(root / "missions" / "scans", folder / "missions" / "scans")
    shutil.copytree(root / "platforms", folder / "platforms")
    return folder


def flown(campaign: Path, name: str, platform: Path) -> FlyOutcome:
    """Plan and fly one of the missions with a platform."""
    model = load_platform(platform)
    assert isinstance(model, TiltRotorPlatform)
    overhead = campaign / "missions" / f"{name}_overhead.yaml"
    steep = model.tool.pitch_deg > STEEP_DEG and overhead.exists()
    mission = overhead if steep else campaign / "missions" / f"{name}.yaml"
    return fly(mission, platform=Path(platform.stem), out=campaign / name / platform.stem)


@pytest.mark.parametrize("platform", PLATFORMS, ids=lambda file: file.stem)
@pytest.mark.parametrize(("name", "points"), [("everything", 2), ("survey", 2), ("defaults", 1)])
def test_it_is_planned_and_flown(campaign: Path, name: str, points: int, platform: Path) -> None:
    outcome = flown(campaign, name, platform)
    assert outcome.result.status == "completed"
    read = [point for point in outcome.result.points if point.valid]
    assert len(read) >= (points if name != "defaults" else 0)
    assert outcome.result.metrics["contact.body_force_max_n"].value == 0.0
    assert (outcome.folder / "metrics.json").exists()
