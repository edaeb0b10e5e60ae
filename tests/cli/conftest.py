"""The command line as a user's shell sees it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli.commands.init import init

COLOURING = ("FORCE_COLOR", "NO_COLOR", "TTY_COMPATIBLE", "GITHUB_ACTIONS")
"""Variables that ask for colours or forbid them."""

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
    inherited = {k: v for k, v in os.environ.items() if k not in COLOURING}

    def run(*arguments: str | Path, **variables: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "inspect_cli", *map(str, arguments)],
            capture_output=True,
            text=True,
            timeout=120,
            cwd=folder,
            env={**inherited, **variables},
            check=False,
        )

    return run
