"""Flights that several tests look at: each scenario is flown once per run of the tests."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from scenarios import Flown, Scenario

Fly = Callable[[Scenario], Flown]


@pytest.fixture(scope="session")
def campaign(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign folder with the built-in missions and platforms, to add missions to."""
    folder = tmp_path_factory.mktemp("campaign")
    for name in ("missions", "platforms"):
        shutil.copytree(root / name, folder / name)
    return folder


@pytest.fixture(scope="session")
def flown(campaign: Path) -> Fly:
    """Fly a scenario, or hand out the flight that another test asked for already."""
    flights: dict[Scenario, Flown] = {}

    def once(scenario: Scenario) -> Flown:
        if scenario not in flights:
            flights[scenario] = scenario.fly(campaign)
        return flights[scenario]

    return once
