"""Whole flights: faults end them safely, truth does not leak, the same seed repeats."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from modes import Mode
from scenarios import ONE_POINT, Array, Flown, Scenario

from inspect_cli.errors import InputError
from inspect_cli.records import Record, State
from inspect_cli.simulation.mounts import Mount
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.recorder import Recorder
from inspect_cli.truth.contact import ContactTruth
from inspect_cli.vehicles.fully_actuated.impedance_control import ImpedanceControl
from inspect_cli.vehicles.fully_actuated.stack import FullyActuatedStack

Fly = Callable[[Scenario], Flown]
pytestmark = pytest.mark.xdist_group("flights")

SHORT = Scenario("short")
WALL_X = 2.0


def test_a_short_flight_reads_both_points_and_lands(flown: Fly) -> None:
    flight = flown(SHORT)
    assert flight.outcome.result.status == "completed"
    assert flight.reasons == ["", ""]
    order = [Mode(int(m)) for m in flight.mode[np.diff(flight.mode, prepend=-1.0) != 0]]
    point = [Mode.TRANSIT, Mode.APPROACH, Mode.PRESS, Mode.RETREAT]
    home = [Mode.TRANSIT, Mode.LAND, Mode.LANDED]
    assert order == [Mode.IDLE, Mode.TAKEOFF, *point, *point, *home]
    start, end = flight.state[0], flight.state[-1]
    np.testing.assert_allclose(end["p_WB"], start["p_WB"], atol=0.01)
    assert np.linalg.norm(end["v_WB_W"]) < 1e-3


def test_the_force_is_there_only_while_pressing(flown: Fly) -> None:
    flight = flown(SHORT)
    touching = flight.state["f_normal"] > 0.1
    near = np.isin(flight.mode, [float(Mode.PRESS), float(Mode.RETREAT)])
    assert not touching[~near].any()
    assert flight.during(Mode.PRESS)["f_normal"].max() > 1.5
    # The retreat leaves the wall at once.
    for end in np.flatnonzero(np.diff((flight.mode == float(Mode.RETREAT)).astype(int)) == -1):
        assert flight.state["f_normal"][end] == 0.0
    assert flight.state["f_body"].max() == 0.0


def test_the_logged_truth_is_consistent_with_itself(flown: Fly) -> None:
    """Positions are the integral of velocities, velocities of accelerations; in free flight."""
    state = flown(SHORT).state
    dt = np.diff(state["t_s"])[:, None]
    assert np.ptp(dt) < 1e-9
    flying = (flown(SHORT).mode == float(Mode.TRANSIT))[1:]
    mean_v = 0.5 * (state["v_WB_W"][1:] + state["v_WB_W"][:-1])
    np.testing.assert_allclose((np.diff(state["p_WB"], axis=0) / dt - mean_v)[flying], 0, atol=2e-3)


ABORTED = "the flight was aborted"


def fault(flown: Fly, sensor: str, kind: str, mode: Mode) -> tuple[Flown, float]:
    """The short flight with a sensor that fails 0.6 s into a mode, and when that is."""
    short = flown(SHORT)
    begun = float(short.state["t_s"][np.argmax(short.mode == float(mode))])
    start_s = round(begun + 0.6, 3)
    truth = f"faults: [{{sensor: {sensor}, fault: {kind}, start_s: {start_s}}}]\n"
    flight = flown(Scenario(f"{sensor}-{kind}-{mode.name.lower()}", truth))
    return flight, start_s


def assert_safe_hover(flight: Flown, drift_m: float) -> None:
    """At rest for the last three seconds, in the air, with no blow on the body ever."""
    assert flight.outcome.result.status == "aborted"
    assert not flight.outcome.result.passed
    assert set(flight.reasons) == {ABORTED}
    assert flight.state["f_body"].max() == 0.0
    assert flight.mode[-1] == float(Mode.HOVER)
    hover = flight.state[flight.state["t_s"] > flight.state["t_s"][-1] - 3.0]
    assert np.ptp(hover["p_WB"], axis=0).max() < drift_m
    assert hover["p_WB"][:, 2].min() > 0.5
    speed = np.linalg.norm(hover["v_WB_W"][-100:], axis=1)
    assert speed.max() < 0.05


@pytest.mark.parametrize(
    ("kind", "mode"), [("off", Mode.TRANSIT), ("nan", Mode.APPROACH), ("nan", Mode.PRESS)]
)
def test_a_blind_camera_ends_in_a_hover_at_the_standoff(flown: Fly, kind: str, mode: Mode) -> None:
    flight, start_s = fault(flown, "tof", kind, mode)
    assert_safe_hover(flight, 0.02)
    assert "surface not seen" in flight.outcome.result.status_reason
    # Nobody needs the camera before the approach. Then half a second without a surface and a
    # second and a half of patience.
    needed_s = flight.state["t_s"][np.argmax(flight.mode == float(Mode.APPROACH))]
    assert 1.4 < flight.abort_s() - max(start_s, needed_s) < 2.2
    assert WALL_X - flight.state["p_WT"][-1][0] == pytest.approx(0.25, abs=0.02)
    assert flight.state["f_normal"][-300:].max() == 0.0


@pytest.mark.parametrize(("kind", "mode"), [("off", Mode.TRANSIT), ("nan", Mode.APPROACH)])
def test_a_lost_tracker_ends_in_a_hover(flown: Fly, kind: str, mode: Mode) -> None:
    flight, start_s = fault(flown, "pose", kind, mode)
    assert_safe_hover(flight, 0.10)  # three seconds on inertial sensors alone
    assert "pose" in flight.outcome.result.status_reason
    assert 0.25 < flight.abort_s() - start_s < 0.35
    assert flight.state["f_normal"].max() == 0.0


@pytest.mark.parametrize("kind", ["off", "nan"])
def test_without_a_first_pose_it_does_not_take_off(flown: Fly, kind: str) -> None:
    flight = flown(Scenario(f"no-pose-{kind}", f"faults: [{{sensor: pose, fault: {kind}}}]\n"))
    assert flight.outcome.result.status == "aborted"
    assert "no pose" in flight.outcome.result.status_reason
    assert flight.outcome.ending.flight_s == 0.0
    assert not any(point.valid for point in flight.outcome.result.points)


@pytest.mark.parametrize("kind", ["off", "nan"])
def test_a_broken_probe_gives_no_reading(flown: Fly, kind: str) -> None:
    """The flight goes on: touching is the impedance's business, not the probe's."""
    truth = f"faults: [{{sensor: probe, fault: {kind}}}]\n"
    flight = flown(Scenario(f"probe-{kind}", truth, ONE_POINT))
    assert flight.outcome.result.status == "completed"
    assert flight.state["f_normal"].max() > 1.5  # it did press
    [point] = flight.outcome.result.points
    assert not point.valid
    assert point.reason
    assert point.potential_mv is None
    assert point.corrosion is None


def test_pulled_away_from_the_wall_no_point_counts(flown: Fly) -> None:
    """A constant 3 N against a press of 1.8 N: each point is invalid for its force."""
    pull = "disturbances: [{kind: constant, frame: world, force_n: [-3, 0, 0], start_s: 4}]\n"
    flight = flown(Scenario("pulled", pull))
    assert flight.outcome.result.status == "completed"
    assert len(flight.reasons) == 2
    for point in flight.outcome.result.points:
        assert not point.valid
        assert point.reason.startswith("force")
        assert point.potential_mv is None
    assert flight.state["f_body"].max() == 0.0


def test_a_missing_wall_is_given_up_in_a_safe_hover(flown: Fly) -> None:
    flight = flown(Scenario("no-wall", "structure: {wall: {absent: true}}\n"))
    assert_safe_hover(flight, 0.02)
    assert flight.state["p_WT"][:, 0].max() < WALL_X - 0.2  # it never went in blindly


def bytes_of(flight: Flown) -> tuple[bytes, bytes]:
    folder = flight.outcome.folder
    return (folder / "flight.mcap").read_bytes(), (folder / "metrics.json").read_bytes()


def test_two_processes_write_the_same_bytes(flown: Fly, campaign: Path) -> None:
    here = flown(SHORT)
    out = campaign / "reports" / "elsewhere"
    code = (
        "import sys; from pathlib import Path; from inspect_cli.commands.fly import fly;"
        "fly(Path(sys.argv[1]), seed=1, out=Path(sys.argv[2]))"
    )
    mission = campaign / "missions" / f"{SHORT.name}.yaml"
    subprocess.run([sys.executable, "-c", code, str(mission), str(out)], check=True, timeout=120)
    log, metrics = bytes_of(here)
    assert (out / "metrics.json").read_bytes() == metrics
    assert (out / "flight.mcap").read_bytes() == log


def test_another_seed_is_another_noise_with_the_same_verdicts(flown: Fly) -> None:
    one, two = flown(SHORT), flown(Scenario("short", seed=2))
    for topic in ("/sensor/imu", "/sensor/probe", "/estimate"):
        a, b = one.log.channels[topic], two.log.channels[topic]
        rows = min(len(a), len(b))
        assert (a[:rows] != b[:rows]).mean() > 0.99, topic
    verdicts = [
        [(point.valid, point.reason, point.astm_class, point.corrosion) for point in f.points]
        for f in (one.outcome.result, two.outcome.result)
    ]
    assert verdicts[0] == verdicts[1]
    numbers = [
        [point.potential_mv for point in flight.outcome.result.points] for flight in (one, two)
    ]
    assert numbers[0] != numbers[1]
    assert numbers[0] == pytest.approx(numbers[1], abs=10.0)


class Poison:
    """Keeps the true records, and hands out NaN in their place to whoever is no sensor."""

    def __init__(self) -> None:
        self.hidden: dict[int, tuple[Array, Array]] = {}
        """The numbers that everybody sees, and those that are so."""
        self.controls = 0
        self.seeing = False

    def spoil(self, record: Record) -> None:
        numbers = record.array.view(np.float64)
        self.hidden[id(record)] = (numbers, numbers.copy())
        numbers[:] = np.nan

    def antidote(self, function: Callable[..., object]) -> Callable[..., object]:
        """The function, which sees the truth as long as it runs."""

        def with_truth(*arguments: object) -> object:
            if self.seeing:  # called by another that sees it
                return function(*arguments)
            self.seeing = True
            for numbers, truth in self.hidden.values():
                numbers[:] = truth
            result = function(*arguments)
            for numbers, truth in self.hidden.values():
                truth[:] = numbers
                numbers[:] = np.nan
            self.seeing = False
            return result

        return with_truth


def test_poisoned_truth_changes_nothing_downstream_of_the_sensors(
    flown: Fly, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """State and contact are NaN but for sensors and log; the log is the same, to the byte."""
    clean = bytes_of(flown(SHORT))
    poison, observe, update = Poison(), Plant.observe, ContactTruth.update
    control, step, mount = ImpedanceControl.prepare, Plant.step, Mount.__init__

    def observe_and_spoil(plant: Plant, t_s: float) -> State:
        state = observe(plant, t_s)
        poison.spoil(state)
        return state

    def step_and_spoil(plant: Plant, steps: int) -> None:
        step(plant, steps)
        poison.spoil(plant.state)

    def see_while_sampling(self: Mount, *arguments: object) -> None:
        mount(self, *arguments)
        self.sample = poison.antidote(self.sample)

    def update_and_spoil(truth: ContactTruth, state: State) -> Record:
        contact = poison.antidote(update)(truth, state)
        assert isinstance(contact, Record)
        if id(contact) not in poison.hidden and not poison.seeing:
            poison.spoil(contact)
        return contact

    def control_without_truth(*arguments: object) -> bool:
        # State, and from the first row of the log on TrueContact
        assert len(poison.hidden) == (2 if poison.controls else 1)
        assert all(np.isnan(numbers).all() for numbers, _ in poison.hidden.values())
        poison.controls += 1
        return control(*arguments)

    monkeypatch.setattr(Mount, "__init__", see_while_sampling)
    monkeypatch.setattr(Recorder, "rows", poison.antidote(Recorder.rows))
    monkeypatch.setattr(Plant, "observe", observe_and_spoil)
    monkeypatch.setattr(Plant, "step", step_and_spoil)
    monkeypatch.setattr(ContactTruth, "update", update_and_spoil)
    monkeypatch.setattr(ImpedanceControl, "prepare", control_without_truth)
    poisoned = SHORT.fly(campaign, "poisoned")
    assert poison.controls > 10_000
    assert bytes_of(poisoned) == clean


def test_a_calomel_electrode_in_warm_concrete_comes_back_to_the_standards_scale(
    campaign: Path,
) -> None:
    """It shows 75 mV more, the evaluation takes that off, and the truth is held on one scale.

    A reading of 1 mV noise is within 5 mV of the specimen (its rule: 5 mV over a second).
    """
    (campaign / "platforms" / "calomel.yaml").write_text(
        "schema: 1\nextends: tilt_rotor_hexarotor.yaml\nname: calomel\nkind: tilt_rotor\n"
        "sensors: {probe: {electrode: SCE}}\n"
    )
    warm = """
        structure:
          wall: {specimen: {temperature_c: 35, spots: []}}
    """
    known = (
        "structure:\n"
        "  - {name: wall, temperature_c: 35, surface: {fit: plane, cloud: scans/wall.ply}}\n"
    )
    tasks = f"platform: calomel\n{known}{ONE_POINT}"
    flight = Scenario("calomel", warm, tasks).fly(campaign)
    rows = flight.log.channels["/reading"]
    result = flight.outcome.result
    sound_mv = -120.0 + 0.9 * (35.0 - 22.2)  # the analytic specimen's −120 mV of a CSE at 35 °C
    for point, row in zip(result.points, rows, strict=True):
        assert point.read_mv == pytest.approx(1e3 * row["potential"])
        assert point.potential_mv == pytest.approx(point.read_mv - 75.0)
        assert point.true_potential_mv == pytest.approx(sound_mv, abs=1e-6)
        assert point.potential_mv == pytest.approx(sound_mv, abs=5.0)
    assert result.value("half_cell.potential_error_max_v") < 0.005
    (wall,) = result.assessment
    assert (wall.basis.electrode, wall.basis.temperature_c) == ("SCE", 35.0)


def test_a_camera_may_be_called_as_a_loop_is(campaign: Path) -> None:
    """It keeps its own rate: an estimate of the surface every 100 ms."""
    text = (campaign / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()
    text = text.replace("name: tilt_rotor_hexarotor\n", "name: named\n")
    (campaign / "platforms" / "named.yaml").write_text(text.replace("\n  tof:\n", "\n  control:\n"))
    named = Scenario("named", tasks=f"platform: named\n{ONE_POINT}").fly(campaign)
    times = named.log.channels["/guidance/surface"]["t_s"]
    assert len(times) > 100
    np.testing.assert_allclose(np.diff(times), 0.1, atol=1e-9)


def test_a_stack_that_answers_with_no_record_is_refused(
    campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With its answer: the flight would end for a reason that misleads."""
    monkeypatch.setattr(FullyActuatedStack, "hear", lambda stack, sample: "pose")
    with pytest.raises(InputError, match=r"FullyActuatedStack\.hear returned 'pose'"):
        Scenario("nonsense", tasks=ONE_POINT).fly(campaign)
