"""``inspect fly``: from a mission or a plan to a flight log and its metrics."""

from __future__ import annotations

import json
import platform as host
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from pydantic import ValidationError

from inspect_cli.commands.plan import inputs_sha256, plan_loaded, vehicle_of
from inspect_cli.commands.runs import LOG_NAME, prepared_run, run_folder, write_json, write_model
from inspect_cli.errors import InputError
from inspect_cli.log import names
from inspect_cli.log.reader import read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.records import CORE_RECORDS, Record, TrueDisturbance
from inspect_cli.schema.loading import Loaded, load_mission
from inspect_cli.schema.plan import Plan, PlanFile
from inspect_cli.schema.result import Result
from inspect_cli.schema.truth import TruthModel
from inspect_cli.simulation.loop import Ending, Flight
from inspect_cli.truth.geometry import StructureTruth, true_structure
from inspect_cli.vehicles.kinds import Vehicle

PLAN_FIRST = "make it anew with 'inspect plan MISSION'"
VERSIONED = ("inspect-cli", "mujoco", "numpy", "numba", "mcap")


@dataclass(frozen=True)
class FlyOutcome:
    """A flight's result and where its files are."""

    result: Result
    folder: Path
    ending: Ending


class FlightInterrupted(KeyboardInterrupt):
    """The user stopped a flight; what was flown lies in ``folder``."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self.folder = folder


def fly(
    mission: Path,
    *,
    seed: int | None = None,
    platform: Path | None = None,
    out: Path | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> FlyOutcome:
    """Fly a mission, or a saved plan, in simulation.

    ``seed`` defaults to the mission's first. ``progress`` is called with the time of flight and
    the planned duration, s. Raises InputError before anything is written.
    """
    loaded, plan = _load(mission, platform)
    vehicle = vehicle_of(loaded)
    plan = plan or plan_loaded(loaded, vehicle)
    seed = loaded.mission.seeds[0] if seed is None else seed
    folder = out or run_folder(loaded.root, plan.mission, plan.platform, seed)
    structure = true_structure(loaded.truth, plan.surfaces, loaded.root)
    with prepared_run(folder):
        ending = _fly(folder, vehicle, plan, loaded, structure, seed, progress)
        write_model(folder / "plan.json", plan)
        result = evaluate(read_log(folder / LOG_NAME))
        write_model(folder / "metrics.json", result)
        write_json(folder / "timing.json", _timing(ending))
    return FlyOutcome(result, folder, ending)


def _fly(
    folder: Path,
    vehicle: Vehicle,
    plan: Plan,
    loaded: Loaded,
    structure: StructureTruth,
    seed: int,
    progress: Callable[[float, float], None] | None,
) -> Ending:
    """Fly and leave a whole log; an interrupted flight leaves the part that was flown."""
    lengths = vehicle.capabilities.lengths
    with LogWriter(folder / LOG_NAME, _records(loaded.truth), lengths) as log:
        _attach(log, loaded, plan, seed)
        log.scene(0.0, plan)
        _note_reliefs(log, structure)
        estimation = loaded.mission.estimation
        flight = Flight(vehicle, plan, loaded.truth, structure, seed, log, estimation)
        report = (lambda t_s: progress(t_s, plan.duration_s)) if progress else None
        try:
            ending = flight.run(report)
        except KeyboardInterrupt:
            log.close("interrupted", "stopped by the user")
            raise FlightInterrupted(folder) from None
        log.close(ending.status, ending.reason)
    return ending


def _records(truth: TruthModel) -> list[type[Record]]:
    """The channels of a flight: without a rope, wind or cable there is nothing to say of them."""
    left_out = () if truth.loads_depend_on_the_flight else (TrueDisturbance,)
    return [record for record in CORE_RECORDS if record not in left_out]


def _note_reliefs(log: LogWriter, structure: StructureTruth) -> None:
    """Say in the log how true the heights are that stand for a mesh."""
    for surface in structure.surfaces:
        if surface.relief is not None:
            pitch = max(surface.relief.row["pitch"][0])
            departs_mm = 1e3 * surface.relief.deviation_m
            text = f"truth: '{surface.name}' is a mesh, flown as heights every {pitch:.3g} m"
            log.event(0.0, "info", f"{text} that depart from it by {departs_mm:.2g} mm at most")


def _load(path: Path, platform: Path | None) -> tuple[Loaded, Plan | None]:
    if path.suffix != ".json":
        return load_mission(path, platform), None
    try:
        saved = PlanFile.model_validate_json(path.read_bytes())
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}", hint=PLAN_FIRST) from error
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise InputError(f"{path}: not a plan: {where}: {first['msg']}", hint=PLAN_FIRST) from error
    loaded = load_mission(path.parent / saved.mission_file, platform)
    if inputs_sha256(loaded) != saved.inputs_sha256:
        raise InputError(
            f"{path}: the mission or the platform has changed since it was planned",
            hint=PLAN_FIRST,
        )
    return loaded, saved.plan()


def _attach(log: LogWriter, loaded: Loaded, plan: Plan, seed: int) -> None:
    """Everything that the report needs travels in the log."""
    models = {
        names.MISSION: loaded.mission,
        names.PLATFORM: loaded.platform,
        names.PLAN: plan,
        names.TRUTH: loaded.truth,
    }
    for name, model in models.items():
        log.attach(name, "application/json", model.model_dump_json(by_alias=True).encode())
    versions = {name: version(name) for name in VERSIONED} | {"python": host.python_version()}
    run = json.dumps({"seed": seed, "versions": versions}, sort_keys=True)
    log.attach(names.RUN, "application/json", run.encode())


def _timing(ending: Ending) -> dict[str, float]:
    """Wall-clock times live here and nowhere else, so that the log is reproducible."""
    return {
        "flight_s": ending.flight_s,
        "wall_s": ending.wall_s,
        "log_wall_s": ending.log_wall_s,
        "real_time_factor": ending.flight_s / ending.wall_s,
    }
