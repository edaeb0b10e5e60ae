"""Pictures of a flight from its log alone: a rendered scene and a short film."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.log.reader import RunLog
from inspect_cli.pictures.direction import Direction, direct
from inspect_cli.pictures.marks import MarkStyle
from inspect_cli.pictures.script import FILM_NAME, SCENE_NAME, save_script
from inspect_cli.schema.result import Result

TIME_LIMIT_S = 90.0


@dataclass(frozen=True)
class Pictures:
    """What was rendered of a flight."""

    scene_png: bytes | None = None
    scene_caption: str = ""
    film_mp4: bytes | None = None
    film_caption: str = ""
    note: str = ""
    """Why there is no scene or no film, in one sentence; empty when there are both."""
