"""Pictures of a flight from its log alone: a rendered scene and a short film.

Rendering runs in a process of its own (``pictures.render_process``): if a graphics driver crashes
there, the report is still written, and a note says why pictures are missing.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from inspect_cli.log.reader import RunLog
from inspect_cli.pictures.names import FILM_NAME, SCENE_NAME
from inspect_cli.pictures.script import save_script
from inspect_cli.schema.result import Result

if TYPE_CHECKING:
    from inspect_cli.pictures.direction import Direction
    from inspect_cli.scene.marks import MarkStyle

TIME_LIMIT_S = 90.0
RENDER_PROCESS = "inspect_cli.pictures.render_process"
UNLOADABLE = (ImportError, AttributeError, OSError, RuntimeError)
"""Exceptions of importing MuJoCo where the backend that MUJOCO_GL names is missing."""
SEE_DOCTOR = "'inspect doctor' says what is missing"


@dataclass(frozen=True)
class Pictures:
    """What was rendered of a flight."""

    scene_png: bytes | None = None
    """1280 × 720."""
    scene_caption: str = ""
    film_mp4: bytes | None = None
    """848 × 480, H.264 without sound."""
    film_caption: str = ""
    note: str = ""
    """Why the scene or the film is missing, in one sentence; empty when there are both."""


def render_pictures(
    log: RunLog,
    result: Result,
    styles: Mapping[str, MarkStyle],
    flight: str = "",
    time_limit_s: float = TIME_LIMIT_S,
) -> Pictures:
    """Render a scene and a film of a flight; the same log gives the same bytes on one machine.

    Never raises and never takes much longer than ``time_limit_s`` for want of a driver, of
    motion in the log, or of a good end of the flight: ``note`` says what is missing and why.

    Args:
        log: the flight, simulated or real, whole or interrupted.
        result: its readings, as they were judged.
        styles: how the ASTM classes are drawn, and with the key 'invalid' what does not count.
        flight: which flight it is, for the captions, where there are several: 'sortie 1 of 3'.
        time_limit_s: for rendering.

    Raises:
        LogError: the log lacks attachments that the pictures need.
    """
    try:
        from inspect_cli.pictures.direction import direct
    except UNLOADABLE as error:
        return Pictures(note=f"No pictures: MuJoCo cannot be loaded ({error}); {SEE_DOCTOR}.")
    try:
        directed = direct(log, result, styles)
    except ValueError as error:  # MuJoCo's compiler
        return Pictures(note=f"No pictures: the scene cannot be built ({error}).")
    if directed is None:
        return Pictures(note="No pictures: the log holds no poses of the vehicle to draw.")
    with tempfile.TemporaryDirectory(prefix="inspect-pictures-") as name:
        folder = Path(name)
        save_script(directed.script, folder)
        failure = _rendered(folder, time_limit_s)
        scene, film = _bytes_of(folder / SCENE_NAME), _bytes_of(folder / FILM_NAME)
    if failure is not None:
        film = None  # it may have been cut off
    return Pictures(
        scene,
        _scene_caption(log, directed, flight) if scene else "",
        film,
        _film_caption(log, directed, flight) if film else "",
        _note(failure, scene is not None) if film is None else "",
    )


def _rendered(folder: Path, time_limit_s: float) -> str | None:
    """Run the render process; None if it finished, else the reason why not."""
    environment = dict(os.environ)
    if sys.platform == "linux":
        environment.setdefault("MUJOCO_GL", "egl")
    command = [sys.executable, "-m", RENDER_PROCESS, str(folder)]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=time_limit_s,
            env=environment,
            stdin=subprocess.DEVNULL,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"rendering took longer than {time_limit_s:g} s"
    except OSError as error:
        return f"the renderer cannot be started: {error.strerror or error}"
    if done.returncode == 0:
        return None
    if done.returncode < 0:
        return f"the renderer was ended by signal {-done.returncode}"
    # Some drivers complain at exit, after the exception that ended the work.
    said = [line for line in done.stderr.splitlines() if line and not line.startswith((" ", "Exc"))]
    last = said[-1].strip().rstrip(".") if said else f"it ended with {done.returncode}"
    return f"the renderer failed ({last})"


def _bytes_of(file: Path) -> bytes | None:
    return file.read_bytes() if file.is_file() and file.stat().st_size else None


def _note(failure: str | None, has_scene: bool) -> str:
    what = "No film" if has_scene else "No pictures"
    return f"{what}: {failure or 'the renderer left no file'}; {SEE_DOCTOR}."


def _scene_caption(log: RunLog, directed: Direction, flight: str) -> str:
    doing = " touching the structure" if directed.touching else ""
    begin = directed.motion.t_s[0]
    moment = f"{directed.still_s - begin:.0f} s after the log begins"
    return _sentences(f"{_vehicle(log)}{doing}, {moment}{_of(flight)}", log, directed)


def _film_caption(log: RunLog, directed: Direction, flight: str) -> str:
    times = directed.motion.t_s
    pace = "in real time" if directed.speed < 1.05 else f"{directed.speed:.3g} times as fast"
    lasted = f"{times[-1] - times[0]:.0f} s of flight"
    first = f"{_vehicle(log)}: {lasted}{_of(flight)}, shown {pace}"
    return _sentences(first, log, directed)


def _vehicle(log: RunLog) -> str:
    return log.platform().title or log.plan().platform


def _of(flight: str) -> str:
    return f" ({flight})" if flight else ""


def _sentences(first: str, log: RunLog, directed: Direction) -> str:
    """A caption: what is seen, whose poses are drawn, and what the surfaces and marks stand for."""
    moves = {
        "truth": "Poses are the simulation's true ones",
        "estimate": "Poses are the vehicle's own estimate",
    }[directed.motion.source]
    said = [first, f"Rendered from the log. {moves}, the structure is as the planner believed it"]
    if log.status == "interrupted":
        said.append("The log was interrupted")
    if directed.motion.cut:
        said.append("What the log holds after that cannot be drawn: the flight diverged")
    return ". ".join(said) + "."
