"""Campaigns with vehicles of kinds that only these tests know."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from canted_octorotor import CantedOctorotor, CantedOctorotorPlatform
from packages import HERE, install, run

from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.vehicle import PLATFORM_KINDS
from inspect_cli.vehicles import VEHICLES

KIND = "canted_octorotor"


@pytest.fixture(scope="module")
def mission(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The mission of a campaign of its own; the kind is known as long as the tests run."""
    folder = tmp_path_factory.mktemp("campaign")
    shutil.copytree(HERE / "campaign", folder, dirs_exist_ok=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(PLATFORM_KINDS, KIND, CantedOctorotorPlatform)
        patch.setitem(VEHICLES, KIND, CantedOctorotor)
        yield folder / "missions" / "leaning_walls.yaml"


@pytest.fixture(scope="module")
def vehicle(mission: Path) -> CantedOctorotor:
    """The vehicle of the mission."""
    return CantedOctorotor(load_mission(mission).platform)


@pytest.fixture
def crawler_campaign(tmp_path: Path) -> Path:
    """A campaign with the missions of both crawlers, to write others into."""
    return Path(shutil.copytree(HERE / "crawler_campaign", tmp_path / "campaign"))


@pytest.fixture(scope="session")
def crawlers(tmp_path_factory: pytest.TempPathFactory) -> SimpleNamespace:
    """The missions of both crawlers, flown by two workers: what ``regress`` says, and the runs."""
    folder = tmp_path_factory.mktemp("crawlers")
    site, campaign = folder / "site", folder / "campaign"
    install(site, "pitching_crawler", "stiff_crawler")
    shutil.copytree(HERE / "crawler_campaign", campaign)
    said = run(site, campaign, "regress", "--jobs", "2", "--update", "--out", "runs", "--json")
    pitching = campaign / "runs" / "lean-and-prop" / "pitching_crawler-seed1"
    stiff = campaign / "runs" / "stiff-lean" / "stiff_crawler-seed1"
    run(site, campaign, "report", str(pitching), "--no-pictures")
    return SimpleNamespace(regression=json.loads(said), pitching=pitching, stiff=stiff)
