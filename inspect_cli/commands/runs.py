"""Where a run's files lie: one folder, each file written whole or not at all.

reports/<mission>/<platform>/plan.json                       a plan
reports/<mission>/<platform>-seed<N>/                        a run
    plan.json  flight.mcap  metrics.json  timing.json  readings.csv  report.html
    scene.png  film.mp4
    sortie-<k>/                                          the same again for each flight of a survey,
                                                         whose own folder has no log
"""

from __future__ import annotations

import fcntl
import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pydantic import BaseModel

from inspect_cli.errors import InputError
from inspect_cli.exchange.readings_csv import readings_csv
from inspect_cli.files import write_whole
from inspect_cli.pictures.names import FILM_NAME, SCENE_NAME
from inspect_cli.schema.result import Result

LOG_NAME = "flight.mcap"
METRICS_NAME = "metrics.json"
READINGS_NAME = "readings.csv"
LOCK_NAME = ".flying"
RUN_FILES = (
    "plan.json",
    LOG_NAME,
    f"{LOG_NAME}.part",
    METRICS_NAME,
    "timing.json",
    READINGS_NAME,
    "report.html",
    SCENE_NAME,
    FILM_NAME,
)
SORTIES = "sortie-*"
"""The folders of a survey's flights."""


def plan_folder(root: Path, mission: str, platform: str) -> Path:
    """The folder of a plan in a campaign."""
    return root / "reports" / mission / platform


def run_folder(root: Path, mission: str, platform: str, seed: int) -> Path:
    """The folder of a run in a campaign."""
    return root / "reports" / mission / f"{platform}-seed{seed}"


@contextmanager
def prepared_run(folder: Path) -> Iterator[None]:
    """A run's folder, without what an earlier run left in it and closed to any other run.

    Raises InputError when another run is writing there, or nobody can.
    """
    for name in RUN_FILES:
        if (folder / name).is_dir():
            what = f"{folder / name} is a folder where the flight writes a file"
            raise InputError(what, hint="move it away, or choose another folder with --out")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / LOCK_NAME).open("w")
    except OSError as error:
        what = f"{folder} cannot be written: {error.strerror}"
        raise InputError(what, hint="choose another folder with --out") from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            what = f"another flight is writing into {folder}"
            raise InputError(what, hint="wait for it, or fly with --out") from error
        _clear(folder)
        for sortie in folder.glob(SORTIES):
            _clear(sortie)
            with suppress(OSError):
                sortie.rmdir()  # what is not ours stays
        try:
            yield
        finally:
            (folder / LOCK_NAME).unlink(missing_ok=True)


def log_of(run: Path) -> Path:
    """The log of a run folder, finished or cut; a file is its own."""
    if not run.is_dir():
        return run
    for name in (LOG_NAME, f"{LOG_NAME}.part"):
        if (run / name).exists():
            return run / name
    raise InputError(f"{run} holds no {LOG_NAME}", hint="fly it first: inspect fly MISSION")


def _clear(folder: Path) -> None:
    for name in RUN_FILES:
        (folder / name).unlink(missing_ok=True)


def write_model(path: Path, model: BaseModel) -> None:
    """Write a file model as JSON, by its file names for things."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, (model.model_dump_json(by_alias=True, indent=1) + "\n").encode())


def write_json(path: Path, data: object) -> None:
    """Write plain data as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, (json.dumps(data, indent=1, sort_keys=True) + "\n").encode())


def write_readings(folder: Path, result: Result) -> None:
    """Write ``readings.csv`` of a run into its folder."""
    write_whole(folder / READINGS_NAME, readings_csv(result.points))
