"""Renders a script in a process of its own, which may crash or be stopped.

    python -m inspect_cli.pictures.render_process FOLDER

reads ``script.npz`` there and writes ``scene.png``, then ``film.mp4``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mujoco

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
from inspect_cli.scene.frames import FrameRenderer, SceneMotion
from inspect_cli.scene.views import View

STILL_SHADOW_PX, FILM_SHADOW_PX = 4096, 2048


def main(folder: Path) -> None:
    """Render what the script in the folder asks for."""
    script = load_script(folder)
    model = mujoco.MjModel.from_binary_path("scene.mjb", {"scene.mjb": script.model.tobytes()})
    scene = SceneMotion(model, script.marks)
    with FrameRenderer(scene, SCENE_PX, STILL_SHADOW_PX) as wide:
        [image] = _frames(script, script.still, scene, wide, None)
        (folder / SCENE_NAME).write_bytes(png_of(image))
    with (
        FrameRenderer(scene, FILM_PX, FILM_SHADOW_PX) as wide,
        FrameRenderer(scene, (INSET_PX, INSET_PX), FILM_SHADOW_PX, shadows=False) as close,
    ):
        frames = _frames(script, script.film, scene, wide, close)
        encode_film(folder / FILM_NAME, frames, FILM_PX, FPS)


def _frames(
    script: Script,
    shot: Shot,
    scene: SceneMotion,
    wide: FrameRenderer,
    close: FrameRenderer | None,
) -> Iterator[Any]:
    """RGB images (height, width, 3) uint8 of a shot, with its lettering and its close view."""
    for k, qpos in enumerate(shot.qpos):
        scene.move(qpos, shot.visible[k])
        image = wide.image(shot.view)
        if close is not None and shot.close_eyes_W is not None and shot.close_at_W is not None:
            inset = close.image(View(shot.close_eyes_W[k], shot.close_at_W[k]))
            image = with_inset(image, inset, shot.close_on_right)
        yield lettered(image, shot.lettering[k], script.legend)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
