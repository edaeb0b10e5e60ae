"""What the figures show is what the log and the result hold."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from example_flights import Flight, spoil
from modes import TABLE, Mode
from report_pages import Reported, decoded, trace

from inspect_cli.records import Estimate, InvalidReason, Reference, State
from inspect_cli.reporting.content.read_points import read_points
from inspect_cli.reporting.figures.rows import attitude_difference_mrad, held_at, roll_pitch_yaw_deg
from inspect_cli.reporting.figures.timeline import BUCKETS, thinned, timeline_of
from inspect_cli.reporting.flight.scene import patch_mesh
from inspect_cli.reporting.half_cell.potential_scale import (
    colour_scale,
    colours,
    potential_range,
    potentials_of,
)
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.spatial.rotations import matrix_to_quaternion, roll_pitch_yaw_matrix

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]


def test_thinning_keeps_every_peak_and_every_gap() -> None:
    rng = np.random.default_rng(0)
    t_s = np.arange(50_000) / 100.0
    values = rng.standard_normal(50_000)
    values[31_234] = 99.0
    values[20_000:20_500] = np.nan
    kept_s, kept = thinned(t_s, values)
    assert len(kept) <= 2 * BUCKETS
    assert np.all(np.diff(kept_s) > 0.0)
    assert np.nanmax(kept) == 99.0
    assert np.nanmin(kept) == np.nanmin(values)
    assert np.isnan(kept[(kept_s > 200.7) & (kept_s < 204.3)]).all()
    # Every kept sample is a sample of the series, at its own time.
    assert np.array_equal(kept, values[np.round(kept_s * 100.0).astype(int)], equal_nan=True)
    short = thinned(t_s[:100], values[:100])
    assert np.array_equal(short[1], values[:100])


def test_phases_are_the_presses(fly: Fly) -> None:
    flight = fly(1, 3)
    phases = timeline_of(flight.rows(Reference), flight.plan, TABLE).phases
    assert [phase.label for phase in phases] == ["1", "2", "3"]
    for phase in phases:
        assert phase.end_s - phase.start_s == pytest.approx(4.5, abs=0.011)
    # A log that is cut in the middle of a contact still shades it, up to its end.
    flight.cut_at(phases[1].start_s + 1.0)
    last = timeline_of(flight.rows(Reference), flight.plan, TABLE).phases[-1]
    assert last.label == "2"
    assert last.end_s == flight.rows(Reference)["t_s"][-1]


def test_attitudes_as_angles() -> None:
    angles = np.radians([[10.0, -20.0, 170.0], [11.0, -21.0, 190.0], [0.0, 0.0, 200.0]])
    q = np.array([matrix_to_quaternion(roll_pitch_yaw_matrix(*a)) for a in angles])
    assert roll_pitch_yaw_deg(q) == pytest.approx(np.degrees(angles), abs=1e-9)
    spoiled = np.vstack([q, np.full((1, 4), np.nan), np.zeros((1, 4))])
    assert np.isnan(roll_pitch_yaw_deg(spoiled)[3:]).all()
    # A turn of 3 mrad about the body's own z after any attitude.
    step = np.array([np.cos(0.0015), 0.0, 0.0, np.sin(0.0015)])
    w, x, y, z = q.T
    c, s = step[0], step[3]
    turned = np.column_stack([w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s])
    difference = attitude_difference_mrad(q, turned)
    assert difference == pytest.approx(np.tile([0.0, 0.0, 3.0], (3, 1)), abs=1e-6)


def test_axes_are_scaled_to_the_flight_off_the_ground(fly: Fly, report: Report) -> None:
    flight = fly(1, 1)
    state, mode = flight.rows(State), flight.rows(Reference)["mode"]
    state["wrench_ext_B"][mode == Mode.IDLE, 2] = 46.6
    flight.rows(Estimate)["wrench_B"][mode == Mode.LANDED, 2] = np.inf
    low, high = report(flight).page.figures["wrench-force"]["layout"]["yaxis3"]["range"]
    assert -2.0 < low < high < 2.0


def test_rows_are_held_until_the_next() -> None:
    rows = np.array([(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)], [("t_s", "<f8"), ("value", "<f8")])
    held = held_at(rows, np.array([-1.0, 0.0, 0.9, 1.0, 5.0]))
    assert held["value"].tolist() == [1.0, 1.0, 1.0, 2.0, 3.0]


def test_felt_force_is_along_the_planned_normal(fly: Fly, report: Report) -> None:
    flight = fly(1, 1)
    estimate, reference = flight.rows(Estimate), flight.rows(Reference)
    estimate["q_WB"] = [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]  # x_B points along y_W
    estimate["wrench_B"] = [1.0, 2.5, 0.0, 0.0, 0.0, 0.0]  # so 2.5 N along y_B are −x_W's
    force = report(flight).page.figures["force"]
    line = trace(force, "estimate")
    felt, row = decoded(line["y"]), np.round(decoded(line["x"]) * 100.0).astype(int)
    near = np.isin(reference["mode"][row], (Mode.APPROACH, Mode.PRESS, Mode.RETREAT))
    assert 0 < np.count_nonzero(near) < len(near)
    assert felt[near] == pytest.approx(2.5, abs=1e-6)
    assert np.isnan(felt[~near]).all()


def test_lines_hold_the_log(fly: Fly, report: Report) -> None:
    flight = fly(1, 1)
    state, reference = flight.rows(State), flight.rows(Reference)
    figures = report(flight).page.figures
    true = [t for t in figures["position"]["data"] if t["name"] == "truth"]
    for k in range(3):
        row = np.round(decoded(true[k]["x"]) * 100.0).astype(int)
        assert decoded(true[k]["y"]) == pytest.approx(state["p_WB"][row, k], abs=1e-6)
        assert decoded(true[k]["y"]).max() == pytest.approx(state["p_WB"][:, k].max())
    error = trace(figures["position-error"], "truth − reference")
    row = np.round(decoded(error["x"]) * 100.0).astype(int)
    wanted = 1e3 * (state["p_WB"][row, 0] - reference["p_WB"][row, 0])
    assert decoded(error["y"]) == pytest.approx(wanted, abs=1e-3)


def test_an_invalid_point_is_a_cross_without_value(fly: Fly, report: Report) -> None:
    flight = fly(3, 3)
    spoil(flight, 4, InvalidReason.FORCE)
    reported = report(flight)
    figure = reported.page.figures["map-1"]
    cross = trace(figure, "invalid reading")
    assert (cross["x"], cross["y"]) == ([0.0], [0.0])
    assert "force" in cross["customdata"][0]
    valid = [t for t in figure["data"] if "ASTM" in t.get("name", "")]
    assert sum(len(t["x"]) for t in valid) == 8
    assert len(reported.page.figures["cumulative-1"]["data"][0]["x"]) == 8


@pytest.mark.parametrize(
    ("rows", "columns", "drawn"), [(1, 9, False), (4, 1, False), (2, 2, False), (3, 4, True)]
)
def test_a_map_needs_an_area_with_readings(
    fly: Fly, report: Report, rows: int, columns: int, drawn: bool
) -> None:
    page = report(fly(rows, columns)).page
    data = page.figures["map-1"]["data"]
    assert any(t["type"] == "contour" for t in data) == drawn
    assert ("No contours are drawn: " in page.text) != drawn
    assert ("error-1" in page.figures) == drawn


def test_cumulative_frequency_has_the_standards_plotting_position(fly: Fly, report: Report) -> None:
    reported = report(fly(1, 3))
    line = reported.page.figures["cumulative-1"]["data"][0]
    # Quartiles of the normal distribution: 1/4, 2/4, 3/4.
    assert line["x"] == pytest.approx([-0.67449, 0.0, 0.67449], abs=1e-5)
    values = [p.potential_mv for p in reported.result.points]
    assert line["y"] == pytest.approx(sorted(values, reverse=True), abs=1e-6)


def test_colours_change_where_the_class_changes(fly: Fly) -> None:
    scale = colour_scale(-550.0, 0.0)
    shares = [share for share, _ in scale]
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert shares[-1] == 1.0
    steps = [b for a, b in pairwise(shares) if a == b]
    assert steps == pytest.approx([200.0 / 550.0, 350.0 / 550.0])


def test_markers_take_their_colour_from_the_scale(fly: Fly, report: Report) -> None:
    reported = report(fly())
    points = read_points(reported.result, reported.flight.plan)
    mv = potentials_of(points)
    found = colours(mv, potential_range(mv))
    assert len(found) == 9
    assert found[1] != found[8]
    red = {k: int(colour[1:3], 16) for k, colour in enumerate(found)}
    blue = {k: int(colour[5:7], 16) for k, colour in enumerate(found)}
    active = [k for k, p in enumerate(points) if p.point.astm_class == "active"]
    assert active == [1, 2]
    assert all((red[k] > blue[k]) == (k in active) for k in range(9))


def test_meshes_lie_on_their_surface() -> None:
    cylinder = {
        "kind": "cylinder",
        "center_m": [1, 2, 3],
        "axis": [0, 0, 1],
        "radius_m": 0.5,
        "facing": [-1, 0, 0],
        "size_m": [0.7, 2.0],
    }
    sphere = {
        "kind": "sphere",
        "center_m": [0, 0, 1],
        "radius_m": 2.0,
        "facing": [1, 0, 0],
        "size_m": [1.0, 1.0],
    }
    for shape, distance in ((cylinder, 0.5), (sphere, 2.0)):
        data = {"name": "patch", "shape": shape, "source": "test"}
        surface = PlannedSurface.model_validate_json(json.dumps(data))
        mesh = patch_mesh(surface)
        arm = mesh - np.array(shape["center_m"])
        if shape["kind"] == "cylinder":
            assert np.ptp(arm[:, :, 2]) == pytest.approx(2.0)
            arm = arm[:, :, :2]
        assert np.linalg.norm(arm, axis=2) == pytest.approx(distance)


def test_error_axes_ignore_the_ground_and_what_follows_it(fly: Fly, report: Report) -> None:
    flight = fly(1, 1)
    state, mode = flight.rows(State), flight.rows(Reference)["mode"]
    landed = np.flatnonzero(mode == Mode.LANDED)
    state["p_WB"][landed, 2] += 0.15  # it leans on its gear
    mode[landed[-20:]] = Mode.HOVER  # and is told to hover once more
    layout = report(flight).page.figures["position-error"]["layout"]
    assert max(np.abs(layout["yaxis3"]["range"])) < 30.0


def test_labels_are_drawn_over_everything_else(fly: Fly, report: Report) -> None:
    flight = fly(3, 3)
    spoil(flight, 4, InvalidReason.FORCE)
    labels = report(flight).page.figures["map-1"]["data"][-1]
    assert (labels["name"], labels["marker"]["opacity"]) == ("labels", 0)
    assert len(labels["text"]) == 9
