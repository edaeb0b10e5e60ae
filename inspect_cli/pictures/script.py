"""The input of the render process: model, poses and views in one file of plain arrays.

Rendering is a process of its own, because a graphics driver may crash or hang.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from inspect_cli.log.layout import Bytes
from inspect_cli.pictures.names import SCRIPT_NAME
from inspect_cli.scene.views import View
from inspect_cli.spatial.arrays import Indices, Mask, Points

SCENE_PX, FILM_PX = (1280, 720), (848, 480)
"""Width and height of a film are multiples of 16, the encoder's blocks: the padding of a partial
block differs from run to run, and so would the bytes."""
INSET_PX = 190
"""Width and height of the close view in a film's corner."""
FPS = 12


@dataclass(frozen=True)
class LegendEntry:
    """A class of readings in the legend."""

    label: str
    colour: str
    symbol: str


@dataclass(frozen=True, eq=False)
class Shot:
    """Frames in order, all seen by one camera."""

    qpos: Points
    """(n, nq)"""
    visible: Mask
    """(n, marks): which marks are there."""
    view: View
    close_on_right: bool
    """Whether the second camera's picture is in the upper right corner, not the upper left."""
    lettering: tuple[str, ...]
    """One line for each frame; empty for none."""
    close_eyes_W: Points | None
    """(n, 3): places of a second camera that looks at ``close_at_W`` (n, 3); None without one."""
    close_at_W: Points | None


@dataclass(frozen=True, eq=False)
class Script:
    """A still and a film."""

    model: Bytes
    """The compiled MuJoCo model."""
    marks: Indices
    """Numbers of the geoms of the marks."""
    still: Shot
    film: Shot
    legend: tuple[LegendEntry, ...]


def save_script(script: Script, folder: Path) -> None:
    """Write the script into the folder that the render process reads."""
    arrays: dict[str, Any] = {"model": script.model, "marks": script.marks}
    words: dict[str, object] = {"legend": [vars(entry) for entry in script.legend]}
    for name, shot in (("still", script.still), ("film", script.film)):
        arrays[f"{name}.qpos"] = shot.qpos
        arrays[f"{name}.visible"] = shot.visible
        arrays[f"{name}.view"] = np.stack([shot.view.eye_W, shot.view.at_W])
        if shot.close_eyes_W is not None and shot.close_at_W is not None:
            arrays[f"{name}.close"] = np.stack([shot.close_eyes_W, shot.close_at_W])
        words[name] = {"close_on_right": shot.close_on_right, "lettering": shot.lettering}
    arrays["words"] = np.array(json.dumps(words))
    np.savez(folder / SCRIPT_NAME, **arrays)


def load_script(folder: Path) -> Script:
    """Read what ``save_script`` wrote."""
    with np.load(folder / SCRIPT_NAME, allow_pickle=False) as arrays:
        words = json.loads(str(arrays["words"]))
        shots = []
        for name in ("still", "film"):
            close = arrays.get(f"{name}.close", (None, None))
            shots.append(
                Shot(
                    arrays[f"{name}.qpos"],
                    arrays[f"{name}.visible"],
                    View(*arrays[f"{name}.view"]),
                    words[name]["close_on_right"],
                    tuple(words[name]["lettering"]),
                    *close,
                )
            )
        legend = tuple(LegendEntry(**entry) for entry in words["legend"])
        return Script(arrays["model"], arrays["marks"], shots[0], shots[1], legend)
