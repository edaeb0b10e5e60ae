"""Drawings: polylines and SVG files become strokes of smooth pieces at the right place and size."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from inspect_cli.errors import GeometryError, InputError
from inspect_cli.schema.tasks.trace import Trace
from inspect_cli.spatial.arrays import Points
from inspect_cli.structure.drawings import SAMPLE_M, Stroke, strokes_of

Draw = Callable[..., tuple[Stroke, ...]]
WIDTH_M = 0.4


@pytest.fixture
def draw(tmp_path: Path) -> Draw:
    """``draw('<path d="…"/>', width_m=0.4, at_m=(0, 0))``."""

    def strokes(
        inner: str, width_m: float = WIDTH_M, at_m: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[Stroke, ...]:
        text = f'<svg xmlns="http://www.w3.org/2000/svg">{inner}</svg>'
        (tmp_path / "d.svg").write_text(text)
        return strokes_of(Trace(on="wall", svg="d.svg", width_m=width_m, at_m=at_m), tmp_path)

    return strokes


def path(d: str) -> str:
    return f'<path d="{d}"/>'


def length_m(*strokes: Stroke) -> float:
    pieces = [piece for stroke in strokes for piece in stroke]
    return float(sum(np.linalg.norm(np.diff(p, axis=0), axis=1).sum() for p in pieces))


def box(*strokes: Stroke) -> tuple[Points, Points]:
    points = np.concatenate([piece for stroke in strokes for piece in stroke])
    return points.min(axis=0), points.max(axis=0)


def test_a_polyline_is_its_edges_from_its_origin(tmp_path: Path) -> None:
    corners = ((0.0, 0.0), (0.3, 0.0), (0.3, 0.0), (0.3, 0.2))
    trace = Trace(on="wall", polyline_m=corners, at_m=(1.0, -0.5))
    (stroke,) = strokes_of(trace, tmp_path)
    np.testing.assert_allclose(stroke[0], [[1.0, -0.5], [1.3, -0.5]])
    np.testing.assert_allclose(stroke[1], [[1.3, -0.5], [1.3, -0.3]])
    assert len(stroke) == 2


def test_y_runs_up_and_the_middle_lies_at_its_place(draw: Draw) -> None:
    """Down the page, then right: down the wall, then along u."""
    (stroke,) = draw(path("M 10 10 L 10 30 L 50 30"), at_m=(0.1, 0.2))
    np.testing.assert_allclose(stroke[0], [[-0.1, 0.3], [-0.1, 0.1]], atol=1e-12)
    np.testing.assert_allclose(stroke[1], [[-0.1, 0.1], [0.3, 0.1]], atol=1e-12)


def test_transforms_of_groups_and_paths_are_applied(draw: Draw) -> None:
    turned = '<g transform="translate(7, 3) rotate(90)"><g transform="scale(2)">{}</g></g>'
    (stroke,) = draw(turned.format(path("M 0 0 L 0 10 L 5 10")))
    # (x, y) → (7 − 2y, 3 + 2x): to the left by 20, then down the page by 10.
    np.testing.assert_allclose(stroke[0], [[0.2, 0.1], [-0.2, 0.1]], atol=1e-12)
    np.testing.assert_allclose(stroke[1], [[-0.2, 0.1], [-0.2, -0.1]], atol=1e-12)


def test_a_circle_is_one_smooth_closed_piece(draw: Draw) -> None:
    (stroke,) = draw('<circle cx="5" cy="7" r="3"/>')
    (piece,) = stroke
    np.testing.assert_allclose(np.linalg.norm(piece, axis=1), 0.2, rtol=1e-4)
    np.testing.assert_allclose(piece[0], piece[-1], atol=1e-9)
    # The extent is that of 257 samples of each half: within (π/256)²/2 of the diameter.
    assert length_m(stroke) == pytest.approx(np.pi * WIDTH_M, rel=1e-4)
    steps = np.linalg.norm(np.diff(piece, axis=0), axis=1)
    assert steps.max() <= SAMPLE_M * 1.01
    assert np.ptp(steps) < 0.02 * SAMPLE_M


def test_an_arc_and_a_bezier_are_on_their_curves(draw: Draw) -> None:
    (half,) = draw(path("M 0 0 A 5 5 0 0 1 10 0"))
    assert length_m(half) == pytest.approx(0.5 * np.pi * WIDTH_M, rel=1e-4)
    (curve,) = draw(path("M 0 0 Q 5 10 10 0"))
    (piece,) = curve
    x = (piece[:, 0] + 0.2) / 0.4  # the parabola y = 2 · 10 t (1 − t), upside down
    np.testing.assert_allclose(piece[:, 1] - piece[0, 1], -0.04 * 20 * x * (1 - x), atol=1e-9)


@pytest.mark.parametrize(
    ("d", "pieces"),
    [
        ("M 0 0 H 10 V 10 H 0 Z", 4),
        ("M 0 0 H 10 A 5 5 0 0 1 10 10 H 0", 1),
        ("M 0 0 L 10 0 L 20 1", 1),
        ("M 0 0 L 10 0 L 20 4", 2),
        ("M 0 0 L 10 0 L 0 0", 2),
        ("M 0 0 C 0 0 5 0 10 0 C 10 0 10 5 10 10", 2),
        ("M 0 0 C 0 0 5 0 10 0 C 10 0 15 0 20 0", 1),
    ],
)
def test_pieces_end_at_corners_alone(draw: Draw, d: str, pieces: int) -> None:
    """A line that turns by less than 10° is smooth; handles of no length have a direction, too."""
    (stroke,) = draw(path(d))
    assert len(stroke) == pieces
    for before, after in pairwise(stroke):
        np.testing.assert_allclose(before[-1], after[0], atol=1e-12)


def test_every_subpath_is_a_stroke(draw: Draw) -> None:
    strokes = draw(path("M 0 0 H 10 M 0 5 H 10 M 2 7 V 9") + '<rect width="4" height="4"/>')
    assert [len(stroke) for stroke in strokes] == [1, 1, 1, 4]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("width_m", [0.8, 1.6])
def test_scaling_preserves_the_shares_of_arc_length(draw: Draw, seed: int, width_m: float) -> None:
    """The length of random curves, by an integral of their own, scales like their width."""
    rng = np.random.default_rng(seed)
    handles = rng.uniform(0.0, 100.0, (3, 4, 2))
    d = " ".join(
        f"M {a[0]} {a[1]} C {b[0]} {b[1]} {c[0]} {c[1]} {e[0]} {e[1]}" for a, b, c, e in handles
    )
    t = np.linspace(0.0, 1.0, 20001)[:, None]
    curves = [
        (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * e
        for a, b, c, e in handles
    ]
    x = np.concatenate(curves)[:, 0]
    expected = sum(np.linalg.norm(np.diff(c, axis=0), axis=1).sum() for c in curves)
    strokes = draw(path(d), width_m=width_m)
    low, high = box(*strokes)
    assert high[0] - low[0] == pytest.approx(width_m, rel=1e-3)
    # Chords of 2 mm are shorter than the arcs by (2 mm κ)²/24: 1e-3 at bends of 13 mm radius.
    assert length_m(*strokes) == pytest.approx(expected * width_m / np.ptp(x), rel=1e-3)


BOMB = "".join(
    f'<!ENTITY a{k} "{"&a" + str(k - 1) + ";" if k else "x"}{f"&a{k - 1};" * 9 if k else ""}">'
    for k in range(10)
)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("<svg", "no SVG that can be read"),
        ("hello", "no SVG that can be read"),
        ("", "the file is empty"),
        ("<svg/>", "there is no line in it"),
        ("{}", "there is no line in it"),
        ("{<text>words</text>}", "there is no line in it"),
        ('{<path d="M 0 0 Z"/>}', "there is no line in it"),
        ('{<path d="M 0 0 L 1"/>}', "no SVG that can be read"),
        ('{<path d="M 0 0 A 5 5 0 0 1 0 0"/>}', "no SVG that can be read"),
        ("{<circle/>}", "no SVG that can be read"),
        ('{<g transform="foo(5)"><path d="M 0 0 L 1 1"/></g>}', "no SVG that can be read"),
        ('{<path d="M 0 0 V 10"/>}', "no width to scale"),
        ('{<path d="M 0 0 H 1e300 V 1e300"/>}', "too large"),
        ('{<path d="M 0 0 h 0.001 M 100 100 h 0.001"/>}', "no line in it is longer"),
        (f"<!DOCTYPE r [{BOMB}]><svg><text>&a9;</text></svg>", "no SVG that can be read"),
        (
            '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/hostname">]>'
            '<svg xmlns="http://www.w3.org/2000/svg"><path d="&x;"/></svg>',
            "no SVG that can be read",
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused_with_its_file(
    tmp_path: Path, text: str, what: str
) -> None:
    if text.startswith("{"):
        text = f'<svg xmlns="http://www.w3.org/2000/svg">{text[1:-1]}</svg>'
    (tmp_path / "d.svg").write_text(text)
    with pytest.raises(GeometryError) as caught:
        strokes_of(Trace(on="wall", svg="d.svg", width_m=0.4), tmp_path)
    (problem,) = caught.value.problems
    assert what in problem.what
    assert problem.hint
    assert problem.where is not None
    assert problem.where.file == str(tmp_path / "d.svg")


def test_more_than_can_be_flown_is_refused(draw: Draw) -> None:
    zigzag = " ".join(f"L {k % 2} {k * 0.01}" for k in range(1, 200))
    with pytest.raises(GeometryError, match="longer than 20 m"):
        draw(path(f"M 0 0 {zigzag}"), width_m=0.4)
    specks = " ".join(f"L {k} {k}" for k in range(10_002))
    with pytest.raises(GeometryError, match="at most 10000"):
        draw(path(f"M 0 0 {specks}"))


def test_a_cusp_within_a_curve_is_drawn(draw: Draw) -> None:
    (stroke,) = draw(path("M 0 0 C 10 10 0 10 10 0"))
    assert np.isfinite(stroke[0]).all()


def test_a_degenerate_arc_is_a_line(draw: Draw) -> None:
    (stroke,) = draw(path("M 0 0 A 0 5 0 0 1 10 0"))
    assert length_m(stroke) == pytest.approx(WIDTH_M)


@pytest.mark.parametrize("name", ["d.png", "gone.svg"])
def test_another_file_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "d.png").write_bytes(b"\x89PNG")
    with pytest.raises(GeometryError):
        strokes_of(Trace(on="wall", svg=name, width_m=0.4), tmp_path)


def test_a_file_outside_of_the_campaign_is_refused(tmp_path: Path) -> None:
    (tmp_path / "campaign").mkdir()
    with pytest.raises(InputError, match="outside"):
        strokes_of(Trace(on="wall", svg="../d.svg", width_m=0.4), tmp_path / "campaign")
