"""Flights through executors: a cluster's, this machine's, and those that break."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import pytest
from fake_cluster import FakeCluster
from fake_flights import Campaign, fly

from inspect_cli.commands.fly import fly_loaded
from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.commands.regress import RegressOutcome, regress
from inspect_cli.errors import Location
from inspect_cli.regression.executors import local_executors
from inspect_cli.regression.flights import FlightEnd, FlightTask, fly_all
from inspect_cli.schema.loading import load_mission, place_in_mission

SHORT = """\
schema: 1
name: short
platform: tilt_rotor_hexarotor
seeds: [3]
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [1.2, 0, 1.1], normal: [-1, 0, 0], size_m: [2, 2]}}
tasks: [{contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.1, dwell_s: 4}}]
"""


def tasks(campaign: Campaign, *names: str) -> list[FlightTask]:
    return [FlightTask(load_mission(campaign.mission(name)), seed=1) for name in names]


def test_a_cluster_takes_the_place_of_this_machine(campaign: Campaign) -> None:
    for name in ("a", "b", "c"):
        campaign.mission(name, seeds=[1, 2])
    campaign.tell("b", **{"raise": "boom"})
    here = regress([], campaign=campaign.root, fly=fly, update=True, environment={})
    opened: list[FakeCluster] = []

    def open_cluster(flights: int) -> FakeCluster:
        opened.append(FakeCluster(flights))
        return opened[-1]

    told: list[tuple[int, int, str]] = []
    there = regress(
        [],
        campaign=campaign.root,
        fly=fly,
        environment={},
        open_executor=open_cluster,
        progress=lambda done, total, end: told.append((done, total, end.task.name)),
    )

    def known(outcome: RegressOutcome) -> list[tuple[object, ...]]:
        return [(f.mission, f.seed, f.verdict, f.folder) for f in outcome.report.missions]

    assert known(there) == known(here)
    assert "boom" in there.report.missions[2].reasons[0]
    # The cluster ends the fifth flight first, and the sixth before we hold its future: progress
    # follows it, the report does not.
    names = [f"{name} seed {seed}" for name in "abc" for seed in (1, 2)]
    ended = [*reversed(names[:-1]), names[-1]]
    assert told == [(k + 1, 6, name) for k, name in enumerate(ended)]
    assert [cluster.shut_down for cluster in opened] == [[True]]


def test_what_a_broken_executor_loses_is_flown_again_alone(campaign: Campaign) -> None:
    """The first executor breaks at the second of four flights, while the fourth is submitted."""
    opened: list[int] = []

    def open_cluster(flights: int) -> FakeCluster:
        opened.append(flights)
        first, again = len(opened) == 1, len(opened) == 3
        return FakeCluster(flights, breaks_at=1 if first else 0 if again else None)

    ends = fly_all(tasks(campaign, "a", "b", "c", "d"), fly=fly, open_executor=open_cluster)
    assert opened == [4, 1, 1, 1]
    assert [end.task.loaded.mission.name for end in ends] == ["a", "b", "c", "d"]
    assert [end.error for end in ends] == ["", "", "the process that flew it died", ""]


def test_a_cancelled_flight_is_lost_alone(campaign: Campaign) -> None:
    ends = fly_all(
        tasks(campaign, "a", "b"), fly=fly, open_executor=lambda n: FakeCluster(n, cancels_at=0)
    )
    assert [end.error for end in ends] == ["its executor cancelled it", ""]


def test_an_interrupt_lets_no_further_flight_start(campaign: Campaign) -> None:
    def interrupt(end: FlightEnd) -> None:
        raise KeyboardInterrupt

    opened = FakeCluster(2)
    with pytest.raises(KeyboardInterrupt):
        fly_all(
            tasks(campaign, "a", "b"), fly=fly, open_executor=lambda n: opened, on_end=interrupt
        )
    assert opened.shut_down == [True]
    with pytest.raises(KeyboardInterrupt):
        fly_all(
            tasks(campaign, *(f"m{k}" for k in range(50))),
            fly=fly,
            open_executor=local_executors(1),
            on_end=interrupt,
        )
    assert 1 <= sum(name.startswith("m") for name, _ in campaign.flown()) < 50


@pytest.mark.parametrize("jobs", [1, 2])
def test_missions_are_not_read_again(campaign: Campaign, jobs: int) -> None:
    loaded = tasks(campaign, "a", "b")
    shutil.rmtree(campaign.root / "missions")
    ends = fly_all(loaded, fly=fly, open_executor=local_executors(jobs))
    assert [end.result.mission for end in ends if end.result] == ["a", "b"]


@pytest.mark.xdist_group("flights")
@pytest.mark.parametrize("planned", [True, False])
def test_a_pickled_task_flies_to_the_same_bytes(
    tmp_path: Path, root: Path, planned: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the mission has changed, the platform is gone and the work goes on elsewhere."""
    shutil.copytree(root / "platforms", tmp_path / "platforms")
    (tmp_path / "missions").mkdir()
    mission = tmp_path / "missions" / "short.yaml"
    mission.write_text(SHORT)
    loaded = load_mission(mission)
    before = fly_loaded(loaded, out=tmp_path / "before")
    plan = plan_loaded(loaded, vehicle_of(loaded)) if planned else None
    sent = pickle.dumps(FlightTask(loaded, 3, plan, tmp_path / "after"))
    mission.write_text(SHORT.replace("seeds: [3]", "seeds: [3]\nflight: {approach_speed_mps: 0.2}"))
    shutil.rmtree(tmp_path / "platforms")
    monkeypatch.chdir(tmp_path)
    (end,) = fly_all([pickle.loads(sent)], fly=fly_loaded, open_executor=FakeCluster)
    assert end.error == ""
    assert end.result == before.result
    for name in ("metrics.json", "plan.json", "flight.mcap"):
        assert (end.folder / name).read_bytes() == (before.folder / name).read_bytes(), name


def test_a_place_in_a_mission_that_is_gone_is_its_file(campaign: Campaign) -> None:
    """A worker that refuses a specimen names its mission, not the missing file."""
    mission = campaign.mission("a")
    assert place_in_mission(mission, ["structure", 0]).line is not None
    mission.unlink()
    assert place_in_mission(mission, ["structure", 0]) == Location(str(mission))
