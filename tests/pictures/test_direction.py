"""What is shown, when, and from where; none of it needs a driver."""

from __future__ import annotations

import flights
import numpy as np
import pytest
from modes import Mode
from PIL import Image

from inspect_cli.commands.pictures import mark_styles
from inspect_cli.log.reader import RunLog
from inspect_cli.pictures.direction import direct
from inspect_cli.pictures.lettering import lettered, png_of
from inspect_cli.pictures.render import render_pictures
from inspect_cli.pictures.script import LegendEntry, load_script, save_script
from inspect_cli.scene.motion import Motion
from inspect_cli.scene.scene_model import slab
from inspect_cli.scene.views import framed, in_frame
from inspect_cli.schema.geometry import Shape
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.primitives import project

STYLES = mark_styles("en")
SHAPES = {
    "wall": flights.WALL,
    "soffit": flights.SOFFIT,
    "floor": flights.FLOOR,
    "column": flights.COLUMN,
    "vault": flights.VAULT,
    "ball": flights.BALL,
}
FOV, ASPECT = np.radians(40.0), 16 / 9


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
def test_every_surface_is_staged_and_its_readings_are_seen(root, tmp_path, shape: Shape) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan(shape))
    directed = direct(log, flights.result(), STYLES)
    eye = directed.script.film.view.eye_W
    assert eye[2] > 0.1
    for target in log.plan().targets:
        towards = eye - np.array(target.p_WC)
        assert towards @ np.array(target.n_W) > 0.0, "seen from behind"
    assert [entry.label for entry in directed.script.legend] == ["passive", "uncertain", "active"]


def test_a_view_has_all_points_in_its_frame_and_some_at_its_edges() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        points = rng.normal(size=(50, 3)) * rng.uniform(0.1, 5.0, 3) + rng.normal(size=3)
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        places = in_frame(framed(points, direction, FOV, ASPECT), points, FOV, ASPECT)
        assert np.abs(places).max() < 1.0
        assert np.abs(places).max() == pytest.approx(1.0 / 1.06)  # the margin


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
def test_a_slab_is_closed_and_has_the_patch_as_its_front(shape: Shape) -> None:
    patch = primitive_of(shape)
    vertices, normals, uv, faces = slab(patch, (12, 8))
    n_front = 13 * 9
    heights = [project(patch, 0, p)[2] for p in vertices[:n_front]]
    assert np.allclose(heights, 0.0, atol=1e-9)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert len(uv) == len(vertices)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    areas = 0.5 * np.cross(b - a, c - a)
    # The faces of a closed body add up to nothing, and all turn to where their normals point.
    assert np.allclose(areas.sum(axis=0), 0.0, atol=1e-9)
    assert np.all(np.einsum("ij,ij->i", areas, normals[faces[:, 0]]) > -1e-9)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    assert volume > 0.0, "the faces look inwards"


def test_readings_appear_when_they_are_taken(root, tmp_path) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())
    script = direct(log, flights.result(), STYLES).script
    frames = len(script.film.qpos)
    times = np.linspace(0.0, 1.99, frames)
    planned, readings = script.film.visible[:, :3], script.film.visible[:, 3:6]
    for k, at_s in enumerate(flights.AT_S):
        assert np.array_equal(readings[:, k], times >= at_s)
        assert np.array_equal(planned[:, k], times < at_s)


def test_a_stroke_leaves_a_trace(root, tmp_path) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan(), mode=Mode.SLIDE)
    visible = direct(log, flights.result(), STYLES).script.film.visible[:, 6:]
    drawn = visible.sum(axis=1)
    assert drawn[0] == 0
    assert np.all(np.diff(drawn) >= 0)
    # 0.3 m from the first point to the last, a dot each 8 mm; one row in 100 Hz is 3 mm.
    assert 0.3 / 0.011 < drawn[-1] <= 0.3 / 0.008 + 2


def test_invalid_readings_and_unknown_classes_have_their_mark(root, tmp_path) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())
    script = direct(log, flights.result(invalid=0), STYLES).script
    assert [entry.label for entry in script.legend][-1] == STYLES["invalid"].label
    assert direct(log, flights.result(), {}).script.legend == ()


def test_a_diverged_flight_is_shown_until_then(root, tmp_path) -> None:
    file = tmp_path / "flight.mcap"
    log = flights.write_flight(file, root, flights.plan(), diverges_s=1.2)
    directed = direct(log, flights.result(), STYLES)
    assert directed.motion.cut
    assert directed.motion.t_s[-1] == pytest.approx(1.19)
    assert np.all(np.isfinite(directed.script.film.qpos))


def test_a_flight_without_poses_has_a_note(root, tmp_path) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan(), diverges_s=0.0)
    pictures = render_pictures(log, flights.result(), STYLES)
    assert pictures.note == "No pictures: the log holds no poses of the vehicle to draw."


def test_an_interrupted_flight_is_shown_as_far_as_it_was_read(root, tmp_path) -> None:
    log: RunLog = flights.write_flight(
        tmp_path / "flight.mcap", root, flights.plan(), truth=False, finished=False
    )
    assert log.status == "interrupted"
    directed = direct(log, flights.result(), STYLES)
    assert directed.motion.source == "estimate"
    # Without a true state the joints are those that were commanded.
    joints = directed.motion.qpos[:, 7:]
    assert np.allclose(joints, 0.1 * directed.motion.t_s[:, None])


def test_a_long_flight_is_shown_faster() -> None:
    from inspect_cli.pictures.direction import FILM_S, _film_times

    t_s = np.linspace(3.0, 183.0, 1000)
    motion = Motion(t_s, np.zeros((1000, 7)), np.zeros((1000, 3)), "truth", False)
    times, speed = _film_times(motion)
    assert speed == pytest.approx(180.0 / FILM_S)
    assert (times[0], times[-1]) == (3.0, 183.0)


def test_a_script_comes_back_as_it_was_written(root, tmp_path) -> None:
    log = flights.write_flight(tmp_path / "flight.mcap", root, flights.plan())
    script = direct(log, flights.result(), STYLES).script
    save_script(script, tmp_path)
    again = load_script(tmp_path)
    assert again.legend == script.legend
    assert np.array_equal(again.model, script.model)
    for one, other in ((again.film, script.film), (again.still, script.still)):
        assert np.array_equal(one.qpos, other.qpos)
        assert np.array_equal(one.visible, other.visible)
        assert np.array_equal(one.view.eye_W, other.view.eye_W)
        assert (one.lettering, one.close_on_right) == (other.lettering, other.close_on_right)
    assert np.array_equal(again.film.close_eyes_W, script.film.close_eyes_W)
    assert again.still.close_eyes_W is None


def test_lettering_leaves_the_rest_of_the_image_alone() -> None:
    image = np.full((480, 854, 3), 120, dtype=np.uint8)
    legend = [LegendEntry("passive", "#56b4e9", "circle"), LegendEntry("odd", "#1f2328", "x")]
    drawn = lettered(image, "0:07 min", legend)
    assert np.array_equal(drawn[:420], image[:420])
    assert np.any(drawn[430:, :200] != 120)
    assert np.any(drawn[430:, 600:] != 120)
    assert np.array_equal(lettered(image, "", []), image)


def test_a_png_is_within_two_levels_of_its_image(tmp_path) -> None:
    image = np.arange(256, dtype=np.uint8).repeat(3).reshape(16, 16, 3)
    file = tmp_path / "image.png"
    file.write_bytes(png_of(image))
    assert np.abs(np.asarray(Image.open(file)).astype(int) - image).max() <= 2
