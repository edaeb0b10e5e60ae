"""One finished log for all tests that only read it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import pytest
from logbook import write_flight

from inspect_cli.records import Record


class Written(NamedTuple):
    path: Path
    rows: dict[type[Record], Any]


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Written:
    path = tmp_path_factory.mktemp("log") / "flight.mcap"
    return Written(path, write_flight(path, root))
