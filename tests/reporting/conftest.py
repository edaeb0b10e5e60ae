"""Reports of plausible flights."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from example_flights import Flight, survey
from playwright.sync_api import Browser, sync_playwright
from report_pages import Page, Reported

from inspect_cli.commands.delivery import Wanted, deliver
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.reporting.documents.flight import report_document


@pytest.fixture
def report(tmp_path: Path) -> Callable[[Flight], Reported]:
    """Evaluates a flight and writes its report."""

    def write(flight: Flight) -> Reported:
        log = flight.log()
        evaluation = evaluate_with_arrays(log)
        result = evaluation.result
        document = report_document(log, result, log.plan(), with_maps(evaluation.assessed))
        path = deliver(tmp_path, document, Wanted())
        return Reported(flight, result, path, Page(path.read_text(encoding="utf-8")))

    return write


@pytest.fixture(scope="session")
def platform_file(root: Path) -> Path:
    """The platform whose numbers the example flights carry."""
    return root / "platforms" / "tilt_rotor_hexarotor.yaml"


@pytest.fixture
def fly(platform_file: Path) -> Callable[..., Flight]:
    """``survey`` with the built-in platform."""

    def build(*args: Any, **options: Any) -> Flight:
        return survey(platform_file, *args, **options)

    return build


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    """One headless Chromium for all tests that need one."""
    found = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
    path = next((p for p in found if p), None)
    if path is None:
        pytest.skip("needs headless Chromium (chromium, chromium-browser or google-chrome)")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield browser
        browser.close()
