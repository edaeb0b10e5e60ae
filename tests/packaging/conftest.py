"""The wheel of the checkout, and an environment outside it where nothing but the wheel is ours."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

PACKED = ("inspect_cli", "missions", "platforms", "pyproject.toml", "README.md", "LICENSE")
BUILDER = 77
"""The least version of setuptools that ``pyproject.toml`` asks for."""


@pytest.fixture(scope="session")
def wheel(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built from a copy so that nothing is left behind in the checkout."""
    source = tmp_path_factory.mktemp("source")
    litter = shutil.ignore_patterns("__pycache__", "*.egg-info")
    for name in PACKED:
        if (root / name).is_dir():
            shutil.copytree(root / name, source / name, ignore=litter)
        else:
            shutil.copy(root / name, source)
    command = [sys.executable, "-m", "build", "--wheel", "--outdir", "dist", "."]
    if _builder_is_here():
        command.append("--no-isolation")  # works without a network
    done = subprocess.run(command, cwd=source, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    [built] = (source / "dist").glob("*.whl")
    return built


def _builder_is_here() -> bool:
    try:
        return int(version("setuptools").partition(".")[0]) >= BUILDER
    except PackageNotFoundError:
        return False


@dataclass(frozen=True)
class Installation:
    """A clean environment and a folder to work in."""

    python: Path
    folder: Path

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run ``inspect`` as a user would."""
        environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "NUMBA"))}
        command = [str(self.python.with_name("inspect")), *arguments]
        return subprocess.run(
            command, cwd=self.folder, env=environment, capture_output=True, text=True
        )


@pytest.fixture(scope="session")
def installation(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Installation:
    """The wheel in an environment of its own; its dependencies are those of the tests."""
    folder = tmp_path_factory.mktemp("elsewhere")
    venv.create(folder / "env", symlinks=True)
    python = folder / "env" / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--no-deps"]
    subprocess.run([*pip, "--no-index", "--quiet", str(wheel)], check=True)
    # Afterwards, so that pip never sees the checkout's own installation among the dependencies.
    [site_packages] = (folder / "env" / "lib").glob("python*/site-packages")
    (site_packages / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return Installation(python, folder)
