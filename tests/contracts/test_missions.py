"""What every file in ``missions/`` keeps to."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema
import pytest

from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.json_schema import committed_file
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.strict_yaml import read_yaml
from inspect_cli.schema.tasks import Task

LEDGER_ROW = re.compile(r"[A-F][0-9]{1,2}(\.[a-z0-9_]+)?")
"""A paper's letter, the number of its experiment, and which of its figures."""


@pytest.fixture(scope="module")
def editor() -> jsonschema.Draft202012Validator:
    """What an editor checks a mission with."""
    schema = json.loads(committed_file("mission").read_text(encoding="utf-8"))
    return jsonschema.Draft202012Validator(schema)


@pytest.fixture(scope="module")
def names(root: Path) -> set[str]:
    """The names of all missions."""
    return {load_mission(file).mission.name for file in (root / "missions").rglob("*.yaml")}


def test_it_is_valid_in_an_editor(
    mission_file: Path, editor: jsonschema.Draft202012Validator
) -> None:
    editor.validate(json.loads(json.dumps(read_yaml(mission_file).plain)))


def test_it_is_named_like_its_file(mission_file: Path) -> None:
    assert load_mission(mission_file).mission.name == mission_file.stem.replace("_", "-")


def test_its_acceptance_asks_for_what_is_measured(mission_file: Path, names: set[str]) -> None:
    acceptance = load_mission(mission_file).mission.acceptance
    assert acceptance, "a mission without acceptance proves nothing"
    for entry in acceptance:
        assert entry.metric in METRICS
        assert entry.ref is None or LEDGER_ROW.fullmatch(entry.ref), entry.ref
        if entry.over is not None:
            assert entry.over.metric in METRICS
            assert entry.over.mission in names


def targets_of(task: Task) -> int:
    """How many targets a task comes to; a drawing at least one each time it is traced."""
    if task.contact_grid is not None:
        return task.contact_grid.rows * task.contact_grid.columns
    if task.coverage is not None:
        return 0  # the surface decides
    if task.contact_points is not None:
        return len(task.contact_points.at_m)
    return task.trace.repeat if task.trace is not None else 1


def test_it_plans(mission_file: Path) -> None:
    loaded = load_mission(mission_file)
    plan = plan_loaded(loaded, vehicle_of(loaded))
    if isinstance(plan, CoveragePlan):
        assert max(sortie.plan.energy_wh for sortie in plan.sorties) <= plan.budget_wh
        again = CoveragePlan.model_validate_json(plan.model_dump_json(by_alias=True))
        assert (again.sorties, again.skipped) == (plan.sorties, plan.skipped)
        return
    asked = sum(targets_of(task) for task in loaded.mission.tasks)
    assert len(plan.targets) == asked
    assert [target.index for target in plan.targets] == list(range(asked))
    assert plan.duration_s == pytest.approx(sum(leg.duration_s for leg in plan.legs))
    energy_wh = loaded.platform.battery.energy_wh
    assert plan.energy_wh < energy_wh, "the battery would be empty before the end"
    # A plan is written and read without loss, directions to their last digit apart.
    again = Plan.model_validate_json(plan.model_dump_json(by_alias=True))
    assert (again.targets, again.legs) == (plan.targets, plan.legs)
