"""The page in a real browser: every figure is drawn, nothing foreign runs."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from example_flights import Flight, spoil
from experiment_flights import drawing, force_evaluation, hold, servoing
from report_pages import Reported

from inspect_cli.records import Estimate, InvalidReason, State

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-logging=stderr",
    "--virtual-time-budget=20000",
    "--dump-dom",
)
EVIL = "</script><script>document.documentElement.dataset.pwned='1'</script><img src=x onerror=x>"


@pytest.fixture(scope="module")
def chromium() -> str:
    found = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
    path = next((p for p in found if p), None)
    if path is None:
        pytest.skip("needs headless Chromium (chromium, chromium-browser or google-chrome)")
    return path


def drawn(chromium: str, page: Path, profile: Path) -> tuple[dict[str, str], str, list[str]]:
    """(data attributes of the root element, document after drawing, errors on the console)."""
    run = subprocess.run(
        [chromium, *FLAGS, f"--user-data-dir={profile}", page.as_uri()],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    root = re.search(r"<html[^>]*>", run.stdout)
    assert root, run.stderr[-2000:]
    said = [line for line in run.stderr.splitlines() if ":CONSOLE:" in line]
    errors = [line for line in said if re.search("Uncaught|Error|Refused|Violat|violat", line)]
    return dict(re.findall(r'data-(\w+)="([^"]*)"', root[0])), run.stdout, errors


@pytest.mark.browser
def test_every_figure_is_drawn_and_nothing_foreign_runs(
    chromium: str, fly: Fly, report: Report, tmp_path: Path
) -> None:
    words = {"title": EVIL, "description": EVIL, "label": EVIL, "event": EVIL}
    flight = fly(2, 3, words=words)
    spoil(flight, 1, InvalidReason.FORCE)
    reported = report(flight)
    root, document, errors = drawn(chromium, reported.path, tmp_path / "profile")
    assert root.get("drawn") == "true"
    assert root["figures"] == str(len(reported.page.figures)) == "14"
    assert root["failures"] == "0"
    assert "pwned" not in root
    assert "<img src" not in document
    assert not errors
    assert document.count('class="main-svg"') >= 14


@pytest.mark.browser
@pytest.mark.parametrize("build", [drawing, servoing, hold, force_evaluation])
def test_every_figure_of_an_experiment_is_drawn(
    chromium: str,
    report: Report,
    platform_file: Path,
    tmp_path: Path,
    build: Callable[[Path], Flight],
) -> None:
    reported = report(build(platform_file))
    root, _, errors = drawn(chromium, reported.path, tmp_path / "profile")
    assert root["figures"] == str(len(reported.page.figures))
    assert root["failures"] == "0"
    assert not errors


@pytest.mark.browser
def test_a_spoiled_flight_is_drawn_too(
    chromium: str, fly: Fly, report: Report, tmp_path: Path
) -> None:
    flight = fly(1, 2)
    for k in range(2):
        spoil(flight, k, InvalidReason.OPEN_CIRCUIT)
    flight.rows(State)["p_WB"][900:] = 1e200
    flight.rows(Estimate)["q_WB"][900:] = np.nan
    flight.status = "diverged"
    reported = report(flight)
    root, _, errors = drawn(chromium, reported.path, tmp_path / "profile")
    assert root.get("drawn") == "true"
    assert root["figures"] == str(len(reported.page.figures))
    assert root["failures"] == "0"
    assert not errors
