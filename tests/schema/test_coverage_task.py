"""Coverages that are refused, where they stand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli.schema.loading import load_mission

GRID = """\
  - contact_grid:
      on: wall
      rows: 1
      columns: 2
      pitch_m: 0.05
      press_m: 0.1
"""
"""The task of the mission in ``conftest``."""


def coverage(text: str) -> str:
    return f"  - coverage: {{{text}}}\n"


def test_it_is_read_with_its_defaults(campaign: Path) -> None:
    file = campaign / "missions" / "m.yaml"
    file.write_text(file.read_text().replace(GRID, coverage("on: wall, pitch_m: 0.25, refine: {}")))
    mission = load_mission(file).mission
    assert mission.is_survey
    task = mission.tasks[0].coverage
    assert task is not None
    assert (task.edge_m, task.reserve, task.starts) == (None, 0.10, ())
    assert task.refine is not None
    assert (task.refine.difference_mv, task.refine.max_points) == (150.0, 20)
    assert mission.tasks[0].instrument == "half_cell"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("on: wal, pitch_m: 0.25", "tasks[0].coverage.on: no surface is named 'wal'"),
        ("on: wall", "m.yaml:14:5: tasks[0].coverage: missing key 'pitch_m'"),
        ("on: wall, pitch_m: 0", "tasks[0].coverage.pitch_m: must be above 0; found 0"),
        ("on: wall, pitch_m: 1, reserve: 1", "tasks[0].coverage.reserve: must be below 1; found 1"),
        ("on: wall, pitch_m: 1, edge_m: -1", "coverage.edge_m: must be at least 0; found -1"),
        (
            "on: wall, pitch_m: 1, keep_out: [{at_m: [0, 0]}]",
            "tasks[0].coverage.keep_out[0]: missing key 'radius_m'",
        ),
        (
            "on: wall, pitch_m: 1, refine: {max_points: 0}",
            "coverage.refine.max_points: must be at least 1; found 0",
        ),
        (
            "on: wall, pitch_m: 0.3, refine: {pitch_m: 0.3}",
            "tasks[0].coverage: refine.pitch_m 0.3 must be below pitch_m 0.3",
        ),
        (
            "on: wall, pitch_m: 1, starts: [{height: 1}]",
            "tasks[0].coverage.starts[0].height: unknown key",
        ),
    ],
)
def test_what_makes_no_sense(refusal: Callable[..., list[str]], text: str, message: str) -> None:
    problems = refusal(GRID, coverage(text))
    assert len(problems) == 1, problems
    assert message in problems[0], problems


def test_a_refinement_without_readings(refusal: Callable[..., list[str]]) -> None:
    blind = coverage("on: wall, pitch_m: 0.5, refine: {}") + "    sensor: none\n"
    (problem,) = refusal(GRID + "    sensor: half_cell\n", blind)
    assert "tasks[0]: refine compares readings; sensor: none takes none" in problem


def test_a_coverage_beside_another_task(refusal: Callable[..., list[str]]) -> None:
    (problem,) = refusal(GRID, GRID + "    sensor: half_cell\n" + coverage("on: wall, pitch_m: 1"))
    assert problem == (
        "m.yaml:21:5: tasks[1].coverage: a coverage is split into sorties and must be the only "
        "task of its mission\n    give it a mission of its own"
    )
