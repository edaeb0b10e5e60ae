"""Every file of the checkout that a contract is about becomes a test of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Give ``mission_file`` and ``platform_file`` to the tests that ask for them."""
    for fixture, folder in {"mission_file": "missions", "platform_file": "platforms"}.items():
        if fixture in metafunc.fixturenames:
            files = sorted((ROOT / folder).rglob("*.yaml"))
            metafunc.parametrize(fixture, files, ids=[file.stem for file in files])
