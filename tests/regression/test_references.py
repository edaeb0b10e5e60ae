"""References on disk: what is written, when, and that they are never half-written."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from fake_flights import USUAL, Campaign, fly

from inspect_cli.commands.regress import regress
from inspect_cli.errors import EnvironmentFault
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.regression.compare import BY_METRIC, BY_UNIT, tolerance_of

KILLED_WHILE_WRITING = """
import os, signal, sys
from pathlib import Path
from inspect_cli.regression.reference import ReferenceMetrics, write_reference
os.fsync = lambda descriptor: os.kill(os.getpid(), signal.SIGKILL)
reference = ReferenceMetrics(mission="wall", platform="p", seed=1, status="completed", metrics={})
write_reference(Path(sys.argv[1]), reference)
"""


def update(campaign: Campaign, *paths: Path) -> tuple[Path, ...]:
    outcome = regress(paths, campaign=campaign.root, fly=fly, update=True, environment={})
    return outcome.updated


def test_reference_is_small_sorted_and_stable(campaign: Campaign) -> None:
    campaign.mission("wall")
    campaign.tell("wall", metrics={"tracking.position_rmse_x_m": 0.012345678912345})
    assert update(campaign) == (campaign.reference("wall"),)
    text = campaign.reference("wall").read_text()
    data = json.loads(text)
    assert text == json.dumps(data, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    assert data == {
        "schema": 1,
        "mission": "wall",
        "platform": "tilt_rotor_hexarotor",
        "seed": 1,
        "status": "completed",
        "metrics": USUAL | {"tracking.position_rmse_x_m": 0.0123456789},
    }
    update(campaign)
    assert campaign.reference("wall").read_text() == text


def test_only_what_was_flown_is_rewritten(campaign: Campaign) -> None:
    one = campaign.mission("one")
    campaign.mission("two")
    update(campaign)
    before = campaign.reference("two").stat().st_mtime_ns
    for name in ("one", "two"):
        campaign.tell(name, metrics={"contact.points_valid": 7.0})
    assert update(campaign, one) == (campaign.reference("one"),)
    assert json.loads(campaign.reference("one").read_text())["metrics"]["contact.points_valid"] == 7
    assert campaign.reference("two").stat().st_mtime_ns == before


def test_a_failing_write_leaves_the_old_file(
    campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    campaign.mission("wall")
    update(campaign)
    before = campaign.reference("wall").read_bytes()
    campaign.tell("wall", metrics={"contact.points_valid": 7.0})

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(EnvironmentFault, match="No space left"):
        update(campaign)
    assert campaign.reference("wall").read_bytes() == before
    assert [file.name for file in campaign.reference("wall").parent.iterdir()] == [
        campaign.reference("wall").name
    ]


def test_a_kill_in_the_middle_leaves_the_old_file(campaign: Campaign) -> None:
    campaign.mission("wall")
    update(campaign)
    path = campaign.reference("wall")
    before = path.read_bytes()
    killed = subprocess.run([sys.executable, "-c", KILLED_WHILE_WRITING, str(path)], check=False)
    assert killed.returncode == -signal.SIGKILL
    assert path.read_bytes() == before


def test_tolerance_of_every_metric_is_stated() -> None:
    assert BY_METRIC.keys() <= METRICS.keys()
    for name, spec in METRICS.items():
        assert name in BY_METRIC or spec.unit in BY_UNIT, name


def test_counts_may_not_move_and_shares_may() -> None:
    assert tolerance_of("contact.points_valid", "1").around(9.0) == 0.0
    assert tolerance_of("flight.saturated_share", "1").around(0.5) == pytest.approx(0.052)
    assert tolerance_of("unheard.of", "furlong").around(1.0) == 0.0
