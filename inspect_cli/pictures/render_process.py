"""Renders a script; a process of its own, which may crash or be stopped.

    python -m inspect_cli.pictures.render_process FOLDER

reads ``script.npz`` there and writes ``scene.png``, then ``film.mp4``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from inspect_cli.pictures.film import encode_film
from inspect_cli.pictures.lettering import lettered, png_of, with_inset
from inspect_cli.pictures.names import FILM_NAME, SCENE_NAME
from inspect_cli.pictures.script import (
    FILM_PX,
    FPS,
    INSET_PX,
    SCENE_PX,
    Script,
    Shot,
    load_script,
)
from inspect_cli.spatial.arrays import Vector

STILL_SHADOW_PX, FILM_SHADOW_PX = 4096, 2048


def main(folder: Path) -> None:
    """Render what the script in the folder asks for."""
    script = load_script(folder)
    model = mujoco.MjModel.from_binary_path("scene.mjb", {"scene.mjb": script.model.tobytes()})
    with _renderer(model, SCENE_PX, STILL_SHADOW_PX) as wide:
        [image] = _frames(script, script.still, model, wide, None)
        (folder / SCENE_NAME).write_bytes(png_of(image))
    with (
        _renderer(model, FILM_PX, FILM_SHADOW_PX) as wide,
        _renderer(model, (INSET_PX, INSET_PX), FILM_SHADOW_PX) as close,
    ):
        frames = _frames(script, script.film, model, wide, close)
        encode_film(folder / FILM_NAME, frames, FILM_PX, FPS)


def _renderer(model: mujoco.MjModel, size_px: tuple[int, int], shadow_px: int) -> mujoco.Renderer:
    """A renderer whose buffer is as large as its images: a larger one costs time."""
    model.vis.global_.offwidth, model.vis.global_.offheight = size_px
    model.vis.quality.shadowsize = shadow_px
    return mujoco.Renderer(model, height=size_px[1], width=size_px[0])


def _frames(
    script: Script,
    shot: Shot,
    model: mujoco.MjModel,
    wide: mujoco.Renderer,
    close: mujoco.Renderer | None,
) -> Iterator[Any]:
    """RGB images (height, width, 3) uint8 of a shot, with its lettering and its close view."""
    data = mujoco.MjData(model)
    camera = _camera(shot.view.eye_W, shot.view.at_W)
    for k, qpos in enumerate(shot.qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        model.geom_rgba[script.marks, 3] = shot.visible[k]
        wide.update_scene(data, camera)
        image = wide.render()
        if close is not None and shot.close_eyes_W is not None and shot.close_at_W is not None:
            close.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
            close.update_scene(data, _camera(shot.close_eyes_W[k], shot.close_at_W[k]))
            image = with_inset(image, close.render(), shot.close_on_right)
        yield lettered(image, shot.lettering[k], script.legend)


def _camera(eye_W: Vector, at_W: Vector) -> mujoco.MjvCamera:
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    ahead = at_W - eye_W
    camera.lookat = at_W
    camera.distance = float(np.linalg.norm(ahead))
    camera.azimuth = float(np.degrees(np.arctan2(ahead[1], ahead[0])))
    camera.elevation = float(np.degrees(np.arcsin(ahead[2] / camera.distance)))
    return camera


if __name__ == "__main__":
    main(Path(sys.argv[1]))
