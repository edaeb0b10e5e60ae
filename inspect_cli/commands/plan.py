"""``inspect plan``: from a mission to a plan."""

from __future__ import annotations

import difflib
import hashlib
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from inspect_cli.commands.runs import plan_folder, write_model
from inspect_cli.errors import InfeasibleError, Location, Problem, SchemaError
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.planning.coverage import Surveyor
from inspect_cli.planning.planner import make_plan
from inspect_cli.schema.campaign import platform_files
from inspect_cli.schema.coverage import CoveragePlan, CoveragePlanFile
from inspect_cli.schema.loading import Loaded, load_mission, load_platform, place_in_mission
from inspect_cli.schema.nodes import Step
from inspect_cli.schema.plan import Plan, PlanFile
from inspect_cli.schema.vehicle import HalfCellModel, PlatformBase
from inspect_cli.structure.drawings import drawings_of
from inspect_cli.structure.surfaces import believed_surfaces
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.kinds import Vehicle


@dataclass(frozen=True)
class PlanOutcome:
    """A plan and where it was written."""

    plan: Plan | CoveragePlan
    file: Path


def plan(mission: Path, platform: Path | None = None, out: Path | None = None) -> PlanOutcome:
    """Plan a mission and write ``plan.json``.

    Raises SchemaError, GeometryError or InfeasibleError; then nothing is written.
    """
    loaded = load_mission(mission, platform)
    made = plan_loaded(loaded, vehicle_of(loaded))
    folder = out or plan_folder(loaded.root, made.mission, made.platform)
    content = dict(made) | {
        "mission_file": os.path.relpath(loaded.mission_file.resolve(), folder.resolve()),
        "inputs_sha256": inputs_sha256(loaded),
    }
    file = folder / "plan.json"
    model = CoveragePlanFile if isinstance(made, CoveragePlan) else PlanFile
    write_model(file, model.model_construct(**content))
    return PlanOutcome(made, file)


def inputs_sha256(loaded: Loaded) -> str:
    """A fingerprint of what a plan is made from: mission and platform, not the truth."""
    parts = (loaded.mission, loaded.platform)
    text = "\n".join(part.model_dump_json(by_alias=True) for part in parts)
    return hashlib.sha256(text.encode()).hexdigest()


def vehicle_of(loaded: Loaded) -> Vehicle:
    """The vehicle that a mission is flown with."""
    return build_vehicle(loaded.platform)


def plan_loaded(loaded: Loaded, vehicle: Vehicle) -> Plan | CoveragePlan:
    """The plan of a mission that is already read.

    Raises GeometryError and InfeasibleError with the mission's file in every problem.
    """
    _check_metrics(loaded)
    _check_tasks(loaded, vehicle)
    cable_m, min_force_n = _probe_limits(loaded.platform)
    try:
        if loaded.mission.is_survey:
            return surveyor_of(loaded, vehicle).survey()
        return make_plan(
            loaded.mission,
            loaded.platform.name,
            vehicle.capabilities,
            believed_surfaces(loaded.mission, loaded.root),
            cable_m,
            min_force_n,
            loaded.platform.battery.energy_wh,
            drawings_of(loaded.mission, loaded.root),
        )
    except InfeasibleError as error:
        raise InfeasibleError(_placed(error.problems, loaded.mission_file)) from error


def surveyor_of(loaded: Loaded, vehicle: Vehicle) -> Surveyor:
    """The planner of a mission that covers a surface."""
    cable_m, min_force_n = _probe_limits(loaded.platform)
    return Surveyor(
        loaded.mission,
        loaded.platform.name,
        vehicle.capabilities,
        believed_surfaces(loaded.mission, loaded.root),
        cable_m,
        min_force_n,
        loaded.platform.battery.energy_wh,
    )


def _probe_limits(platform: PlatformBase) -> tuple[float, float]:
    """Length of the probe's cable, m, and the least force of a reading, N; of no probe none."""
    probe = platform.find(HalfCellModel)
    return (probe.cable_m, probe.min_force_n) if probe else (math.inf, 0.0)


def _check_metrics(loaded: Loaded) -> None:
    """Refuse an acceptance of metrics that there are not."""
    problems = []
    for entry in loaded.mission.acceptance:
        named = [entry.metric] + ([entry.over.metric] if entry.over else [])
        for name in named:
            if name not in METRICS:
                near = difflib.get_close_matches(name, METRICS, 1)
                hint = f"did you mean '{near[0]}'?" if near else ""
                problems.append(Problem(f"acceptance: no metric is named '{name}'", hint=hint))
    if problems:
        raise SchemaError(_placed(problems, loaded.mission_file))


def _check_tasks(loaded: Loaded, vehicle: Vehicle) -> None:
    """Refuse a task that the vehicle's modes cannot do."""
    known = vehicle.capabilities.tasks
    refused = [(k, t.kind) for k, t in enumerate(loaded.mission.tasks) if t.kind not in known]
    if not refused:
        return
    able = _abilities(loaded)
    problems = []
    for k, kind in refused:
        others = sorted(name for name, tasks in able.items() if kind in tasks)
        what = f"{loaded.platform.name} cannot do the task '{kind}'"
        hint = f"it can do: {', '.join(sorted(known)) or 'none'}; "
        hint += f"platforms that can: {', '.join(others) or 'none'}"
        problems.append(Problem(what, _place_of(loaded, ("tasks", k, kind)), hint))
    raise SchemaError(problems)


def _abilities(loaded: Loaded) -> dict[str, frozenset[str]]:
    """What each of the campaign's platforms can do, by its name; without those that are refused."""
    able = {}
    for name, file in platform_files(loaded.root).items():
        try:
            able[name] = build_vehicle(load_platform(file)).capabilities.tasks
        except SchemaError:
            continue
    return able


def _place_of(loaded: Loaded, steps: Sequence[Step]) -> Location:
    """Where the mission states the value at ``steps``; its file alone where that is gone."""
    if not loaded.mission_file.is_file():
        return Location(str(loaded.mission_file))
    return place_in_mission(loaded.mission_file, steps)


def _placed(problems: Sequence[Problem], file: Path) -> list[Problem]:
    return [replace(p, where=p.where or Location(str(file))) for p in problems]
