"""A campaign with a vehicle of a kind that only these tests know."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from canted_octorotor import CantedOctorotor, CantedOctorotorPlatform

from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.vehicle import PLATFORM_KINDS
from inspect_cli.vehicles import VEHICLES

KIND = "canted_octorotor"


@pytest.fixture(scope="module")
def mission(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The mission of a campaign of its own; the kind is known as long as the tests run."""
    folder = tmp_path_factory.mktemp("campaign")
    shutil.copytree(Path(__file__).parent / "campaign", folder, dirs_exist_ok=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(PLATFORM_KINDS, KIND, CantedOctorotorPlatform)
        patch.setitem(VEHICLES, KIND, CantedOctorotor)
        yield folder / "missions" / "leaning_walls.yaml"


@pytest.fixture(scope="module")
def vehicle(mission: Path) -> CantedOctorotor:
    """The vehicle of the mission."""
    return CantedOctorotor(load_mission(mission).platform)
