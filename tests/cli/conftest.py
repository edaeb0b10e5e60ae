"""The command line as a user's shell sees it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli.commands.init import init

Shell = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    """A campaign folder as ``inspect init`` makes it."""
    return init(tmp_path / "campaign").folder


@pytest.fixture
def shell(tmp_path: Path) -> Shell:
    """Runs ``python -m inspect_cli`` in an empty folder."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()

    def run(*arguments: str | Path, **variables: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "inspect_cli", *map(str, arguments)],
            capture_output=True,
            text=True,
            timeout=120,
            cwd=folder,
            env={**os.environ, **variables},
            check=False,
        )

    return run
