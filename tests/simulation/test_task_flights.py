"""Whole flights of tasks of every kind: a pose, a square, a tank that is followed, two profiles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from modes import Mode
from scenarios import Array, Flown
from worlds import PLATFORM

from inspect_cli.commands.fly import fly
from inspect_cli.log.reader import read_log
from inspect_cli.schema.loading import load_platform

pytestmark = pytest.mark.xdist_group("flights")

BOARD = """\
structure:
  - name: board
    surface: {shape: {kind: plane, center_m: [1.6, 0, 1.3], normal: [-1, 0, 0], size_m: [1.6, 1]}}
"""
SIDE_M, PRESS_M = 0.3, 0.10


@dataclass(frozen=True)
class Work:
    """A short mission of its own."""

    name: str
    text: str
    platform: str = "tilt_rotor_hexarotor"

    def fly(self, campaign: Path) -> Flown:
        file = campaign / "missions" / f"{self.name}.yaml"
        head = f"schema: 1\nname: {self.name}\nplatform: {self.platform}\n"
        file.write_text(head + self.text)
        outcome = fly(file, seed=1, out=campaign / "reports" / self.name)
        return Flown(outcome, read_log(outcome.folder / "flight.mcap"))


HELD = Work(
    "held",
    "tasks:\n  - hold: {position_m: [0.3, 0.2, 1.3], heading_deg: 40, duration_s: 4}\n"
    "    impedance: rope_pull_3\n",
)
SQUARE = Work(
    "square",
    f"{BOARD}impedance: push_and_slide\ntasks:\n"
    "  - trace: {on: board, polyline_m: [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3], [0, 0]],\n"
    "            at_m: [-0.15, -0.15], repeat: 2, settle_s: 1}\n"
    "truth: {structure: {board: {friction: 0.3}}}\n",
)
TANK = Work(
    "tank",
    """\
start: {takeoff_height_m: 1.2}
tasks:
  - servo: {start: {position_m: [0, 0, 1.8]}, direction: "-x", slide_m: 0.4, speed_mps: 0.17}
    impedance: depth_servoing
truth:
  structure:
    tank:
      geometry: {kind: cylinder, center_m: [0, 0, 0.8], axis: [0, 1, 0], radius_m: 2.2,
                 facing: [0.5, 0, 0.866], size_m: [4, 3], side: inside}
      friction: 0.2
""",
    "tilt_rotor_hexarotor_30",
)
PROFILES = Work(
    "profiles",
    f"{BOARD}tasks:\n"
    "  - contact_points: {on: board, at_m: [[1.6, 0.1, 1.3]], dwell_s: 4}\n    sensor: none\n"
    "  - contact_points: {on: board, at_m: [[1.6, -0.1, 1.3]], dwell_s: 4}\n    sensor: none\n"
    "    impedance: force_evaluation_2\n",
)
ALL = [HELD, SQUARE, TANK, PROFILES]
Worked = Callable[[Work], Flown]


@pytest.fixture(scope="session")
def worked(campaign: Path) -> Worked:
    """Fly, or hand out the flight that another test asked for already."""
    flights: dict[str, Flown] = {}

    def once(work: Work) -> Flown:
        if work.name not in flights:
            flights[work.name] = work.fly(campaign)
        return flights[work.name]

    return once


def rows(flight: Flown, mode: Mode, target: int) -> Array:
    """Which rows belong to a mode at a target."""
    reference = flight.log.channels["/reference"]
    found: Array = (reference["mode"] == float(mode)) & (reference["target"] == float(target))
    assert found.any()
    return found


@pytest.mark.parametrize("work", ALL, ids=lambda work: work.name)
def test_it_lands_where_it_started_and_touches_with_the_tip_alone(
    worked: Worked, work: Work
) -> None:
    flight = worked(work)
    assert flight.outcome.result.status == "completed"
    assert flight.outcome.result.points == ()
    assert flight.state["f_body"].max() == 0.0
    # It may slide on its gear while its motors run down.
    np.testing.assert_allclose(flight.state["p_WB"][-1], flight.state["p_WB"][0], atol=0.05)
    assert int(flight.mode[-1]) == Mode.LANDED


def test_the_pose_is_held_for_its_time(worked: Worked) -> None:
    flight = worked(HELD)
    held = flight.state[rows(flight, Mode.HOLD, 0)]
    assert held["t_s"][-1] - held["t_s"][0] == pytest.approx(4.0, abs=0.1)
    np.testing.assert_allclose(held["p_WB"], np.tile([0.3, 0.2, 1.3], (len(held), 1)), atol=0.03)
    yaw = 2.0 * np.arctan2(held["q_WB"][:, 3], held["q_WB"][:, 0])
    np.testing.assert_allclose(np.degrees(yaw), 40.0, atol=2.0)


@pytest.mark.parametrize("trial", [0, 1])
def test_the_square_is_drawn_in_contact(worked: Worked, trial: int) -> None:
    """The tip stays on the board, and within 2 cm of the line: friction holds it back by
    μ F / (m̃ k) = 0.3 · 1.8 N / (5 · 72 N/m) = 1.5 mm.
    """
    flight = worked(SQUARE)
    slide = flight.state[rows(flight, Mode.SLIDE, trial)]
    assert (slide["f_normal"] > 0.3).all()
    np.testing.assert_allclose(slide["p_WT"][:, 0], 1.6, atol=0.03)
    middle = slide["p_WT"][:, 1:3] - [0.0, 1.3]
    off = np.abs(np.abs(middle).max(axis=1) - 0.5 * SIDE_M)
    assert off.max() < 0.02
    corners = 0.5 * SIDE_M * np.array([[-1, -1], [-1, 1], [1, 1], [1, -1]])
    nearest = np.linalg.norm(middle[:, None] - corners[None], axis=2).min(axis=0)
    assert nearest.max() < 0.02
    assert np.median(slide["f_normal"]) == pytest.approx(1.8, rel=0.25)


def test_both_trials_are_alike(worked: Worked) -> None:
    flight = worked(SQUARE)
    first, second = (flight.state[rows(flight, Mode.SLIDE, k)]["p_WT"] for k in (0, 1))
    # They end alike; before the line each begins where its own press was corrected to.
    assert abs(len(first) - len(second)) < 0.5 * 100  # rows at 100 Hz
    n = min(len(first), len(second))
    assert np.linalg.norm(first[-n:] - second[-n:], axis=1).max() < 0.015


def test_the_tank_is_followed(worked: Worked) -> None:
    flight = worked(TANK)
    slide = flight.state[rows(flight, Mode.SLIDE, 0)]
    from_axis = slide["p_WT"][:, [0, 2]] - [0.0, 0.8]
    # Gaps: the tip may leave for a moment where noise turns the reference, but not for long.
    assert np.mean(slide["f_normal"] > 0.1) > 0.95
    angle = np.unwrap(np.arctan2(from_axis[:, 1], from_axis[:, 0]))
    assert abs(angle[-1] - angle[0]) * 2.2 == pytest.approx(0.4, abs=0.06)
    np.testing.assert_allclose(np.linalg.norm(from_axis, axis=1), 2.2, atol=0.03)
    retreat = flight.state[rows(flight, Mode.RETREAT, 0)]
    end = retreat["p_WT"][-1][[0, 2]] - [0.0, 0.8]
    assert 2.2 - np.linalg.norm(end) == pytest.approx(0.25, abs=0.05)


def test_each_contact_is_pressed_with_its_profile(worked: Worked) -> None:
    """The apparent mass along the tool times the stiffness along x_B times 0.10 m."""
    flight = worked(PROFILES)
    profiles = list(flight.log.channels["/reference"]["impedance"][rows(flight, Mode.PRESS, 1)])
    assert len(set(profiles)) == 1
    control = load_platform(PLATFORM).control
    forces = []
    for target, name in enumerate(("contact_ndt", "force_evaluation_2")):
        profile = control.profiles[name]
        stiffness = profile.stiffness_npm or control.stiffness_npm
        forces.append(profile.mass[2] * stiffness[0] * PRESS_M)
        pressed = flight.state[rows(flight, Mode.PRESS, target)]["f_normal"]
        assert np.median(pressed[-50:]) == pytest.approx(forces[-1], rel=0.1)
    assert forces[1] > 1.5 * forces[0]
    # The blend lies in free air: no jump of the commanded wrench there beyond the flight's own.
    wrench = flight.log.channels["/command"]["wrench_B"]
    way = rows(flight, Mode.TRANSIT, 1)
    steps = np.linalg.norm(np.diff(wrench[way][:, :3], axis=0), axis=1)
    assert steps.max() < 3.0
