"""Whether this machine renders without a screen; tests that look at images need it."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest


@pytest.fixture(scope="session")
def renderer() -> None:
    """Skips, saying so, where there is no driver."""
    done = subprocess.run(
        [sys.executable, "-m", "inspect_cli.commands.probes", "rendering"],
        capture_output=True,
        text=True,
        timeout=120,
        env={"MUJOCO_GL": "egl", **os.environ},
        check=False,
    )
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or ["no word of why"]
        pytest.skip(f"needs headless rendering, a driver for EGL (libegl1): {said[-1]}")
