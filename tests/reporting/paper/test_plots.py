"""What is drawn on paper is what plotly draws on the screen, and maps are to scale."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_flights import spoil, survey

from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.records import InvalidReason, Reference
from inspect_cli.reporting.content.read_points import read_points
from inspect_cli.reporting.figures.figure import Figure, numbers, words
from inspect_cli.reporting.figures.rows import rows_of
from inspect_cli.reporting.figures.timeline import timeline_of
from inspect_cli.reporting.flight.forces import actuator_figures, force_figures
from inspect_cli.reporting.flight.modes import modes_figure
from inspect_cli.reporting.flight.scene import scene_figure
from inspect_cli.reporting.flight.tracking import tracking_figures
from inspect_cli.reporting.half_cell.cumulative import cumulative_figure
from inspect_cli.reporting.half_cell.error_map import error_figure
from inspect_cli.reporting.half_cell.histogram import histogram_figure
from inspect_cli.reporting.half_cell.places import shared_range
from inspect_cli.reporting.half_cell.potential_map import map_figure
from inspect_cli.reporting.half_cell.resistivity import resistivity_figure
from inspect_cli.reporting.half_cell.scene_marks import scene_marks
from inspect_cli.reporting.paper.plot_axes import round_ticks
from inspect_cli.reporting.paper.plot_scale import SCALES, MapScale, scale_for
from inspect_cli.reporting.paper.plot_text import label_lines, rgba
from inspect_cli.reporting.paper.plots import Plot, draw
from inspect_cli.reporting.words.language import Language, language

ENGLISH = language("en")
COMMA = Language("en", ",", {})
PLATFORM = Path(__file__).parents[3] / "platforms" / "tilt_rotor_hexarotor.yaml"
SVG = "{http://www.w3.org/2000/svg}"
MM_PER_PT = 25.4 / 72.0


@pytest.fixture(scope="module")
def figures() -> dict[str, Figure]:
    flight = survey(PLATFORM, 3, 5)
    spoil(flight, 7, InvalidReason.FORCE)
    log = flight.log()
    evaluation = evaluate_with_arrays(log)
    result = evaluation.result
    points = read_points(result, flight.plan)
    (evaluated,) = with_maps(evaluation.assessed)
    timeline = timeline_of(rows_of(log, Reference), flight.plan, log.modes())
    found = [
        map_figure(0, evaluated, shared_range([evaluated]), {}),
        error_figure(0, evaluated),
        cumulative_figure(0, evaluated),
        histogram_figure(0, evaluated),
        resistivity_figure(0, evaluated),
        *tracking_figures(log, timeline),
        *force_figures(log, flight.plan, timeline),
        *actuator_figures(log, timeline),
        modes_figure(log),
        scene_figure(log, flight.plan, [scene_marks(points)]),
    ]
    return {figure.name: figure for figure in found if figure is not None}


def figure_of(*traces: dict[str, Any], **layout: Any) -> Figure:
    return Figure("example", "caption", "description", traces, layout)


def drawn(figure: Figure, language: Language = ENGLISH) -> Plot:
    plot = draw(figure, language, 170.0)
    assert plot is not None
    return plot


def texts(plot: Plot) -> list[str]:
    """The words of a drawing, formulas without their blanks."""
    return ["".join(e.itertext()).strip() for e in ET.fromstring(plot.svg).iter(f"{SVG}text")]


def markers_mm(plot: Plot) -> np.ndarray:
    """Where the markers stand on paper, (n, 2) mm from the upper left corner."""
    groups = ET.fromstring(plot.svg).iter(f"{SVG}g")
    scattered = [g for g in groups if str(g.get("id")).startswith("PathCollection")]
    return MM_PER_PT * np.array([c for group in scattered for c in _centres(group)])


def _centres(group: ET.Element) -> Iterator[Any]:
    """Of markers, be they copies of a shape or shapes of their own."""
    for use in group.iter(f"{SVG}use"):
        yield [float(use.get("x", "")), float(use.get("y", ""))]
    for path in group.findall(f"{SVG}path"):
        xy = np.array([float(n) for n in re.findall(r"-?[\d.]+", path.get("d", ""))]).reshape(-1, 2)
        yield 0.5 * (xy.min(axis=0) + xy.max(axis=0))


def test_every_figure_of_a_flight_can_be_drawn(figures: dict[str, Figure]) -> None:
    for name, figure in figures.items():
        plot = draw(figure, ENGLISH, 170.0)
        if name == "scene":
            assert plot is None
            continue
        assert plot is not None
        root = ET.fromstring(plot.svg)
        assert (
            root.get("width") == f"{plot.width_mm / MM_PER_PT:.6f}".rstrip("0").rstrip(".") + "pt"
        )
        assert float(str(root.get("height"))[:-2]) * MM_PER_PT == pytest.approx(plot.height_mm)


def test_words_of_the_drawing_are_the_figures(figures: dict[str, Figure]) -> None:
    shown = texts(drawn(figures["resistivity-1"]))
    assert "potential (mV CSE)" in shown
    assert "resistivity (Ω·m), log scale" in shown
    assert {"corrosion: none", "corrosion: active"} & set(shown)
    assert "100" in shown
    tracked = texts(drawn(figures["position"]))
    assert {"truth", "estimate", "reference", "x (m)", "y (m)", "z (m)", "time (s)"} <= set(tracked)


def test_the_same_figure_gives_the_same_bytes(figures: dict[str, Figure]) -> None:
    for name in ("map-1", "modes", "force"):
        assert drawn(figures[name]).svg == drawn(figures[name]).svg
    assert b"<dc:date>" not in drawn(figures["force"]).svg


def test_a_map_is_exactly_to_its_scale(figures: dict[str, Figure]) -> None:
    # The points are planned 5 cm apart, five to a row: 0.2 m from the first to the last.
    plot = drawn(figures["map-1"])
    assert plot.scale == MapScale(2.0)
    mm = markers_mm(plot)
    marks = [t["x"] for t in figures["map-1"].traces if t.get("mode") == "markers"]
    assert len(mm) == sum(x is not None for column in marks for x in column) > 15
    assert np.ptp(mm[:, 0]) == pytest.approx(0.2 * 1e3 / 2.0, abs=0.01)
    assert np.ptp(mm[:, 1]) == pytest.approx(0.1 * 1e3 / 2.0, abs=0.01)
    assert "Scale 1 : 2, printed at full size" in texts(plot)


@pytest.mark.parametrize(
    ("width_m", "height_m", "denominator"),
    [
        (0.3, 0.2, 2),
        (0.31, 0.2, 5),
        (3.0, 2.0, 20),
        (3.2, 2.0, 25),
        (12.0, 3.0, 100),
        (900, 5, 10000),
    ],
)
def test_scales_are_round(width_m: float, height_m: float, denominator: float) -> None:
    assert scale_for(width_m, height_m, (150.0, 140.0)) == MapScale(denominator)
    assert {1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000} <= set(SCALES)


def test_side_views_are_to_scale_without_a_given_range() -> None:
    corners = {"x": [0.0, 2.0, 2.0, 0.0], "y": [0.0, 0.0, 1.0, 1.0], "mode": "markers"}
    edge = {"width": 1.2, "color": "#1f2328"}
    trace = {"type": "scatter", **corners, "marker": {"size": 5, "line": edge}}
    plot = drawn(figure_of(trace, yaxis={"scaleanchor": "x"}))
    mm = markers_mm(plot)
    assert plot.scale == MapScale(20.0)
    assert np.ptp(mm, axis=0) == pytest.approx([100.0, 50.0], abs=0.01)


def test_numbers_on_the_axes_have_the_languages_decimal_sign() -> None:
    trace = {"type": "scatter", "mode": "lines", "x": [0.0, 1.0], "y": [-0.5, 0.5]}
    assert "−0.4" in texts(drawn(figure_of(trace)))
    shown = texts(drawn(figure_of(trace), COMMA))
    assert "−0,4" in shown
    assert not any("." in text for text in shown)


def test_curves_stand_where_their_numbers_say() -> None:
    values = np.array([0.0, 10.0, 20.0, 40.0])
    trace = {"type": "scatter", "mode": "lines", "x": numbers(values), "y": numbers(values**2)}
    axes = {"xaxis": {"range": [0.0, 40.0]}, "yaxis": {"range": [0.0, 1600.0]}}
    plot = drawn(figure_of({**trace, "line": {"color": "#123456"}}, **axes))
    paths = ET.fromstring(plot.svg).iter(f"{SVG}path")
    line = next(p for p in paths if "#123456" in str(p.get("style")))
    xy = np.array([float(n) for n in re.findall(r"-?[\d.]+", str(line.get("d")))]).reshape(-1, 2)
    across, up = xy[:, 0] - xy[0, 0], xy[0, 1] - xy[:, 1]
    assert across / across[-1] == pytest.approx(values / 40.0, abs=1e-5)
    assert up / up[-1] == pytest.approx(values**2 / 1600.0, abs=1e-5)


def test_a_gap_stays_a_gap() -> None:
    x, y = [0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 1.0, math.nan, 1.0, 0.0]
    trace = {"type": "scatter", "mode": "lines", "x": numbers(x), "y": numbers(y)}
    plot = drawn(figure_of({**trace, "line": {"color": "#123456"}}))
    paths = ET.fromstring(plot.svg).iter(f"{SVG}path")
    line = next(p for p in paths if "#123456" in str(p.get("style")))
    assert str(line.get("d")).count("M") == 2


@pytest.mark.parametrize(
    "trace",
    [
        {"type": "violin", "y": [1.0]},
        {"type": "scatter", "x": [0.0], "y": [1.0], "mode": "lines+wobble"},
        {"type": "scatter", "x": [0.0], "y": [1.0], "mode": "markers", "marker": {"symbol": "bow"}},
        {"type": "scatter", "x": [0.0], "y": [1.0], "mode": "lines", "line": {"dash": "curly"}},
        {"type": "scatter", "x": [0.0], "y": [1.0], "mode": "lines", "fill": "somewhere"},
        {"type": "contour", "z": [[0.0, 1.0], [1.0, 0.0]], "contours": {"type": "constraint"}},
    ],
)
def test_what_is_not_known_raises(trace: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"on paper|for paper"):
        draw(figure_of(trace), ENGLISH, 170.0)


def test_unknown_shapes_raise() -> None:
    trace = {"type": "scatter", "mode": "lines", "x": [0.0, 1.0], "y": [0.0, 1.0]}
    circle = {"type": "circle", "x0": 0, "x1": 1, "y0": 0, "y1": 1}
    with pytest.raises(ValueError, match="circle"):
        draw(figure_of(trace, shapes=[circle]), ENGLISH, 170.0)


@pytest.mark.parametrize("kind", ["scatter3d", "surface", "mesh3d"])
def test_three_dimensions_stay_on_the_screen(kind: str) -> None:
    assert draw(figure_of({"type": kind}), ENGLISH, 170.0) is None


def test_labels_lose_their_markup_and_keep_their_words() -> None:
    line = label_lines("<b>12</b><br>−345")
    assert [(part.text, part.bold) for part in line] == [("12", True), ("−345", False)]
    (index,) = label_lines("θ<sub>x</sub> (mrad), 5 $")
    assert index.formula
    assert index.text == "θ$_{\\mathrm{x}}$ (mrad), 5 \\$"
    (foreign,) = label_lines(words("<b>&amp; <sub>$x$</sub>\u202e"))
    assert (foreign.text, foreign.bold, foreign.formula) == (
        "<b>&amp; <sub>$x$</sub>\ufffd",
        False,
        False,
    )


def test_any_label_can_be_drawn() -> None:
    evil = [
        "$x^{",
        "\\frac",
        "#panic()",
        "\x00\x1b",
        "\ud800",
        "😀",
        "שלום مرحبا",
        "漢字",
        "<b>&",
        '"',
    ]
    trace = {
        "type": "scatter",
        "mode": "markers+text",
        "name": words("$\\alpha_{$ \x00 \ud800"),
        "x": list(range(len(evil))),
        "y": [0.0] * len(evil),
        "text": [words(text) for text in evil],
    }
    shown = texts(drawn(figure_of(trace, showlegend=True, xaxis={"title": {"text": "$\\"}})))
    assert {"$x^{", "\\frac", "#panic()", "<b>&", "שלום مرحبا", "$\\"} <= set(shown)


def test_colours_of_css() -> None:
    assert rgba("rgba(255, 0, 51, 0.5)") == (1.0, 0.0, 0.2, 0.5)
    assert rgba("#ff0033", 0.5) == (1.0, 0.0, 0.2, 0.5)
    with pytest.raises(ValueError, match="no colour"):
        rgba("no colour")


def test_ticks_are_round_and_within() -> None:
    assert round_ticks(0.03, 0.99, 5) == ([0.2, 0.4, 0.6, 0.8], 1)
    assert round_ticks(-350.0, 100.0, 4) == ([-200.0, 0.0], 0)
    assert round_ticks(0.0, 0.0, 4)[0] == [0.0]


def test_bars_fields_and_colour_bars() -> None:
    energy = [
        {"type": "bar", "name": "planned", "x": ["a", "b"], "y": [3.0, 4.0],
         "marker": {"color": "#59636e", "pattern": {"shape": "/"}}},
        {"type": "bar", "name": "flown", "x": ["a", "b"], "y": [2.0, None],
         "marker": {"color": "#009e73"}},
    ]  # fmt: skip
    shown = texts(drawn(figure_of(*energy, barmode="group")))
    assert {"a", "b", "planned", "flown", "0"} <= set(shown)
    scale = {
        "cmin": -550.0,
        "cmax": 0.0,
        "colorscale": [[0.0, "#000000"], [1.0, "#ffffff"]],
        "colorbar": {"title": {"text": "mV CSE"}, "tickvals": [-550, -350, 0]},
    }
    field = {"type": "heatmap", "x": [0.0, 1.0, 2.0], "y": [0.0, 1.0], "coloraxis": "coloraxis",
             "z": [[-500.0, -300.0, None], [-100.0, -50.0, -10.0]]}  # fmt: skip
    plot = drawn(figure_of(field, coloraxis=scale))
    assert {"mV CSE", "−550", "−350", "0"} <= set(texts(plot))
    assert b"<image" in plot.svg


def test_labels_that_would_cover_each_other_are_left_out() -> None:
    x = np.concatenate([np.full(30, 0.5), [0.0, 1.0]])
    trace = {
        "type": "scatter",
        "mode": "text",
        "x": x.tolist(),
        "y": [0.0] * len(x),
        "text": [f"point {k}" for k in range(len(x))],
    }
    shown = [text for text in texts(drawn(figure_of(trace))) if text.startswith("point")]
    assert shown == ["point 0", "point 30", "point 31"]
