"""A campaign folder whose flights are not flown."""

from __future__ import annotations

from pathlib import Path

import pytest
from fake_flights import Campaign


@pytest.fixture
def campaign(tmp_path: Path) -> Campaign:
    return Campaign(tmp_path / "campaign")
