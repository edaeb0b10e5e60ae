"""The section of readings: tables hold the assessment, figures thin honestly, nothing is silent."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from report_pages import Page, decoded, trace
from surveyed_points import points_of, surveyed

from inspect_cli.assessment.electrodes import basis_of
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.pictures.render import Pictures
from inspect_cli.reporting.chapters.pictures import caption, picture_blocks
from inspect_cli.reporting.content.blocks import (
    Block,
    Column,
    Cover,
    Document,
    Figures,
    Film,
    Notes,
    Paragraph,
    Picture,
    Section,
    Table,
)
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.half_cell.basis import temperature_caveats, uncertainty_blocks
from inspect_cli.reporting.half_cell.evaluation import evaluation_blocks
from inspect_cli.reporting.half_cell.map_marks import MOST_MARKERS
from inspect_cli.reporting.half_cell.minima import gradient_blocks
from inspect_cli.reporting.half_cell.point_table import sureness_of
from inspect_cli.reporting.half_cell.readings_text import findings, reading_boxes
from inspect_cli.reporting.paper.plots import draw
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.words.language import language
from inspect_cli.reporting.words.naming import named
from inspect_cli.reporting.words.text import Said
from inspect_cli.schema.scoring import Confusion, ConfusionRow, Rule, Scoring, SurfaceScoring

ENGLISH, GERMAN = language("en"), language("de")
PITCH_M = 0.25


def lattice(columns: int, rows: int) -> np.ndarray:
    u, v = np.meshgrid(PITCH_M * np.arange(columns), PITCH_M * np.arange(rows))
    return np.column_stack([u.ravel(), v.ravel()])


def two_populations(columns: int, rows: int, *, seed: int = 1) -> SurfaceFindings:
    """Passive concrete with a patch of corroding steel in a corner, and a missing reading."""
    uv, rng = lattice(columns, rows), np.random.default_rng(seed)
    patch = (uv[:, 0] < 0.3 * uv[:, 0].max()) & (uv[:, 1] < 0.5 * uv[:, 1].max())
    mv = np.round(np.where(patch, -450.0, -130.0) + rng.normal(0.0, 25.0, len(uv)))
    mv[len(mv) // 2] = np.nan
    rho = np.where(patch, 60.0, 400.0) * np.exp(rng.normal(0.0, 0.2, len(uv)))
    return surveyed(uv, mv, rho)


@pytest.fixture(scope="module")
def deck() -> SurfaceFindings:
    return two_populations(16, 10)


def blocks_of(
    evaluated: SurfaceFindings,
    scoring: Scoring | None = None,
    points: Sequence[ReadPoint] | None = None,
) -> list[Block]:
    given = points_of(evaluated) if points is None else points
    return evaluation_blocks([evaluated], given, scoring)


def table_of(blocks: Sequence[Block], caption: str) -> list[list[str]]:
    """The cells of the table under a caption, in English."""
    found = next(
        b for b in blocks if isinstance(b, Table) and ENGLISH.plain(b.caption).startswith(caption)
    )
    assert all(len(row) == len(found.columns) for row in found.rows)
    return [[ENGLISH.plain(cell) for cell in row] for row in found.rows]


def figures_of(blocks: Sequence[Block]) -> dict[str, Figure]:
    shown = [f for block in blocks if isinstance(block, Figures) for f in block.figures]
    return {figure.name: figure for figure in shown}


def told(blocks: Sequence[Block]) -> str:
    return " ".join(ENGLISH.plain(b.text) for b in blocks if isinstance(b, Paragraph))


def page_of(blocks: Sequence[Block]) -> str:
    cover = Cover("", "deck", "", [])
    return html(Document("deck", cover, [Section("survey", "Survey", blocks)]), ENGLISH)


def as_number(text: str) -> float:
    return float(text.replace("\u2212", "-").replace("\u202f", "").removesuffix(" %"))


def test_tables_of_classes_hold_the_assessment(deck: SurfaceFindings) -> None:
    blocks, summary = blocks_of(deck), deck.assessed.summary
    rows = table_of(blocks, "Classes of ASTM C876")
    for share, row in zip(summary.astm, rows, strict=False):
        assert row[0] == share.name
        assert as_number(row[3]) == share.count
        assert as_number(row[4]) == pytest.approx(100.0 * share.share, abs=0.05)
        assert share.area_m2 is not None
        assert as_number(row[5]) == pytest.approx(share.area_m2, abs=5e-3)
    assert [rows[-1][0], rows[-1][3]] == ["invalid", "1"]
    for share, row in zip(summary.verdicts, table_of(blocks, "Combined verdict"), strict=True):
        shown = "not indicated" if share.name == "none" else share.name
        assert (row[0], as_number(row[1])) == (shown, share.count)
        assert row[4] == "–" or str(share.count - 10) in row[4]
    rates = table_of(blocks, "Classes of resistivity")
    assert [as_number(row[3]) for row in rates] == [s.count for s in summary.rates + summary.risks]
    crossed = table_of(blocks, "Points by potential (ASTM C876) and by the corrosion rate")
    assert [as_number(c) for row in crossed for c in row[1:-1]] == [
        cell.count for cell in summary.astm_by_rate
    ]
    assert [as_number(row[-1]) for row in crossed] == [share.count for share in summary.astm]


def test_tables_of_the_distribution_hold_the_assessment(deck: SurfaceFindings) -> None:
    blocks, summary = blocks_of(deck), deck.assessed.summary
    potential, mixture = summary.potential, summary.mixture
    assert potential is not None
    assert mixture.active is not None
    (row,) = table_of(blocks, "Statistics of the valid potentials")
    wanted = [potential.min_mv, potential.p5_mv, potential.p10_mv, potential.p25_mv]
    wanted += [potential.median_mv, potential.p75_mv, potential.p90_mv, potential.p95_mv]
    wanted += [potential.max_mv, potential.mean_mv, potential.sd_mv]
    assert [as_number(cell) for cell in row] == pytest.approx([summary.valid, *wanted], abs=0.051)
    active, _ = table_of(blocks, "Two normal populations")
    share, error = active[1].removesuffix(" %").split(" ± ")
    assert as_number(share) == pytest.approx(100.0 * mixture.active.share, abs=0.051)
    assert as_number(error) == pytest.approx(100.0 * (mixture.share_error or 0.0), abs=0.051)
    assert as_number(active[2].split(" ± ")[0]) == pytest.approx(mixture.active.mean_mv, abs=0.051)
    conditions = table_of(blocks, "Conditions of concrete")
    assert [as_number(r[2]) for r in conditions] == [
        *(c.count for c in summary.conditions),
        summary.no_condition,
    ]


def test_tables_of_places_hold_the_assessment(deck: SurfaceFindings) -> None:
    blocks, summary = blocks_of(deck), deck.assessed.summary
    minima = table_of(blocks, "Negative minima")
    assert [row[0] for row in minima] == [m.label for m in summary.gradient.steepest]
    assert [as_number(row[4]) for row in minima] == pytest.approx(
        [m.rise_mv for m in summary.gradient.steepest], abs=0.5
    )
    proposals = table_of(blocks, "Where to read more closely")
    assert [row[0] for row in proposals] == [
        " – ".join(p.between) for p in summary.refinement.greatest
    ]
    assert len(proposals) == min(20, summary.refinement.total) > 0


def test_the_points_table_has_how_sure_each_reading_is(deck: SurfaceFindings) -> None:
    points = points_of(deck)
    sure = sureness_of(points, [deck])
    assert len(sure) == deck.assessed.summary.valid
    assert sum(s.doubtful for s in sure.values()) == deck.assessed.summary.uncertainty.doubtful
    for k, s in sure.items():
        assert s.sd_mv == pytest.approx(1e3 * deck.assessed.budget.total_v[k])
    rows = table_of(blocks_of(deck), "Readings by point.")
    assert len(rows) == len(points)
    marked = [row[0] for row in rows if any(cell.endswith(" ?") for cell in row)]
    assert marked == [points[k].point.label for k, s in sure.items() if s.doubtful]


def test_repeated_readings_have_their_places_uncertainty() -> None:
    uv = np.repeat(lattice(3, 2), 2, axis=0)
    shuffled = np.random.default_rng(0).permutation(len(uv))
    evaluated = surveyed(uv[shuffled], -200.0 + 10.0 * shuffled)
    repeated = [ReadPoint(p.point, None) for p in points_of(evaluated) for _ in (0, 1)]
    sure = sureness_of(repeated, [evaluated])
    assert len(sure) == 12
    assert {s.sd_mv for s in sure.values()} == {
        1e3 * float(v) for v in np.unique(evaluated.assessed.budget.total_v)
    }


@pytest.mark.parametrize(
    ("extra", "english", "german"),
    [
        ([-420.0], "1 degree of freedom.", "bei 1 Freiheitsgrad."),
        ([-420.0, -170.0], "2 degrees of freedom", "bei 2 Freiheitsgraden."),
    ],
)
def test_readings_of_a_place_that_differ_are_told(
    extra: list[float], english: str, german: str
) -> None:
    uv = np.vstack([lattice(5, 5), *[lattice(5, 5)[12:13]] * len(extra)])
    evaluated = surveyed(uv, [*np.linspace(-150.0, -170.0, 25), *extra])
    blocks = uncertainty_blocks(evaluated.assessed.summary)
    told = next(block.text for block in blocks if isinstance(block, Paragraph))
    assert english in ENGLISH.plain(told)
    assert "The readings at the place of point 13 differ by 260 mV" in ENGLISH.plain(told)
    assert german in GERMAN.plain(told)
    assert "an der Stelle von Punkt 13 weichen um 260 mV" in GERMAN.plain(told)


def test_how_deep_a_minimum_has_to_be_is_told(deck: SurfaceFindings) -> None:
    found = deck.assessed.summary.gradient
    assert found.scatter_mv is not None
    told = [b.text for b in gradient_blocks(found) if isinstance(b, Paragraph)]
    assert f"at least {found.least_depth_mv:.0f} mV deep" in ENGLISH.plain(told[0])
    assert f"scatters by {found.scatter_mv:.1f} mV around" in ENGLISH.plain(told[0])


def test_the_conversion_has_a_row_of_its_own() -> None:
    """Only where there is one."""
    for electrode, rows in (("CSE", 0), ("SCE", 1)):
        found = surveyed(lattice(3, 3), [-150.0] * 9, basis=basis_of(electrode, 22.2))
        table = table_of(uncertainty_blocks(found.assessed.summary), "Standard uncertainty")
        assert sum(row == ["conversion to CSE", "2.9"] for row in table) == rows


def test_the_map_is_the_kriged_one(deck: SurfaceFindings) -> None:
    figure = figures_of(blocks_of(deck))["map-1"]
    field = next(t for t in figure.traces if t["type"] == "contour")
    z = np.array([[np.nan if v is None else v for v in row] for row in field["z"]])
    assert z == pytest.approx(1e3 * deck.map.potential_v, abs=0.0051, nan_ok=True)
    assert 150.0 % field["contours"]["size"] == 0.0
    assert field["contours"]["size"] <= 100.0
    values = [ENGLISH.plain(t) for t in trace({"data": figure.traces}, "levels")["text"]]
    assert {"<b>\u2212350</b>", "<b>\u2212200</b>"} <= set(values)
    heavy = [t for t in figure.traces if t.get("mode") == "lines" and t["line"]["width"] > 2.0]
    # On a heavy line the field has the value of a boundary.
    from scipy.interpolate import RegularGridInterpolator

    at = RegularGridInterpolator((deck.map.v_m, deck.map.u_m), 1e3 * deck.map.potential_v)
    on_line = np.column_stack([decoded(heavy[0]["y"]), decoded(heavy[0]["x"])])
    found = at(on_line[np.isfinite(on_line).all(axis=1)].clip(0.0))
    known = found[np.isfinite(found)]
    assert np.min(np.abs(known[:, None] - [-350.0, -200.0]), axis=1).max() < 5.0
    assert figure.layout["yaxis"]["scaleanchor"] == "x"


def test_signs_stand_where_the_assessment_says(deck: SurfaceFindings) -> None:
    figure = figures_of(blocks_of(deck))["map-1"]
    by_symbol = {t["marker"]["symbol"]: t for t in figure.traces if "symbol" in t.get("marker", {})}
    minima, steps = deck.assessed.minima, deck.assessed.steps
    where = deck.assessed.readings.uv_m[minima.index[minima.is_active]]
    triangles = by_symbol["triangle-down-open"]
    assert np.column_stack([triangles["x"], triangles["y"]]) == pytest.approx(where)
    crosses = by_symbol["cross-open"]
    assert np.column_stack([crosses["x"], crosses["y"]]) == pytest.approx(steps.midpoint_m)
    assert len(by_symbol["x-thin"]["x"]) == 1
    assert "open circuit" in ENGLISH.plain(by_symbol["x-thin"]["customdata"][0])


def test_the_mixture_is_drawn_as_it_was_fitted(deck: SurfaceFindings) -> None:
    figures, mixture = figures_of(blocks_of(deck)), deck.assessed.summary.mixture
    assert mixture.active is not None
    assert mixture.threshold_mv is not None
    curves = {ENGLISH.plain(t["name"]): t for t in figures["cumulative-1"].traces}
    z, mv = (decoded(curves["active population"][axis]) for axis in "xy")
    # A normal population is a straight line on the probability scale.
    assert z == pytest.approx((mixture.active.mean_mv - mv) / mixture.active.sd_mv, abs=1e-3)
    band = next(s for s in figures["cumulative-1"].layout["shapes"] if s["type"] == "rect")
    error = mixture.threshold_error_mv
    assert error is not None
    assert (band["y0"], band["y1"]) == (mixture.threshold_mv - error, mixture.threshold_mv + error)
    histogram = {ENGLISH.plain(t["name"]): t for t in figures["histogram-1"].traces}
    x, y = (decoded(histogram["both together"][axis]) for axis in "xy")
    bars = [histogram[name] for name in ("passive", "active", "uncertain") if name in histogram]
    areas = sum(abs(_shoelace(np.array(t["x"]), np.array(t["y"]))) for t in bars)
    assert float(np.trapezoid(y, x)) == pytest.approx(areas, rel=0.02)


def _shoelace(x: np.ndarray, y: np.ndarray) -> float:
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def test_every_figure_can_be_drawn_on_paper(deck: SurfaceFindings) -> None:
    figures = figures_of(blocks_of(deck))
    assert list(figures) == ["map-1", "error-1", "cumulative-1", "histogram-1", "resistivity-1"]
    for figure in figures.values():
        assert draw(figure, GERMAN, 170.0) is not None


@pytest.mark.parametrize(
    ("count", "why"), [(1, "1 valid reading is too few"), (2, "2 places with valid readings")]
)
def test_few_readings_say_why_there_is_no_more(count: int, why: str) -> None:
    evaluated = surveyed(lattice(count, 1), [-300.0, -100.0][:count])
    blocks = blocks_of(evaluated)
    figure = figures_of(blocks)["map-1"]
    assert "error-1" not in figures_of(blocks)
    assert why in ENGLISH.plain(figure.caption)
    assert not any(t["type"] == "contour" for t in figure.traces)
    assert "Populations were not separated" in told(blocks)
    assert "No resistivity is known" in told(blocks)
    for drawn in figures_of(blocks).values():
        assert draw(drawn, ENGLISH, 170.0) is not None
    assert "<table" in page_of(blocks)


def test_nothing_read_and_nothing_valid_are_said() -> None:
    nothing = blocks_of(surveyed(np.zeros((0, 2)), []))
    assert "Nothing was read on surface “deck”." in told(nothing)
    invalid = surveyed(lattice(4, 3), [np.nan] * 12)
    blocks = blocks_of(invalid)
    assert "No statistics of the potentials: no reading is valid." in told(blocks)
    assert "No uncertainty is stated" in told(blocks)
    assert list(figures_of(blocks)) == ["map-1"]
    assert "there are no valid readings" in ENGLISH.plain(figures_of(blocks)["map-1"].caption)
    assert evaluation_blocks([], [], None) == []


def test_two_surfaces_have_one_scale_of_colours() -> None:
    first = surveyed(lattice(4, 3), np.linspace(-700.0, -650.0, 12), surface="a")
    second = surveyed(lattice(4, 3), np.linspace(-90.0, -10.0, 12), surface="b")
    figures = figures_of(evaluation_blocks([first, second], [], None))
    axes = [figures[name].layout["coloraxis"] for name in ("map-1", "map-2")]
    assert axes[0] == axes[1]
    assert (axes[0]["cmin"], axes[0]["cmax"]) == (-700.0, 0.0)


def test_a_hundred_thousand_readings_are_thinned_and_small() -> None:
    evaluated = two_populations(400, 250)
    points = points_of(evaluated)
    blocks = blocks_of(evaluated, points=points)
    figures, summary = figures_of(blocks), evaluated.assessed.summary
    potential = summary.potential
    assert potential is not None
    symbols = [t for t in figures["map-1"].traces if "ASTM" in ENGLISH.plain(t.get("name", ""))]
    assert symbols == []
    assert "too many to be drawn one by one" in ENGLISH.plain(figures["map-1"].caption)
    drawn = figures["cumulative-1"].traces[0]["y"]
    assert len(drawn) <= MOST_MARKERS
    assert (min(drawn), max(drawn)) == (potential.min_mv, potential.max_mv)
    shown = [t for t in figures["resistivity-1"].traces if t["mode"].startswith("markers")]
    rho = np.array([value for t in shown for value in t["y"]])
    valid = evaluated.assessed.readings
    known = valid.resistivity_ohm_m[valid.valid]
    assert len(rho) <= MOST_MARKERS
    assert (rho.min(), rho.max()) == (known.min(), known.max())
    assert len(table_of(blocks, "Readings by point.")) == 1000
    sentences = [ENGLISH.plain(text) for text in findings(points, [evaluated])]
    assert all(len(sentence) < 400 for sentence in sentences)
    page = page_of(blocks)
    assert len(page.encode()) <= 15e6
    assert "readings.csv beside this report has all of them" in page


def test_labels_are_named_as_far_as_one_reads() -> None:
    assert ENGLISH.plain(named([])) == "–"
    assert ENGLISH.plain(named([str(k) for k in range(1, 13)])).endswith("11 and 12")
    assert ENGLISH.plain(named([str(k) for k in range(1, 31)])).endswith("9, 10 and 20 more")
    assert GERMAN.plain(named([str(k) for k in range(1, 31)])).endswith("10 und 20 weitere")


def test_findings_tell_areas_gradients_and_populations(deck: SurfaceFindings) -> None:
    text = " ".join(ENGLISH.plain(t) for t in findings(points_of(deck), [deck]))
    summary = deck.assessed.summary
    assert f"m² of the {summary.area_m2:.2f} m² that were measured" in text
    assert "by the gradient criterion (RILEM TC 154-EMC)" in text
    assert "The potentials are of two populations" in text


def test_without_resistivity_nothing_is_said_of_both() -> None:
    """No reassuring zero stands where nothing was measured."""
    potential_mv = [-430.0] * 20 + [-300.0] * 4 + [-100.0]
    evaluated = surveyed(lattice(5, 5), potential_mv)
    points = points_of(evaluated)
    text = " ".join(ENGLISH.plain(t) for t in findings(points, [evaluated]))
    assert "combined" not in text
    assert "The potentials at points" in text
    assert "No resistivity was measured" in text
    names = [ENGLISH.plain(box.name) for box in reading_boxes(points)]
    assert names == ["valid readings", "active by potential (ASTM C876)", "most negative"]
    tables = {
        ENGLISH.plain(block.caption): block
        for block in evaluation_blocks([evaluated], points, None)
        if isinstance(block, Table)
    }
    assert not [caption for caption in tables if caption.startswith("Combined")]
    (table,) = (tables[caption] for caption in tables if caption.startswith("Readings by point"))
    assert "Corrosion" not in [ENGLISH.plain(column.heading) for column in table.columns]


@pytest.mark.parametrize(
    ("electrode", "temperature_c", "sentence"),
    [
        ("CSE", None, "They are not corrected for temperature: the temperature is not known"),
        ("CSE", 32.2, "They were corrected by 9.0 mV from 32.2 °C to 22.2 °C (ASTM C876)."),
        ("SCE", 20.0, "read against SCE and are given against copper/copper sulphate (CSE): −75.0"),
    ],
)
def test_caveats_follow_the_basis(
    electrode: str, temperature_c: float | None, sentence: str
) -> None:
    basis = basis_of(electrode, temperature_c)
    one, other = (surveyed(lattice(3, 3), [-100.0] * 9, basis=basis) for _ in range(2))
    (caveat,) = temperature_caveats([one, other])
    assert sentence in ENGLISH.plain(caveat)


def matrix(rule: Rule, names: Sequence[str]) -> Confusion:
    rows = [
        ConfusionRow(verdict=n, active_m2=0.5 * k, sound_m2=4.0, active_points=k, sound_points=16)
        for k, n in enumerate(names)
    ]
    return Confusion(rule=rule, rows=tuple(rows))


def test_scoring_is_told_in_areas_and_points(deck: SurfaceFindings) -> None:
    scoring = Scoring(
        surfaces=(
            SurfaceScoring(
                surface="deck",
                combined=matrix("combined", ("none", "possible", "active", "unread")),
                astm=matrix("astm", ("passive", "uncertain", "active", "unread")),
                sites_total=4,
                sites_found=3,
                too_resistive_m2=0.75,
            ),
        )
    )
    blocks = blocks_of(deck, scoring)
    rows = table_of(blocks, "The combined verdict against the truth")
    assert [row[0] for row in rows] == ["not indicated", "possible", "active", "unread", "all"]
    assert [as_number(row[1]) for row in rows] == [0.0, 0.5, 1.0, 1.5, 3.0]
    assert [as_number(row[4]) for row in rows] == [16, 16, 16, 16, 64]
    text = told(blocks)
    assert "Of 3.000 m² over steel that truly corrodes, 2.000 m² (66.7 %) were not called" in text
    assert "Of 4 corroding sites 3 were found" in text
    assert (
        "Over 0.7500 m² (25.0 %) of the truly active area the concrete truly has more than 100 Ω·m"
        in text
    )
    whole = scoring.surfaces[0].model_copy(update={"too_resistive_m2": 0.0})
    assert "100 Ω·m: there the rule" not in told(blocks_of(deck, Scoring(surfaces=(whole,))))
    assert "truth" not in page_of(blocks_of(deck))


PNG = b"\x89PNG\r\n\x1a\n" + bytes(8) + (1280).to_bytes(4, "big") + (720).to_bytes(4, "big")


def test_pictures_are_told_in_every_language() -> None:
    scene = (
        "Hexarotor v. 2 touching the structure, 31 s after the log begins (sortie 1 of 3). "
        "Rendered from the log. Poses are the simulation's true ones, the structure is as the "
        "planner believed it. The log was interrupted."
    )
    assert ENGLISH.plain(caption(scene)) == scene
    german = GERMAN.plain(caption(scene))
    assert german.startswith("Hexarotor v. 2 am Bauwerk, 31 s nach Beginn")
    assert "(Teilflug 1 von 3)" in german
    assert german.endswith("Das Protokoll brach ab.")
    film = "X: 60 s of flight, shown 4.3 times as fast. Rendered from the log. Poses are the"
    film += " vehicle's own estimate, the structure is as the planner believed it."
    blocks = list(picture_blocks(Pictures(PNG, scene, b"mp4", film)))
    assert [type(block) for block in blocks] == [Picture, Film]
    assert "4,3-mal" in GERMAN.plain(caption(film))
    assert "estimate" not in GERMAN.plain(caption(film))


def test_missing_pictures_are_a_note_and_unwanted_ones_nothing() -> None:
    assert list(picture_blocks(None)) == []
    note = "No pictures: rendering took longer than 90 s; 'inspect doctor' says what is missing."
    (paragraph,) = picture_blocks(Pictures(note=note))
    assert isinstance(paragraph, Paragraph)
    assert paragraph.role == "note"
    assert isinstance(paragraph.text, Said)
    assert "dauerte länger als 90 s" in GERMAN.plain(paragraph.text)


def test_no_table_is_empty(deck: SurfaceFindings) -> None:
    for block in blocks_of(deck):
        if isinstance(block, Table):
            assert block.rows
            assert all(isinstance(column, Column) for column in block.columns)
        assert not (isinstance(block, Notes) and not block.items)
    assert "<figure" in Page(page_of(blocks_of(deck))).source
