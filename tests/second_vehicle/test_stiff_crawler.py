"""A second kind that builds on the crawler's package, with modes of its own, is flown as well."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
import pytest
from packages import install, refusals
from pitching_crawler.sensors import ContactForce
from scipy.spatial.transform import Rotation
from stiff_crawler.vehicle import STIFF_MODES

from inspect_cli.log.reader import read_log
from inspect_cli.records import Reference, State

pytestmark = pytest.mark.xdist_group("crawlers")  # the flights of both

MASS, G, PUSH_N, WHEEL_M = 2.3, 9.81, 3.0, 0.06


@pytest.fixture(scope="module")
def flight(crawlers):
    """The result of a run, its log, and the states in a mode."""
    folder = crawlers.stiff
    log = read_log(folder / "flight.mcap")
    state, modes = log.rows(State), log.rows(Reference)["mode"]
    result = json.loads((folder / "metrics.json").read_text())
    by_mode = {name: state[modes == mode.number] for name, mode in STIFF_MODES.items()}
    return SimpleNamespace(result=result, log=log, by_mode=by_mode)


def test_it_is_completed_by_its_own_modes(flight):
    assert (flight.result["platform"], flight.result["status"]) == ("stiff_crawler", "completed")
    assert {check["verdict"] for check in flight.result["checks"]} == {"pass"}
    table = {row.name: row.number for row in flight.log.modes().modes}
    assert table == {name: mode.number for name, mode in STIFF_MODES.items()}
    assert len(flight.by_mode["rising"]) > 0
    assert len(flight.by_mode["cruising"]) > 0


def test_eight_rotors_push_and_it_leans_as_statics_say(flight):
    held = flight.by_mode["leaning"][-200:]
    assert held["rotor_thrust"].shape == (200, 8)
    pitch = Rotation.from_quat(np.roll(held["q_WB"], -1, axis=1)).as_euler("zyx")[:, 1]
    assert MASS * G * np.tan(pitch.mean()) == pytest.approx(PUSH_N, rel=0.1)


def test_the_larger_wheel_rolls_as_far_as_it_climbs(flight):
    rows = flight.by_mode["crawling"]
    climbed = np.ptp(rows["p_WT"][:, 2])
    assert climbed == pytest.approx(0.5, abs=0.01)
    angle = rows["joint_angle"][:, 1]
    assert WHEEL_M * (angle[-1] - angle[0]) == pytest.approx(climbed, rel=2e-3)


def test_the_wrench_sensor_sits_under_the_wheel(flight):
    measured = flight.log.rows(ContactForce)["f_B"]
    force = np.linalg.norm(flight.log.rows(State)["f_tool_W"], axis=1)
    assert np.linalg.norm(measured, axis=1).max() == pytest.approx(force.max(), abs=0.1)


def test_without_a_mode_for_it_propping_is_refused(crawler_campaign, tmp_path):
    install(tmp_path / "site", "pitching_crawler", "stiff_crawler")
    text = (crawler_campaign / "missions" / "lean_and_prop.yaml").read_text()
    path = crawler_campaign / "missions" / "stiff_prop.yaml"
    path.write_text(text.replace("platform: pitching_crawler", "platform: stiff_crawler"))
    [message] = refusals(tmp_path / "site", crawler_campaign, path)
    assert "stiff_crawler cannot do the task 'prop'" in message
    assert "it can do: lean; platforms that can: pitching_crawler" in message
