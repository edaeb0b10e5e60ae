"""Verdicts against the truth: areas by Monte Carlo, sites by hand, and what cannot be scored."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from rasters import disc, grid, judged_truly, point, raster_of
from synthetic import SyntheticFlight, nine_points

from inspect_cli.errors import LogError
from inspect_cli.log.names import SPECIMEN
from inspect_cli.log.rasters import encoded
from inspect_cli.metrics.assessed import assess_points
from inspect_cli.metrics.catalogue_scoring import SCORES, metrics_of
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.flight import NotMeasured
from inspect_cli.metrics.planned_cells import PlannedCells, planned_cells
from inspect_cli.metrics.readings import scorer
from inspect_cli.metrics.sample_areas import cells_around, in_squares, nearest_to, weighed
from inspect_cli.metrics.survey import joined_result
from inspect_cli.metrics.truth_scoring import Judged, score, score_surface
from inspect_cli.planning.planner import make_plan
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.scoring import UNREAD, Scoring
from inspect_cli.schema.vehicle import HalfCellModel, TiltRotorPlatform
from inspect_cli.vehicles.tilt_rotor import TiltRotor

STEP_M = 0.005


def square(points: Sequence[PointResult], edge_m: float | None) -> PlannedCells:
    """A plan's cells that are squares."""
    return {point.label: edge_m and (edge_m, edge_m) for point in points}


@pytest.mark.parametrize("pitch_m", [0.1, 0.2, 0.25])
@pytest.mark.parametrize("middle", [(0.013, 0.007), (0.137, -0.061), (-0.31, 0.2)])
def test_areas_of_a_disc_are_those_of_a_monte_carlo(
    pitch_m: float, middle: tuple[float, float]
) -> None:
    """A million darts on the wall, each judged by the nearest point; no code is shared.

    The darts leave 3 σ = 3 √(A (2 − A) / 10⁶) < 0.002 m² and a raster of 5 mm the ring of half a
    cell around a disc of 0.3 m radius, 2π · 0.3 · 0.0025 / √12 < 0.0015 m².
    """
    truth = disc(*middle, 0.3)
    uv = grid(round(2.0 / pitch_m), round(1.0 / pitch_m), pitch_m)
    raster = raster_of(truth, step_m=STEP_M)
    scored = score_surface(judged_truly(uv, truth), cells_around(uv, pitch_m, raster), raster)
    rng = np.random.default_rng(20)
    darts = rng.uniform([-1.0, -0.5], [1.0, 0.5], (1_000_000, 2))
    half = 0.5 * pitch_m
    near = np.round((darts - uv[0]) / pitch_m) * pitch_m + uv[0]
    measured = (np.abs(near[:, 0]) <= 1.0 - half + 1e-9) & (np.abs(near[:, 1]) <= 0.5 - half + 1e-9)
    so, said = truth(*darts.T), truth(*near.T)
    share = 2.0 / len(darts)
    combined = scored.combined
    assert combined.missed_m2 == pytest.approx(share * np.sum(measured & so & ~said), abs=0.0035)
    assert combined.false_m2 == pytest.approx(share * np.sum(measured & ~so & said), abs=0.0035)
    assert combined.active_m2 == pytest.approx(share * np.sum(measured & so), abs=0.0035)
    assert combined.region_m2 == pytest.approx(len(uv) * pitch_m**2, rel=1e-9)
    assert (scored.sites_found, scored.sites_total) == (1, 1)


def test_points_are_counted_by_the_truth_beneath_them() -> None:
    truth = disc(0.0, 0.0, 0.2)
    uv = grid(5, 3, 0.25)
    said = ("none",) * 6 + ("possible", "active", UNREAD) + ("active",) + ("none",) * 5
    judged = Judged(uv, said, ("passive",) * 15)
    raster = raster_of(truth)
    scored = score_surface(judged, cells_around(uv, 0.25, raster), raster)
    rows = {row.verdict: row for row in scored.combined.rows}
    assert list(rows) == ["none", "possible", "active", UNREAD]
    counts = {name: (row.active_points, row.sound_points) for name, row in rows.items()}
    assert counts == {"none": (0, 11), "possible": (0, 1), "active": (1, 1), UNREAD: (0, 1)}
    # The middle point's square of 0.25 m lies in the disc but for its four corners.
    darts = np.random.default_rng(1).uniform(-0.125, 0.125, (400_000, 2))
    found = 0.0625 * np.mean(np.hypot(*darts.T) <= 0.2)
    assert rows["active"].active_m2 == pytest.approx(found, abs=0.0005)
    assert rows["active"].sound_m2 == pytest.approx(2 * 0.0625 - found, abs=0.0005)
    # The class of the potential said that all is passive.
    assert scored.astm.missed_m2 == pytest.approx(scored.astm.active_m2)
    assert scored.astm.false_m2 == 0.0


def test_nothing_and_everything_active() -> None:
    uv = grid(8, 4, 0.25)
    for everywhere in (False, True):
        raster = raster_of(lambda u, v, so=everywhere: np.full_like(u, so, bool))
        judged = judged_truly(uv, lambda u, v, so=everywhere: np.full_like(u, so, bool))
        surface = score_surface(judged, cells_around(uv, 0.25, raster), raster)
        found = metrics_of(Scoring(surfaces=(surface,)))
        assert found["scoring.region_area_m2"].value == pytest.approx(2.0)
        assert found["scoring.missed_area_m2"].value == 0.0
        assert found["scoring.false_area_m2"].value == 0.0
        assert found["scoring.sites_total"].value == float(everywhere)
        share = found["scoring.detected_share"]
        assert share.value == (1.0 if everywhere else None)
        if not everywhere:
            assert "nothing is truly active" in share.why
    assert set(found) == set(SCORES)


def test_where_the_specimen_knows_nothing_nothing_is_scored() -> None:
    uv = grid(8, 4, 0.25)
    truth = disc(0.5, 0.0, 0.2)
    raster = raster_of(truth)
    raster.potential_v[:, raster.u_m < 0.0] = np.nan
    surface = score_surface(judged_truly(uv, truth), cells_around(uv, 0.25, raster), raster)
    assert surface.combined.region_m2 == pytest.approx(1.0)
    assert sum(row.active_points + row.sound_points for row in surface.combined.rows) == 16
    raster.potential_v[:] = np.nan
    points = [point(0, (0.0, 0.0), "none")]
    with pytest.raises(NotMeasured, match="where points were planned"):
        score(points, [raster], square(points, 0.25))


def test_a_single_reading() -> None:
    raster = raster_of(disc(0.3, 0.1, 0.1))
    points = [point(0, (0.3, 0.1), "active")]
    scored = score(points, [raster], square(points, 0.25))
    combined = scored.confusion()
    assert combined.region_m2 == pytest.approx(0.0625)
    assert combined.active_m2 == pytest.approx(np.pi * 0.01, rel=0.01)
    assert combined.missed_m2 == 0.0
    assert combined.false_m2 == pytest.approx(0.0625 - np.pi * 0.01, rel=0.01)
    assert (scored.sites_found, scored.sites_total) == (1, 1)
    for unknown in (square(points, None), {}):
        with pytest.raises(NotMeasured, match="what area it stands for"):
            score(points, [raster], unknown)


def test_two_surfaces_are_scored_apart_and_summed() -> None:
    left, right = disc(0.0, 0.0, 0.2), disc(0.25, 0.0, 0.1)
    rasters = [raster_of(left, name="left"), raster_of(right, name="right")]
    places = [(float(u), float(v)) for u, v in grid(4, 2, 0.25)]
    points = [point(k, uv, "none", on) for on in ("left", "right") for k, uv in enumerate(places)]
    points.append(point(99, (0.0, 0.0), "active", "floor"))
    scored = score(points, rasters, square(points, 0.25))
    assert [one.surface for one in scored.surfaces] == ["left", "right"]
    assert scored.confusion().region_m2 == pytest.approx(1.0)
    assert scored.confusion().missed_m2 == pytest.approx(np.pi * (0.04 + 0.01), rel=0.01)
    assert scored.confusion().false_m2 == 0.0
    assert (scored.sites_found, scored.sites_total) == (0, 2)


def test_sites_are_counted_where_they_were_measured() -> None:
    """Three discs: one found, one between the points, one beyond the measured region."""
    discs = [disc(-0.625, 0.125, 0.1), disc(0.0, 0.0, 0.08), disc(0.95, 0.45, 0.04)]

    def truth(u, v):
        return discs[0](u, v) | discs[1](u, v) | discs[2](u, v)

    uv = grid(6, 2, 0.25)
    raster = raster_of(truth)
    surface = score_surface(judged_truly(uv, truth), cells_around(uv, 0.25, raster), raster)
    assert (surface.sites_found, surface.sites_total) == (1, 2)


def test_places_that_touch_by_a_corner_are_one_site() -> None:
    """Two squares of 0.2 m with one corner in common, and one that stands 5 mm from it."""

    def squares(u, v):
        inside = (np.abs(u) < 0.2) & (np.abs(v) < 0.2)
        return inside & (u * v > 0.0)

    uv = grid(8, 4, 0.25)
    for gap_m, sites in ((0.0, 1), (STEP_M, 2)):
        raster = raster_of(lambda u, v, gap=gap_m: squares(u, v) & ~((u > 0.0) & (u < gap)))
        surface = score_surface(judged_truly(uv, squares), cells_around(uv, 0.25, raster), raster)
        assert surface.sites_total == sites


@pytest.mark.parametrize("combined", ["active", "possible"])
def test_a_site_is_found_by_the_combined_verdict(combined: str) -> None:
    """However the potential alone is classed; the areas of both rules are told apart."""
    truth = disc(0.0, 0.0, 0.1)
    raster = raster_of(truth)
    uv = grid(3, 1, 0.25)
    other = "active" if combined == "possible" else "uncertain"
    judged = Judged(uv, ("none", combined, "none"), ("passive", other, "passive"))
    surface = score_surface(judged, cells_around(uv, 0.25, raster), raster)
    assert (surface.sites_total, surface.sites_found) == (1, int(combined == "active"))
    found = surface.combined if combined == "active" else surface.astm
    assert found.missed_m2 == 0.0


def test_too_resistive_is_what_the_rule_cannot_call_active() -> None:
    """A disc of 0.3 m radius in 60 Ω·m but for u > 0: 100 Ω·m is not too much, 100.1 is."""
    truth = disc(0.0, 0.0, 0.3)
    uv = grid(8, 4, 0.25)
    for ohm_m, share in ((100.0, 0.0), (100.1, 0.5), (np.nan, 0.5)):
        raster = raster_of(truth)
        raster.resistivity_ohm_m[:, raster.u_m > 0.0] = ohm_m
        surface = score_surface(judged_truly(uv, truth), cells_around(uv, 0.25, raster), raster)
        assert surface.too_resistive_m2 == pytest.approx(share * np.pi * 0.09, rel=0.01)
        found = metrics_of(Scoring(surfaces=(surface,)))
        assert found["scoring.too_resistive_area_m2"].value == surface.too_resistive_m2
        assert found["scoring.too_resistive_share"].value == pytest.approx(share, rel=0.01)
        # The sound concrete has 220 Ω·m, and it is not counted.
        assert surface.combined.region_m2 == pytest.approx(2.0)


def test_squares_reach_half_a_pitch() -> None:
    raster = raster_of(disc(0.0, 0.0, 0.1))
    alone = np.array([[0.0, 0.0]])
    places = np.array([[0.1, 0.0], [0.101, 0.0], [-0.1, 0.1], [0.0, -0.101]])
    assert in_squares(places, alone, 0.2, raster).tolist() == [True, False, True, False]
    # Two points 0.15 m apart, each with a square of 0.2 m: together 0.35 m by 0.2 m, not more.
    cells = cells_around(np.array([[0.0, 0.0], [0.15, 0.0]]), 0.2, raster)
    assert cells.area_m2.sum() == pytest.approx(0.07, rel=0.02)


def test_points_of_two_pitches_stand_for_their_own_cells() -> None:
    """A square of 0.05 m in the middle of one of 0.25 m shares it: its point is nearer up to half
    way, so that both together are the large one. An oblong cell keeps its two widths."""
    raster = raster_of(disc(0.0, 0.0, 0.1))
    uv = np.array([[0.0, 0.0], [0.0625, 0.0], [0.5, 0.0]])
    widths = np.array([[0.25, 0.25], [0.05, 0.05], [0.1, 0.2]])
    cells = cells_around(uv, widths, raster)
    areas = weighed(cells.owner, cells.area_m2, 3)
    # The bisector lies at u = 0.03125, the small square begins at 0.0375: it keeps all of it.
    assert areas[1] == pytest.approx(0.05**2, rel=1e-9)
    assert areas[0] == pytest.approx(0.25**2 - 0.05**2, rel=0.01)
    assert areas[2] == pytest.approx(0.1 * 0.2, rel=1e-9)
    # Points that crowd around a coarse one leave it the rest of its square.
    fine = grid(9, 9, 0.02)
    crowd = np.vstack([fine, [[0.0, 0.0101]]])
    widths = np.vstack([np.full((81, 2), 0.02), [[0.5, 0.5]]])
    cells = cells_around(crowd, widths, raster)
    areas = weighed(cells.owner, cells.area_m2, 82)
    assert areas.sum() == pytest.approx(0.25, rel=0.01)
    assert areas[-1] == pytest.approx(0.25 - 0.18**2, abs=0.18 * 2 * 0.5 / 60)


def test_a_coarse_grid_with_readings_beside_a_fine_one_without(
    pitched: Callable[[float], TiltRotorPlatform],
) -> None:
    """Six points at 0.25 m stand for 0.375 m², and what is scored is what is assessed."""
    shape = {"kind": "plane", "center_m": [2, 0, 1.5], "normal": [-1, 0, 0], "size_m": [2, 1]}
    coarse = {"on": "wall", "rows": 2, "columns": 3, "pitch_m": 0.25}
    fine = {"on": "wall", "rows": 5, "columns": 5, "pitch_m": 0.05}
    asked = {
        "name": "two-grids",
        "platform": "tilt_rotor_hexarotor",
        "structure": [{"name": "wall", "surface": {"shape": shape}}],
        "tasks": [{"contact_grid": coarse}, {"contact_grid": fine, "sensor": "none"}],
    }
    mission = Mission.model_validate_json(json.dumps(asked))
    surface = PlannedSurface.model_validate_json(
        json.dumps({"name": "wall", "shape": shape, "source": "given"})
    )
    capabilities = TiltRotor(pitched(90.0)).capabilities
    planned = make_plan(mission, "tilt_rotor_hexarotor", capabilities, (surface,), 20.0)
    read = [target for target in planned.targets if target.sensor]
    points = [point(target.index, target.uv_m, "none") for target in read]
    cells = planned_cells(planned.targets)
    scored = score(points, [raster_of(disc(0.0, 0.0, 0.1))], cells)
    probe = nine_points().platform.sensor(HalfCellModel)
    (found,) = assess_points(points, mission, probe, cells)
    assert found.summary.area_m2 == pytest.approx(0.375, rel=1e-9)
    assert scored.confusion().region_m2 == pytest.approx(0.375, rel=1e-9)


def test_added_points_share_the_area_of_their_neighbours() -> None:
    """A point between two neighbours takes half of each; the region does not grow."""
    raster = raster_of(disc(0.0, 0.0, 0.1))
    uv = np.vstack([grid(4, 2, 0.25), [[0.0, 0.125]]])
    cells = cells_around(uv, 0.25, raster)
    areas = weighed(cells.owner, cells.area_m2, len(uv))
    assert areas.sum() == pytest.approx(0.5, rel=0.01)
    expected = [0.0625] * 9
    expected[5] = expected[6] = 0.75 * 0.0625
    expected[8] = 0.5 * 0.0625
    assert areas == pytest.approx(expected, rel=0.05)
    # Of the points whose squares hold a place, the nearest stands for it.
    away = cells.uv_m[:, None] - uv
    holds = np.abs(away).max(axis=2) <= 0.125 + 1e-9
    apart = np.where(holds, np.linalg.norm(away, axis=2), np.inf)
    assert np.allclose(apart[np.arange(len(cells.owner)), cells.owner], apart.min(axis=1))


def test_cells_end_at_the_edge_and_lead_around_a_closed_surface() -> None:
    flat = raster_of(disc(0.0, 0.0, 0.1))
    at_the_edge = np.array([[1.0, 0.0]])
    cells = cells_around(at_the_edge, 0.2, flat)
    assert len(cells.owner) * cells.area_m2 == pytest.approx(0.02, rel=0.05)
    closed = raster_of(lambda u, v: np.abs(u) > 0.9, turn_m=2.0)
    cells = cells_around(at_the_edge, 0.2, closed)
    assert len(cells.owner) * cells.area_m2 == pytest.approx(0.04)
    surface = score_surface(Judged(at_the_edge, ("active",), ("active",)), cells, closed)
    assert surface.combined.active_m2 == pytest.approx(0.04)
    # Both sides of the seam are one site.
    assert (surface.sites_found, surface.sites_total) == (1, 1)


def test_squares_on_a_sphere_are_as_wide_as_on_the_equator() -> None:
    """At 60° of latitude a metre of u is half a metre along the surface."""
    radius_m = 1.0
    latitude_m = np.pi / 3 * radius_m
    raster = raster_of(disc(0.0, 0.0, 0.1), (3.0, 3.0), 0.02, radius_m=radius_m)
    cells = cells_around(np.array([[0.0, latitude_m]]), 0.1, raster)
    assert len(cells.owner) * cells.area_m2 == pytest.approx(0.01)
    assert np.abs(cells.uv_m[:, 0]).max() == pytest.approx(0.1, rel=0.15)


def test_a_region_can_be_shared_among_other_points() -> None:
    raster = raster_of(disc(0.0, 0.0, 0.1))
    region = cells_around(grid(8, 4, 0.25), 0.25, raster)
    halves = nearest_to(region, np.array([[-0.5, 0.0], [0.5, 0.0]]), raster)
    assert weighed(halves.owner, halves.area_m2, 2) == pytest.approx([1.0, 1.0])
    none = nearest_to(region, np.empty((0, 2)), raster)
    surface = score_surface(Judged(np.empty((0, 2)), (), ()), none, raster)
    assert surface.combined.missed_m2 == pytest.approx(surface.combined.active_m2)
    assert surface.combined.active_m2 == pytest.approx(np.pi * 0.01, rel=0.01)


@pytest.fixture
def flight() -> SyntheticFlight:
    """Nine points, of which two were judged active, over a disc around the two."""
    made = nine_points()
    uv = [target.uv_m for target in made.plan.targets]
    assert None not in uv
    middle = np.mean([uv[1], uv[2]], axis=0)
    surface = made.plan.targets[0].surface
    raster = raster_of(disc(*middle, 0.05), step_m=0.0025, name=surface)
    made.attachments = {SPECIMEN: encoded([raster])}
    return made


def test_a_flight_is_scored_from_its_log(flight: SyntheticFlight) -> None:
    result = evaluate(flight.log())
    assert result.scoring is not None
    value = {name: result.metrics[name].value for name in SCORES}
    assert value["scoring.region_area_m2"] == pytest.approx(9 * 0.0025)
    # Squares of 5 cm: the disc has 10 cm across, two squares hold the strip of 10 cm by 5 cm of it.
    h = 0.025
    strip = 2 * (h * np.sqrt(0.05**2 - h**2) + 0.05**2 * np.arcsin(h / 0.05))
    assert value["scoring.active_area_m2"] == pytest.approx(strip, rel=0.01)
    assert value["scoring.missed_area_m2"] == pytest.approx(0.0, abs=1e-5)
    assert value["scoring.false_area_m2"] == pytest.approx(2 * 0.0025 - strip, rel=0.1)
    assert value["scoring.detected_share"] == pytest.approx(1.0, abs=1e-3)
    assert value["scoring.sites_found"] == value["scoring.sites_total"] == 1.0
    again = type(result).model_validate_json(result.model_dump_json(by_alias=True))
    assert again.scoring == result.scoring


def test_a_log_without_a_raster_is_not_scored(flight: SyntheticFlight) -> None:
    flight.attachments = {}
    result = evaluate(flight.log())
    assert result.scoring is None
    for name in SCORES:
        assert result.metrics[name].value is None
        assert "truly so beneath" in result.metrics[name].why


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04 no archive", b"x" * 100])
def test_a_damaged_raster_is_refused(flight: SyntheticFlight, data: bytes) -> None:
    flight.attachments = {SPECIMEN: data}
    with pytest.raises(LogError, match=r"specimen\.npz' cannot be read"):
        evaluate(flight.log())


def test_rasters_come_back_and_always_as_the_same_bytes(flight: SyntheticFlight) -> None:
    one, other = raster_of(disc(0.0, 0.0, 0.1)), raster_of(disc(0.1, 0.0, 0.1), name="b/c")
    one.potential_v[0, 0] = np.nan
    data = encoded([one, other])
    assert data == encoded([one, other])
    flight.attachments = {SPECIMEN: data}
    found = flight.log().true_rasters()
    assert [raster.surface for raster in found] == ["wall", "b/c"]
    for before, after in zip((one, other), found, strict=True):
        for field in dataclasses.fields(before)[1:]:
            a, b = getattr(before, field.name), getattr(after, field.name)
            assert np.allclose(a, b, rtol=1e-6, equal_nan=True), field.name
    broken = dataclasses.replace(one, active=one.active[:-1])
    flight.attachments = {SPECIMEN: encoded([broken])}
    with pytest.raises(LogError, match="do not fit each other"):
        flight.log().true_rasters()


def test_a_survey_is_scored_over_all_points_and_not_flight_by_flight() -> None:
    """Two flights each read half of one site, and the site is one."""
    truth = disc(0.0, 0.0, 0.3)
    raster = raster_of(truth)
    uv = [(float(u), float(v)) for u, v in grid(8, 4, 0.25)]
    points = [point(k, at, "active" if truth(*at) else "none") for k, at in enumerate(uv)]
    flown = evaluate(nine_points().log())
    halves = [
        flown.model_copy(update={"points": tuple(half)}) for half in (points[::2], points[1::2])
    ]
    (target, *_) = nine_points().plan.targets
    targets = [
        target.model_copy(update={"label": one.label, "cell_m": (0.25, 0.25)}) for one in points
    ]
    score_all = scorer([raster], targets)
    joined = joined_result(halves, [], [], 1, score_all)
    assert joined.scoring is not None
    assert joined.metrics["scoring.sites_total"].value == 1.0
    assert joined.metrics["scoring.sites_found"].value == 1.0
    assert joined.metrics["scoring.region_area_m2"].value == pytest.approx(2.0)
    alone = joined_result(halves[:1], [], [], 1, score_all)
    assert alone.metrics["scoring.region_area_m2"].value == pytest.approx(1.0)
    without = joined_result(halves, [], [], 1)
    assert without.scoring is None
    assert without.metrics["scoring.sites_total"].value is None
