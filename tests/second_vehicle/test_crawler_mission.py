"""A vehicle of an installed package that leans to push: on a wall, along it, under a ceiling."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
import pytest
from crawler_models import crawler
from packages import install, refusals
from pitching_crawler.file_model import FOOT
from pitching_crawler.modes import MODES
from pitching_crawler.sensors import ContactForce, Encoders
from scipy.spatial.transform import Rotation

from inspect_cli.interfaces import ForceLaw
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.flight import nearest
from inspect_cli.records import Command, Reference, State
from inspect_cli.vehicles import tilt_rotor
from inspect_cli.vehicles.actuators import Drive, Rotor
from inspect_cli.vehicles.contacts import wrench_record

pytestmark = pytest.mark.xdist_group("crawlers")  # the flights of both

MASS, G = 2.3, 9.81
PUSH_N, PROP_N = 2.0, 3.0
CEILING_Z, FRICTION = 3.0, 0.7
HELD = slice(-300, None)
"""The last three seconds, 100 rows each."""
WALL_TARGET, CEILING_TARGET = 0, 1


@pytest.fixture(scope="module")
def flight(crawlers):
    """The run's folder, its log, and the rows of a record while in a mode."""
    folder = crawlers.pitching
    log = read_log(folder / "flight.mcap")
    reference, table = log.rows(Reference), log.modes()
    names = np.array([table.by_number[int(number)].name for number in reference["mode"]])

    def rows(kind, mode):
        logged = log.rows(kind)
        return logged[names[nearest(reference["t_s"], logged["t_s"])] == mode]

    return SimpleNamespace(folder=folder, log=log, rows=rows, vehicle=crawler())


def pitch_of(q_WB):
    return Rotation.from_quat(np.roll(q_WB, -1, axis=-1)).as_euler("zyx")[..., 1]


def test_the_mission_is_completed_and_accepted(flight):
    metrics = json.loads((flight.folder / "metrics.json").read_text())
    assert (metrics["platform"], metrics["status"]) == ("pitching_crawler", "completed")
    assert {check["verdict"] for check in metrics["checks"]} == {"pass"}
    assert metrics["points"] == []


def test_targets_have_a_law_of_force_and_the_legs_are_called_by_its_modes(flight):
    plan = flight.log.plan()
    assert [(t.kind, t.law) for t in plan.targets] == [
        ("contact", ForceLaw(PUSH_N)),
        ("perch", ForceLaw(PROP_N)),
    ]
    own = [leg.kind for leg in plan.legs if leg.kind in MODES]
    assert own == [
        "nearing", "leaning", "crawling", "leaving", "nearing", "propping", "leaving",
    ]  # fmt: skip
    assert plan.impedance is None
    table = {row.name: row.number for row in flight.log.modes().modes}
    assert table == {mode.name: mode.number for mode in MODES.values()}
    assert not set(MODES) & set(tilt_rotor.TiltRotor.behaviour.modes)


def test_it_presses_the_wall_with_two_newtons_for_three_seconds(flight):
    force = -flight.rows(State, "leaning")["f_tool_W"][HELD, 0]
    assert len(force) == 300
    assert force.mean() == pytest.approx(PUSH_N, rel=0.1)
    assert force.min() > 0.5 * PUSH_N


def test_it_leans_as_statics_say(flight):
    """m g tan θ is the force on the wall, and posture and arm are the planned ones."""
    rows = flight.rows(State, "leaning")[HELD]
    planned = flight.log.plan().targets[WALL_TARGET].contact
    pitch = pitch_of(rows["q_WB"]).mean()
    assert MASS * G * np.tan(pitch) == pytest.approx(PUSH_N, rel=0.1)
    assert pitch == pytest.approx(pitch_of(np.array(planned.q_WB)), rel=0.1)
    hinge = rows["joint_angle"][:, 0].mean()
    assert hinge == pytest.approx(planned.arm_angle_rad[0], abs=np.radians(1.0))
    assert rows["p_WB"][-1, 2] == pytest.approx(planned.p_WB[2], abs=0.03)


def test_the_hinge_is_measured_and_never_commanded(flight):
    vehicle = flight.vehicle
    assert vehicle.joints == ("hinge", "wheel")
    commanded = [a.joint for a in vehicle.actuators if not isinstance(a, Rotor)]
    assert commanded == ["wheel"]
    assert flight.log.rows(Command)["joint_angle"].shape[1] == 0
    # It moves by itself, and its encoder follows to half a step.
    true, encoders = flight.log.rows(State), flight.log.rows(Encoders)
    assert np.ptp(flight.rows(State, "crawling")["joint_angle"][:, 0]) > np.radians(0.5)
    at = nearest(encoders["t_s"], true["t_s"])
    together = np.abs(encoders["t_s"][at] - true["t_s"]) < 1e-9
    assert together.sum() > 1000
    error = encoders["angle"][at][together] - true["joint_angle"][together]
    assert np.abs(error).max() <= 0.5 * 0.001534 + 1e-12


def test_the_wheel_rolls_a_metre_along_the_wall(flight):
    rows = flight.rows(State, "crawling")
    climbed = np.ptp(rows["p_WT"][:, 2])
    assert climbed == pytest.approx(1.0, abs=0.01)
    [drive] = [a for a in flight.vehicle.actuators if isinstance(a, Drive)]
    assert drive.joint == "wheel"
    radius_m = flight.vehicle.platform.wheel.radius_m
    rolled = radius_m * (rows["joint_angle"][-1, 1] - rows["joint_angle"][0, 1])
    assert rolled == pytest.approx(climbed, rel=1e-3)
    speed = radius_m * flight.rows(Command, "crawling")["drive_speed"][:, 0]
    assert speed.max() == pytest.approx(0.25)
    wheel = flight.rows(wrench_record("wheel"), "crawling")["f_W"]
    assert (-wheel[:, 0]).min() > 0.5 * PUSH_N  # it never lost the wall
    assert (np.hypot(wheel[:, 1], wheel[:, 2]) < -FRICTION * wheel[:, 0]).all()
    np.testing.assert_array_equal(wheel, rows["f_tool_W"])
    assert not flight.log.rows(State)["f_body"].any()


def test_the_foot_is_pressed_under_the_ceiling_and_its_wrench_is_logged(flight):
    true = flight.rows(wrench_record(FOOT), "propping")[HELD]
    measured = flight.rows(ContactForce, "propping")[HELD]
    np.testing.assert_allclose(measured["t_s"], true["t_s"], atol=1e-9)
    assert -true["f_W"][:, 2].mean() == pytest.approx(PROP_N, rel=0.1)
    # Under the ceiling the vehicle is level, so that z_B is z_W.
    noise = (measured["f_B"] - true["f_W"])[:, 2].std()
    assert noise == pytest.approx(0.02, rel=0.15)
    p_WB = flight.rows(State, "propping")["p_WB"][-1]
    assert p_WB[2] + flight.vehicle.platform.foot.height_m == pytest.approx(CEILING_Z, abs=1e-3)


def test_what_its_flight_does_not_have_is_not_measured(flight):
    metrics = json.loads((flight.folder / "metrics.json").read_text())["metrics"]
    assert metrics["contact.force_mean_n"]["value"] == pytest.approx(PUSH_N, rel=0.1)
    for name in (
        "half_cell.potential_min_v",
        "guidance.normal_error_mean_deg",
        "estimation.wrench_force_rmse_n",
        "flight.energy_wh_flown",
        "slide.distance_m",
        "drawing.tracking_rms_m",
        "scoring.region_area_m2",
    ):
        assert metrics[name]["value"] is None
        assert metrics[name]["why"]


def test_its_report_says_what_was_flown_and_no_more(flight):
    page = (flight.folder / "report.html").read_text(encoding="utf-8")
    assert "PROPPING" in page
    assert "Surface seen by the depth camera" not in page
    assert "contact_ndt" not in page
    assert "Wrench on a contact" in page  # the package's own chapter
    assert "The wrench sensor measured up to" in page


def edited(campaign, name, old, new):
    """Another mission: the campaign's with some words exchanged."""
    text = (campaign / "missions" / "lean_and_prop.yaml").read_text()
    assert old in text
    path = campaign / "missions" / f"{name}.yaml"
    path.write_text(text.replace(old, new).replace("lean-and-prop", name))
    return path


def place_of(path, words):
    """Line and column, counted from 1, at which the words stand in a file."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if words in line:
            return f"missions/{path.name}:{number}:{line.index(words) + 1}"
    raise AssertionError(words)


def test_what_a_vehicle_cannot_do_is_refused_with_who_can_and_with_what_it_lacks(
    crawler_campaign, tmp_path
):
    install(tmp_path / "site", "pitching_crawler")
    prop = "prop: {on: ceiling, at_m: [0.0, 0.0], force_n: 3.0, dwell_s: 3, standoff_m: 0.1}"
    touch = "contact_points: {on: ceiling, at_m: [[0, 0, 3]]}\n    sensor: none"
    touching = edited(crawler_campaign, "touching", prop, touch)
    swap = ("platform: pitching_crawler", "platform: tilt_rotor_hexarotor")
    tilting = edited(crawler_campaign, "tilting", *swap)
    heavy = edited(crawler_campaign, "heavy", "force_n: 2.0", "force_n: 80.0")
    others_task, own_task, push = refusals(
        tmp_path / "site", crawler_campaign, touching, tilting, heavy
    )

    assert place_of(touching, "{on: ceiling") in others_task
    assert "pitching_crawler cannot do the task 'contact_points'" in others_task
    assert "it can do: lean, prop; platforms that can: tilt_rotor_hexarotor" in others_task

    assert place_of(tilting, "{on: wall") in own_task
    assert "tilt_rotor_hexarotor cannot do the task 'lean'" in own_task
    assert "platforms that can: pitching_crawler" in own_task

    lack_n = np.hypot(80.0, MASS * G) - 6 * 12.0
    assert f"it needs {lack_n:.2f} N more thrust" in push
