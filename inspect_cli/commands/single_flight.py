"""One flight into a folder of its own: plan, log, metrics, timing."""

from __future__ import annotations

import json
import platform as host
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

from inspect_cli.commands.runs import LOG_NAME, METRICS_NAME, write_json, write_model
from inspect_cli.log import names
from inspect_cli.log.rasters import encoded
from inspect_cli.log.reader import read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.records import CORE_RECORDS, Record, TrueDisturbance
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.modes import ModeTable
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result
from inspect_cli.schema.truth import TruthModel
from inspect_cli.simulation.loop import Ending, Flight
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.rasters import true_rasters
from inspect_cli.vehicles.contacts import wrench_record
from inspect_cli.vehicles.kinds import Vehicle

VERSIONED = ("inspect-cli", "mujoco", "numpy", "numba", "mcap")

Progress = Callable[[float, float], None]
"""(time of flight, planned duration), s."""


class FlightInterrupted(KeyboardInterrupt):
    """The user stopped a flight; what was flown lies in ``folder``."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self.folder = folder


def fly_into(
    folder: Path,
    vehicle: Vehicle,
    plan: Plan,
    loaded: Loaded,
    structure: StructureTruth,
    seed: int,
    progress: Progress | None,
) -> tuple[Result, Ending]:
    """Fly a plan, leave a whole log in ``folder`` and score it.

    Raises:
        FlightInterrupted: the user stopped it; the log holds the part that was flown.
    """
    folder.mkdir(parents=True, exist_ok=True)
    ending = _fly(folder, vehicle, plan, loaded, structure, seed, progress)
    write_model(folder / "plan.json", plan)
    result = evaluate(read_log(folder / LOG_NAME))
    write_model(folder / METRICS_NAME, result)
    write_json(folder / "timing.json", timing(ending))
    return result, ending


def timing(ending: Ending) -> dict[str, float]:
    """Wall-clock times live here and nowhere else, so that the log is reproducible."""
    return {
        "flight_s": ending.flight_s,
        "wall_s": ending.wall_s,
        "log_wall_s": ending.log_wall_s,
        "real_time_factor": ending.flight_s / ending.wall_s,
    }


def _fly(
    folder: Path,
    vehicle: Vehicle,
    plan: Plan,
    loaded: Loaded,
    structure: StructureTruth,
    seed: int,
    progress: Progress | None,
) -> Ending:
    lengths = vehicle.capabilities.lengths
    with LogWriter(folder / LOG_NAME, _records(loaded.truth, vehicle), lengths) as log:
        _attach(log, loaded, plan, vehicle.behaviour.table, seed)
        if rasters := true_rasters(structure, plan.surfaces):
            log.attach(names.SPECIMEN, "application/zip", encoded(rasters))
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


def _records(truth: TruthModel, vehicle: Vehicle) -> list[type[Record]]:
    """The channels of a flight: without a rope, wind or cable there is nothing to say of them."""
    left_out = () if truth.loads_depend_on_the_flight else (TrueDisturbance,)
    contacts = [wrench_record(contact.name) for contact in vehicle.contacts]
    return [*(record for record in CORE_RECORDS if record not in left_out), *contacts]


def _note_reliefs(log: LogWriter, structure: StructureTruth) -> None:
    """Say in the log how true the heights are that stand for a mesh."""
    for surface in structure.surfaces:
        if surface.relief is not None:
            pitch = max(surface.relief.row["pitch"][0])
            departs_mm = 1e3 * surface.relief.deviation_m
            text = f"truth: '{surface.name}' is a mesh, flown as heights every {pitch:.3g} m"
            log.event(0.0, "info", f"{text} that depart from it by {departs_mm:.2g} mm at most")


def _attach(log: LogWriter, loaded: Loaded, plan: Plan, modes: ModeTable, seed: int) -> None:
    """Everything that the report needs travels in the log."""
    models = {
        names.MISSION: loaded.mission,
        names.PLATFORM: loaded.platform,
        names.PLAN: plan,
        names.MODE_TABLE: modes,
        names.TRUTH: loaded.truth,
    }
    for name, model in models.items():
        log.attach(name, "application/json", model.model_dump_json(by_alias=True).encode())
    versions = {name: version(name) for name in VERSIONED} | {"python": host.python_version()}
    run = json.dumps({"seed": seed, "versions": versions}, sort_keys=True)
    log.attach(names.RUN, "application/json", run.encode())
