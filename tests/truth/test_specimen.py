"""The specimen's fields against their formulas, their files against what may be in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from inspect_cli.errors import InputError
from inspect_cli.schema.specimens import AnalyticSpecimen, AnalyticSpot, GridSpecimen
from inspect_cli.truth.specimens import load_specimen

POTENTIAL = "row,A,B,C\n1,-100,-200,-300\n2,-110,-210,-310\n"
RESISTIVITY = "10\t20\t30\n11\t21\t31\n"


def grid(folder: Path, potential: str = POTENTIAL, resistivity: str = RESISTIVITY) -> GridSpecimen:
    (folder / "e.csv").write_text(potential)
    (folder / "rho.txt").write_text(resistivity)
    return GridSpecimen(
        model="grid",
        potential_mv="e.csv",
        resistivity_kohm_cm="rho.txt",
        pitch_m=0.1,
        at_m=(1.0, 2.0),
    )


def test_rows_run_down_and_columns_run_right(tmp_path: Path) -> None:
    field = load_specimen(grid(tmp_path), tmp_path)
    assert field.at(0.9, 2.05) == pytest.approx((-0.100, 100.0))
    assert field.at(1.1, 2.05) == pytest.approx((-0.300, 300.0))
    assert field.at(0.9, 1.95) == pytest.approx((-0.110, 110.0))
    assert field.at(1.0, 2.0) == pytest.approx((-0.205, 205.0))


def test_outside_the_grid_there_are_no_values(tmp_path: Path) -> None:
    field = load_specimen(grid(tmp_path), tmp_path)
    for u, v in [(0.899, 2.0), (1.101, 2.0), (1.0, 2.051), (1.0, 1.949), (np.nan, 2.0)]:
        assert np.isnan(field.at(u, v)).all()


def test_bilinear_agrees_with_scipy(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    table = rng.uniform(-500.0, 0.0, (6, 4))
    text = "\n".join(",".join(repr(float(x)) for x in row) for row in table)
    field = load_specimen(grid(tmp_path, text, text.replace("-", "")), tmp_path)
    u = 1.0 + 0.1 * (np.arange(4) - 1.5)
    v = 2.0 - 0.1 * (np.arange(6) - 2.5)
    reference = RegularGridInterpolator((v[::-1], u), table[::-1] / 1000.0)
    for v_i, u_i in rng.uniform((v[-1], u[0]), (v[0], u[-1]), (200, 2)):
        potential, resistivity = field.at(u_i, v_i)
        assert potential == pytest.approx(reference((v_i, u_i)).item(), abs=1e-12)
        assert resistivity == pytest.approx(-10_000.0 * potential, rel=1e-9)


def test_analytic_field_follows_its_formula(tmp_path: Path) -> None:
    spots = (
        AnalyticSpot(at_m=(0.1, -0.2), depth_v=0.3, radius_m=0.05, resistivity_factor=0.25),
        AnalyticSpot(at_m=(-3.0, 0.0), depth_v=0.1, radius_m=0.1),
    )
    model = AnalyticSpecimen(
        model="analytic", potential_v=-0.1, resistivity_ohm_m=200.0, spots=spots
    )
    field = load_specimen(model, tmp_path)
    assert field.at(0.1, -0.2) == pytest.approx((-0.4, 50.0))
    bell = np.exp(-0.5)  # one standard deviation away
    assert field.at(0.15, -0.2) == pytest.approx((-0.1 - 0.3 * bell, 200.0 * (1.0 - 0.75 * bell)))
    assert field.at(2.0, 2.0) == pytest.approx((-0.1, 200.0))


def test_the_rule_says_where_an_analytic_field_is_active(tmp_path: Path) -> None:
    spot = AnalyticSpot(at_m=(0.1, -0.2), depth_v=0.4, radius_m=0.05, resistivity_factor=0.1)
    dry = AnalyticSpot(at_m=(-2.0, 0.0), depth_v=0.4, radius_m=0.05)
    field = load_specimen(AnalyticSpecimen(model="analytic", spots=(spot, dry)), tmp_path)
    places = np.array([[0.1, -0.2], [0.1, 0.2], [-2.0, 0.0]])
    assert field.at(-2.0, 0.0)[0] < -0.35  # but too resistive for the rule to say active
    assert field.active(places).tolist() == [True, False, False]


def test_the_rule_says_where_a_grid_is_active(tmp_path: Path) -> None:
    field = load_specimen(grid(tmp_path, "-100,-500\n-100,-500\n", "9 9\n9 9\n"), tmp_path)
    places = np.array([[1.05, 2.0], [0.95, 2.0], [1.2, 2.0]])  # at the last there are no values
    assert field.active(places).tolist() == [True, False, False]


def test_analytic_field_without_spots(tmp_path: Path) -> None:
    assert load_specimen(AnalyticSpecimen(model="analytic"), tmp_path).at(0.3, 0.4) == (-0.1, 200.0)


@pytest.mark.parametrize(
    "text",
    [
        POTENTIAL,
        "\ufeff" + POTENTIAL.replace("\n", "\r\n"),
        "A,B,C\n-100,-200,-300\n-110,-210,-310\n",
        "-100 -200   -300\n\n-110 -210 -310\n\n",
        "# a comment\n,1,2,3\nfirst,-100,-200,-300\nsecond,-110,-210,-310",
        "-100;-200;-300\n-110;-210;-310",
    ],
)
def test_tables_are_read_in_their_usual_shapes(tmp_path: Path, text: str) -> None:
    field = load_specimen(grid(tmp_path, potential=text), tmp_path)
    assert field.at(0.9, 1.95)[0] == pytest.approx(-0.110)
    assert field.at(1.1, 2.05)[0] == pytest.approx(-0.300)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("row,A,B\n1,-1,-2\n2,-3,x\n", r"e\.csv:3:6: cell C3: 'x' is not a number"),
        ("row,A,B\n1,-1,nan\n2,-3,-4\n", r"e\.csv:2:6: cell C2: the file says 'nan'"),
        ("-1,-2\n-3,inf\n", r"e\.csv:2:4: cell B2: 'inf'"),
        ("-1,-2\n-3,\n", r"e\.csv:2:4: cell B2: the cell is empty"),
        ("-1,-2\n-3\n", r"e\.csv:2: a row of 1 cells where the first has 2"),
        ("row,A,B,C\n1,-1,-2\n2,-1,-2\n", r"e\.csv:2: a row of 3 cells where the first has 4"),
        ("row,A,B\n", r"no rows"),
        ("\n\n", r"empty"),
        ("-1,-2,-3,-4\n-1,-2,-3,-4\n", r"2 rows × 4 columns.*2 rows × 3 columns"),
    ],
)
def test_a_bad_potential_table_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError, match=f"(?s){said}"):
        load_specimen(grid(tmp_path, potential=text), tmp_path)


def test_other_bad_tables_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"rho\.txt: row 2, column 3 is not a positive"):
        load_specimen(grid(tmp_path, resistivity="1 2 3\n4 5 0\n"), tmp_path)
    with pytest.raises(InputError, match="at least two rows"):
        load_specimen(grid(tmp_path, "-1,-2\n", "1,2\n"), tmp_path)
    model = grid(tmp_path)
    (tmp_path / "e.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"e\.csv: this is no text"):
        load_specimen(model, tmp_path)
    (tmp_path / "e.csv").unlink()
    with pytest.raises(InputError, match=r"e\.csv: cannot be read"):
        load_specimen(model, tmp_path)


@pytest.mark.real_data
def test_a_measured_slab_is_met_exactly_at_its_nodes(shared_data: Path) -> None:
    folder = shared_data / "half_cell"
    model = GridSpecimen(
        model="grid",
        potential_mv="slab1.csv",
        resistivity_kohm_cm="resistivity_S1AC.txt",
        pitch_m=0.1,
    )
    field = load_specimen(model, folder)
    potential = np.genfromtxt(folder / "slab1.csv", delimiter=",", skip_header=1)[:, 1:]
    resistivity = np.loadtxt(folder / "resistivity_S1AC.txt")
    assert potential.shape == resistivity.shape == (29, 9)
    for i in range(29):
        for j in range(9):
            read = field.at(0.1 * (j - 4), 0.1 * (14 - i))
            assert read == pytest.approx((potential[i, j] / 1000.0, 10.0 * resistivity[i, j]))
