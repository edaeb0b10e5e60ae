"""Tasks of every kind: what is refused where it stands, and what holds by default."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli.errors import SchemaError
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.tasks.hold import Hold
from inspect_cli.schema.tasks.servo import Servo
from inspect_cli.schema.tasks.trace import Trace

WALL = """\
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [3, 0, 1.5], normal: [-1, 0, 0], size_m: [3, 2]}}
"""
HOLD = "hold: {position_m: [0, 0, 1], duration_s: 2}"
LINE = "polyline_m: [[0, 0], [0.2, 0]]"

WithTasks = Callable[..., Mission]


@pytest.fixture
def mission_with(tmp_path: Path) -> WithTasks:
    """``mission_with("hold: {…}", "trace: {…}")``: a mission with these tasks, loaded."""
    (tmp_path / "missions").mkdir()
    (tmp_path / "platforms").mkdir()
    (tmp_path / "missions" / "s.svg").write_text("<svg/>")

    def load(*tasks: str, structure: str = WALL) -> Mission:
        lines = "".join(f"  - {task}\n" for task in tasks)
        head = "schema: 1\nname: t\nplatform: tilt_rotor_hexarotor\n"
        file = tmp_path / "missions" / "m.yaml"
        file.write_text(f"{head}{structure}tasks:\n{lines}")
        return load_mission(file).mission

    return load


def refused(mission_with: WithTasks, *tasks: str, structure: str = WALL) -> str:
    with pytest.raises(SchemaError) as caught:
        mission_with(*tasks, structure=structure)
    (problem,) = caught.value.problems
    assert problem.where is not None
    assert problem.where.line is not None
    return f"{problem.where.path}: {problem.what}"


@pytest.mark.parametrize(
    ("task", "path", "what"),
    [
        ("{}", "tasks[0]", "exactly one of contact_grid"),
        (f"{{{HOLD}, trace: {{on: wall, {LINE}}}}}", "tasks[0]", "give exactly one of"),
        (f"{{{HOLD}, sensor: half_cell}}", "tasks[0]", "a hold has none to read at"),
        (f"{{trace: {{on: wall, {LINE}}}, sensor: half_cell}}", "tasks[0]", "a trace has none"),
        (f"{{{HOLD}, impedance: contact_nd}}", "tasks[0].impedance", "no impedance profile"),
        (f"trace: {{on: bord, {LINE}}}", "tasks[0].trace.on", "bord"),
        ("trace: {on: wall}", "tasks[0].trace", "exactly one of polyline_m, svg"),
        (f"trace: {{on: wall, {LINE}, svg: s.svg, width_m: 1}}", "tasks[0].trace", "exactly one"),
        ("trace: {on: wall, svg: s.svg}", "tasks[0].trace", "an svg needs it"),
        (f"trace: {{on: wall, {LINE}, width_m: 0.2}}", "tasks[0].trace", "belongs to an svg"),
        ("trace: {on: wall, svg: gone.svg, width_m: 1}", "tasks[0].trace.svg", "gone.svg"),
        ("trace: {on: wall, svg: ../../a.svg, width_m: 1}", "tasks[0].trace.svg", "leads out"),
        ("trace: {on: wall, polyline_m: [[0, 0]]}", "tasks[0].trace.polyline_m", "2"),
        ("trace: {on: wall, polyline_m: [[0, 0], [0, 0]]}", "tasks[0].trace", "no edge"),
        ("trace: {on: wall, polyline_m: [[0, 0], [.nan, 0]]}", "tasks[0].trace.polyline_m", ""),
        (f"trace: {{on: wall, {LINE}, repeat: 0}}", "tasks[0].trace.repeat", ""),
        (f"trace: {{on: wall, {LINE}, speed_mps: 0}}", "tasks[0].trace.speed_mps", ""),
        ("servo: {slide_m: 1}", "tasks[0].servo", "start"),
        ("servo: {start: {position_m: [0, 0, 1]}, direction: z}", "tasks[0].servo.direction", ""),
        ("hold: {position_m: [0, 0, 1], duration_s: 0}", "tasks[0].hold.duration_s", ""),
        ("hold: {position_m: [0, 0, 5000], duration_s: 1}", "tasks[0].hold.position_m", ""),
    ],
)
def test_a_bad_task_is_refused_where_it_stands(
    mission_with: WithTasks, task: str, path: str, what: str
) -> None:
    message = refused(mission_with, task)
    assert message.startswith(path)
    assert what in message


def test_without_a_structure_only_free_tasks_can_be_done(mission_with: WithTasks) -> None:
    servo = "servo: {start: {position_m: [0, 0, 1]}}"
    assert mission_with(HOLD, servo, structure="").structure == ()
    message = refused(mission_with, f"trace: {{on: wall, {LINE}}}", structure="")
    assert message == "tasks[0].trace.on: no surface is named 'wall'"


def test_defaults(mission_with: WithTasks) -> None:
    servo = "servo: {start: {position_m: [0, 0, 1]}}"
    mission = mission_with(HOLD, f"trace: {{on: wall, {LINE}}}", servo)
    hold, trace, following = (task.work for task in mission.tasks)
    assert isinstance(hold, Hold)
    assert hold.heading_deg == 0.0
    assert isinstance(trace, Trace)
    assert (trace.press_m, trace.standoff_m, trace.speed_mps) == (0.10, 0.25, 0.1)
    assert (trace.repeat, trace.settle_s, trace.at_m) == (1, 2.0, (0.0, 0.0))
    assert isinstance(following, Servo)
    assert (following.direction, following.slide_m, following.speed_mps) == ("-x", 0.5, 0.17)
    assert [task.instrument for task in mission.tasks] == [None] * 3
    assert [task.impedance for task in mission.tasks] == [None] * 3
    assert [task.on for task in mission.tasks] == [None, "wall", None]


@pytest.mark.parametrize(
    ("sensor", "reads"), [("", "half_cell"), (", sensor: half_cell", "half_cell"),
                          (", sensor: none", None)]
)  # fmt: skip
def test_contacts_are_read_unless_told_otherwise(
    mission_with: WithTasks, sensor: str, reads: str | None
) -> None:
    grid = "contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.1}"
    (task,) = mission_with(f"{{{grid}{sensor}}}").tasks
    assert task.instrument == reads


def test_the_drawing_is_found_beside_the_mission(mission_with: WithTasks) -> None:
    (task,) = mission_with("trace: {on: wall, svg: s.svg, width_m: 0.2}").tasks
    assert task.trace is not None
    assert task.trace.svg == "missions/s.svg"
