"""Rendered pictures: what is on them, and what is said where there are none."""

from __future__ import annotations

import io
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import av
import flights
import numpy as np
import pytest
from PIL import Image

from inspect_cli.commands.pictures import mark_styles
from inspect_cli.pictures import render
from inspect_cli.pictures.render import Pictures, render_pictures
from inspect_cli.pictures.script import FILM_PX, FPS, SCENE_PX
from inspect_cli.reporting.figures.palette import ASTM_STYLES

pytestmark = pytest.mark.xdist_group("pictures")  # one rendering for all

STYLES = mark_styles("en")
COLOUR_TOLERANCE = 22
"""Marks are drawn within 6 % of their colour, and levels are a few apart."""


@dataclass(frozen=True)
class Taken:
    log: object
    pictures: Pictures
    scene: np.ndarray
    frames: np.ndarray


def frames_of(film: bytes) -> np.ndarray:
    with av.open(io.BytesIO(film)) as container:
        return np.array([f.to_ndarray(format="rgb24") for f in container.decode(video=0)])


def pixels_near(image: np.ndarray, colour: str) -> int:
    wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
    return int(np.sum(np.abs(image.astype(int) - wanted).max(axis=-1) < COLOUR_TOLERANCE))


@pytest.fixture(scope="module")
def taken(renderer: None, root: Path, tmp_path_factory: pytest.TempPathFactory) -> Taken:
    file = tmp_path_factory.mktemp("flight") / "flight.mcap"
    log = flights.write_flight(file, root, flights.plan())
    pictures = render_pictures(log, flights.result(), STYLES)
    assert pictures.note == ""
    scene = np.asarray(Image.open(io.BytesIO(pictures.scene_png)))
    return Taken(log, pictures, scene, frames_of(pictures.film_mp4))


def test_a_film_has_the_frames_of_a_short_flight_in_real_time(taken: Taken) -> None:
    lasts = (round(flights.DURATION_S * flights.HZ) - 1) / flights.HZ
    assert taken.frames.shape == (round(lasts * FPS), FILM_PX[1], FILM_PX[0], 3)
    assert "in real time" in taken.pictures.film_caption


def test_a_film_plays_in_browsers_from_its_first_bytes(taken: Taken) -> None:
    with av.open(io.BytesIO(taken.pictures.film_mp4)) as container:
        [stream] = container.streams.video
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        assert float(stream.average_rate) == FPS
    assert taken.pictures.film_mp4.index(b"moov") < taken.pictures.film_mp4.index(b"mdat")


def test_pictures_are_small_and_show_something(taken: Taken) -> None:
    assert len(taken.pictures.scene_png) < 300_000
    assert len(taken.pictures.film_mp4) < 1_500_000
    assert taken.scene.shape == (SCENE_PX[1], SCENE_PX[0], 3)
    for image in (taken.scene, taken.frames[0], taken.frames[-1]):
        assert image.std() > 10.0


def test_the_vehicle_moves(taken: Taken) -> None:
    first, last = taken.frames[0].astype(int), taken.frames[-1].astype(int)
    changed = np.abs(first - last).max(axis=-1) > 40
    # Both the place that was left and that which was reached, apart from clock and close view.
    assert changed[210:430].sum() > 300
    assert changed.sum() > 2000


def test_readings_appear_in_the_colours_of_their_classes(taken: Taken) -> None:
    # The legend has every colour from the first frame on; what comes later is on the wall.
    for style in ASTM_STYLES.values():
        legend = pixels_near(taken.frames[0], style.colour)
        assert pixels_near(taken.frames[-1], style.colour) > legend + 8, style.label
    first = taken.frames[int(0.75 * FPS)]
    assert pixels_near(first, ASTM_STYLES["passive"].colour) > pixels_near(
        taken.frames[0], ASTM_STYLES["passive"].colour
    )


def test_captions_say_whose_motion_is_shown(taken: Taken) -> None:
    for caption in (taken.pictures.scene_caption, taken.pictures.film_caption):
        assert "the simulation's true ones" in caption
    assert "touching the structure" in taken.pictures.scene_caption


def test_the_same_log_gives_the_same_bytes(taken: Taken) -> None:
    again = render_pictures(taken.log, flights.result(), STYLES)
    assert again == taken.pictures


def test_a_real_flight_is_drawn_from_its_estimate(
    renderer: None, root: Path, tmp_path: Path
) -> None:
    file = tmp_path / "flight.mcap"
    log = flights.write_flight(file, root, flights.plan(flights.SOFFIT), truth=False)
    pictures = render_pictures(log, flights.result(invalid=1), STYLES, "sortie 1 of 2")
    assert pictures.note == ""
    assert "the vehicle's own estimate" in pictures.film_caption
    assert "sortie 1 of 2" in pictures.scene_caption


@pytest.mark.parametrize(
    ("asked", "said"),
    [("no-such-driver", "no-such-driver"), ("disabled", "the renderer failed")],
)
def test_without_a_driver_a_sentence_says_so(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, asked: str, said: str
) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())
    monkeypatch.setenv("MUJOCO_GL", asked)
    pictures = render_pictures(log, flights.result(), STYLES)
    assert (pictures.scene_png, pictures.film_mp4) == (None, None)
    assert pictures.note.startswith("No pictures: the renderer failed (")
    assert said in pictures.note
    assert "inspect doctor" in pictures.note
    assert "\n" not in pictures.note


def test_what_does_not_end_is_ended(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())
    monkeypatch.setattr(render, "RENDER_PROCESS", "this")  # any module that does no rendering
    slow = "import time; time.sleep(60)"
    run = subprocess.run

    def hanging(command: list[str], **options: object) -> object:
        return run([sys.executable, "-c", slow], **options)

    monkeypatch.setattr(render.subprocess, "run", hanging)
    pictures = render_pictures(log, flights.result(), STYLES, time_limit_s=0.2)
    assert pictures == Pictures(
        note="No pictures: rendering took longer than 0.2 s; 'inspect doctor' says what is missing."
    )


def test_a_crash_is_a_sentence(root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())
    run = subprocess.run

    def crashing(command: list[str], **options: object) -> object:
        # The scene was done before the driver took the process down.
        (Path(command[-1]) / "scene.png").write_bytes(b"scene")
        (Path(command[-1]) / "film.mp4").write_bytes(b"half a film")
        return run([sys.executable, "-c", "import os; os.kill(os.getpid(), 11)"], **options)

    monkeypatch.setattr(render.subprocess, "run", crashing)
    pictures = render_pictures(log, flights.result(), STYLES)
    assert pictures.scene_png == b"scene"
    assert pictures.film_mp4 is None
    assert pictures.note.startswith("No film: the renderer was ended by signal 11")
