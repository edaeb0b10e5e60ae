"""What is left of a flight that the user stopped."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from inspect_cli.commands.report import log_of
from inspect_cli.commands.runs import run_folder
from inspect_cli.errors import InputError
from inspect_cli.log.reader import read_log
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.plan import PlanFile


def interrupted_run(
    mission: Path, seed: int | None, platform: Path | None, out: Path | None
) -> Path | None:
    """The folder with the part that was flown; None where the flight had not begun.

    Takes what ``fly`` was called with, a mission or a saved plan.
    """
    try:
        folder = out or _run_folder(mission, seed, platform)
        log = read_log(log_of(folder))
    except (InputError, OSError, ValidationError):
        return None  # it was stopped before anything was written
    return folder if log.status == "interrupted" else None


def _run_folder(mission: Path, seed: int | None, platform: Path | None) -> Path:
    if mission.suffix == ".json":
        saved = PlanFile.model_validate_json(mission.read_bytes())
        mission = mission.parent / saved.mission_file
    loaded = load_mission(mission, platform)
    seed = loaded.mission.seeds[0] if seed is None else seed
    return run_folder(loaded.root, loaded.mission.name, loaded.platform.name, seed)
