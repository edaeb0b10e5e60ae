"""``inspect doctor``: is this installation able to do its work, and if not, what mends it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, requires, version
from typing import Literal

DISTRIBUTION = "inspect-cli"
PYTHON = (3, 11)
TIMEOUT_S = 120.0

Verdict = Literal["ok", "warning", "failed"]


@dataclass(frozen=True)
class Finding:
    """One thing that was examined."""

    what: str
    verdict: Verdict
    found: str
    hint: str = ""
    """How to mend it; empty when it is good."""


@dataclass(frozen=True)
class Diagnosis:
    """Everything that was examined."""

    findings: tuple[Finding, ...]

    @property
    def healthy(self) -> bool:
        """Whether missions can be planned, flown and reported; warnings do not prevent it."""
        return all(finding.verdict != "failed" for finding in self.findings)

    def as_json(self) -> dict[str, object]:
        """The diagnosis as plain data."""
        return {"healthy": self.healthy, "findings": [asdict(f) for f in self.findings]}


@dataclass(frozen=True)
class Trial:
    """A probe, what its failing means, and how to mend that."""

    what: str
    failing: Verdict
    hint: str


REINSTALL = f"install again: python -m pip install --force-reinstall {DISTRIBUTION}"

TRIALS: dict[str, Trial] = {
    "kernels": Trial(
        "compiled kernels",
        "failed",
        "set NUMBA_CACHE_DIR to a folder that can be written, or install again",
    ),
    "physics": Trial("physics", "failed", REINSTALL),
    "rendering": Trial(
        "headless rendering",
        "warning",
        "only pictures need it: install a driver for EGL (Debian: libegl1), set MUJOCO_GL=egl",
    ),
    "clouds": Trial(
        "point clouds",
        "failed",
        "open3d needs libusb, which the package libusb-package brings; " + REINSTALL,
    ),
    "logs": Trial("logs", "failed", REINSTALL),
}


def doctor() -> Diagnosis:
    """Examine Python, the libraries, and each probe in a process of its own."""
    return Diagnosis((_python(), _libraries(), *(_tried(name) for name in TRIALS)))


def _python() -> Finding:
    found = ".".join(map(str, sys.version_info[:3]))
    if sys.version_info >= PYTHON:
        return Finding("Python", "ok", found)
    needed = ".".join(map(str, PYTHON))
    return Finding("Python", "failed", found, f"make a virtual environment of Python {needed}")


def _libraries() -> Finding:
    try:
        requirements = requires(DISTRIBUTION) or []
    except PackageNotFoundError:
        return Finding("libraries", "failed", f"{DISTRIBUTION} is not installed", REINSTALL)
    wrong = list(_wrong_versions(requirements))
    if wrong:
        return Finding("libraries", "failed", "; ".join(wrong), REINSTALL)
    return Finding("libraries", "ok", f"{DISTRIBUTION} {version(DISTRIBUTION)} with what it needs")


def _wrong_versions(requirements: list[str]) -> Iterator[str]:
    for requirement in requirements:
        match = re.match(r"([\w.-]+)(?:\[[^]]*\])?\s*(?:>=\s*([\d.]+))?", requirement)
        if match is None or "extra ==" in requirement:
            continue
        name, least = match.groups()
        try:
            found = version(name)
        except PackageNotFoundError:
            yield f"{name} is missing"
            continue
        if least and _release(found) < _release(least):
            yield f"{name} {found} is older than {least}"


def _release(text: str) -> tuple[int, ...]:
    """The leading numbers of a version."""
    match = re.match(r"\d+(?:\.\d+)*", text)
    return tuple(int(part) for part in match[0].split(".")) if match else ()


def _tried(name: str) -> Finding:
    trial = TRIALS[name]
    command = [sys.executable, "-m", "inspect_cli.commands.probes", name]
    environment = dict(os.environ)
    if sys.platform == "linux":
        environment.setdefault("MUJOCO_GL", "egl")
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=TIMEOUT_S, env=environment, check=False
        )
    except subprocess.TimeoutExpired:
        return Finding(trial.what, trial.failing, f"no answer in {TIMEOUT_S:.0f} s", trial.hint)
    if done.returncode == 0:
        return Finding(trial.what, "ok", done.stdout.strip())
    said = done.stderr.strip().splitlines()
    found = said[-1] if said else f"the process ended with {done.returncode}"
    return Finding(trial.what, trial.failing, found, trial.hint)
