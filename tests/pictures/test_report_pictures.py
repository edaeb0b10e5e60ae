"""``inspect report`` and its pictures: which files it writes, and what it says of them."""

from __future__ import annotations

import flights
import pytest

from inspect_cli.commands import pictures as module
from inspect_cli.commands.pictures import pictured
from inspect_cli.log.reader import read_log
from inspect_cli.pictures.render import Pictures


@pytest.fixture
def log(root, tmp_path):
    return flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())


def test_pictures_are_written_beside_the_page(log, tmp_path, monkeypatch) -> None:
    both = Pictures(b"png", "a scene", b"mp4", "a film")
    told = []
    monkeypatch.setattr(module, "render_pictures", lambda *given: told.append(given[-1]) or both)
    assert (
        pictured(log, flights.result(), tmp_path, "en", wanted=True, flight="sortie 1 of 3") == both
    )
    assert told == ["sortie 1 of 3"]
    assert (tmp_path / "scene.png").read_bytes() == b"png"
    assert (tmp_path / "film.mp4").read_bytes() == b"mp4"


@pytest.mark.parametrize("wanted", [True, False])
def test_a_folder_keeps_no_pictures_of_another_flight(log, tmp_path, monkeypatch, wanted) -> None:
    for name in ("scene.png", "film.mp4"):
        (tmp_path / name).write_bytes(b"old")
    none = Pictures(note="No pictures: no driver.")
    monkeypatch.setattr(module, "render_pictures", lambda *given: none)
    assert pictured(log, flights.result(), tmp_path, "en", wanted=wanted) == (
        none if wanted else None
    )
    assert {file.name for file in tmp_path.iterdir()} == {"flight.mcap"}


def test_a_log_is_all_that_pictures_need(log, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disabled")
    moved = tmp_path / "elsewhere" / "flight.mcap"
    moved.parent.mkdir()
    log.path.rename(moved)
    taken = pictured(read_log(moved), flights.result(), moved.parent, "en", wanted=True)
    assert taken.note.startswith("No pictures: the renderer failed")
