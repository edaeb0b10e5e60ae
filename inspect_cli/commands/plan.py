"""``inspect plan``: from a mission to a plan."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from inspect_cli.commands.runs import plan_folder, write_model
from inspect_cli.planning.planner import make_plan
from inspect_cli.schema.loading import Loaded, load_mission
from inspect_cli.schema.plan import Plan, PlanFile
from inspect_cli.structure.surfaces import believed_surfaces
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.kinds import Vehicle


@dataclass(frozen=True)
class PlanOutcome:
    """A plan and where it was written."""

    plan: Plan
    file: Path


def plan(mission: Path, platform: Path | None = None, out: Path | None = None) -> PlanOutcome:
    """Plan a mission and write ``plan.json``.

    Raises SchemaError, GeometryError or InfeasibleError; then nothing is written.
    """
    loaded = load_mission(mission, platform)
    made = plan_loaded(loaded, vehicle_of(loaded))
    folder = out or plan_folder(loaded.root, made.mission, made.platform)
    file = folder / "plan.json"
    content = dict(made) | {"mission_file": str(loaded.mission_file.resolve())}
    write_model(file, PlanFile.model_construct(**content))
    return PlanOutcome(made, file)


def vehicle_of(loaded: Loaded) -> Vehicle:
    """The vehicle that a mission is flown with."""
    return build_vehicle(loaded.platform, loaded.mission.impedance)


def plan_loaded(loaded: Loaded, vehicle: Vehicle) -> Plan:
    """The plan of a mission that is already read."""
    half_cell = loaded.platform.sensors.half_cell
    return make_plan(
        loaded.mission,
        loaded.platform.name,
        vehicle.capabilities,
        believed_surfaces(loaded.mission, loaded.root),
        half_cell.cable_m,
        half_cell.min_force_n,
    )
