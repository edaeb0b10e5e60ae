"""Lists of readings: columns by their names, units by their headings, places in space."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.errors import InputError
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.surveys.survey import Survey, read_survey


def read(folder: Path, text: str, **settings: object) -> Survey:
    (folder / "s.csv").write_text(text, encoding="utf-8")
    return read_survey(folder / "s.csv", SurveySettings(**settings))  # type: ignore[arg-type]


def refusal(folder: Path, text: str, **settings: object) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, text, **settings)
    return str(caught.value).replace(str(folder) + "/", "")


@pytest.mark.parametrize(
    ("names", "row"),
    [
        ("x,y,potential", "1.5,0.25,-350"),
        ("x_m,y_m,E_mV", "1.5,0.25,-350"),
        ("X (mm),Y (mm),Potential [mV]", "1500,250,-350"),
        ("x [cm],y/mm,Potenzial (V)", "150,250,-0.35"),
        ("u,v,Half-cell potential / mV", "1.5,0.25,-350"),
        ("x-coordinate m,y-coordinate m,Ecorr mV", "1.5,0.25,-350"),
        ("pos_x_mm,pos_y_mm,potential_v", "1500,250,-0.35"),
        ("E [mV vs. CSE],Y [m],X [m]", "-350,0.25,1.5"),
        ("Nr,X,Y,E", "1,1.5,0.25,-350"),
        ("Point,Easting,Northing,mV", "1,1.5,0.25,-350"),
        ("Rechtswert [mm],Hochwert [mm],mV (CSE)", "1500,250,-350"),
    ],
)
def test_headings_in_many_hands(tmp_path: Path, names: str, row: str) -> None:
    survey = read(tmp_path, f"{names}\n{row}\n")
    np.testing.assert_allclose(survey.uv_m, [(1.5, 0.25)], rtol=1e-15)
    assert survey.potential_mv.tolist() == [-350.0]
    assert survey.grid is None
    assert survey.p_W is None


def test_everything_that_a_list_may_hold(tmp_path: Path) -> None:
    text = (
        "Punkt;x [m];y [m];Potenzial (mV);resistivity_kohm_cm;Temperatur [°C];Bemerkung\n"
        "P1;0,5;1;-350,5;18,9;12,5;nass\n"
        "P1;0,5;1;-352;-;;\n"
        ";1;1;n/a;20;13;'=2+2\n"
    )
    survey = read(tmp_path, text)
    assert survey.labels == ("P1", "P1", "3")
    assert survey.uv_m.tolist() == [[0.5, 1], [0.5, 1], [1, 1]]  # repeated readings stay
    np.testing.assert_array_equal(survey.potential_mv, [-350.5, -352, np.nan])
    np.testing.assert_allclose(survey.resistivity_ohm_m, [189, np.nan, 200])
    np.testing.assert_array_equal(survey.temperature_c, [12.5, np.nan, 13])
    assert survey.why == ("", "", "the file says 'n/a'")
    assert survey.assumed == ("electrode", "orientation")
    assert survey.warnings == ("Columns that were not read: Bemerkung.",)
    assert survey.settings.resistivity_unit == "kohm_cm"


def test_what_no_heading_says_is_assumed_or_set(tmp_path: Path) -> None:
    text = "x,y,potential,rho\n100,50,-0.35,20\n200,50,-0.34,30\n"
    survey = read(
        tmp_path, text, coordinate_unit="cm", potential_unit="V", resistivity_unit="ohm_m"
    )
    assert survey.uv_m.tolist() == [[1, 0.5], [2, 0.5]]
    assert survey.potential_mv.tolist() == [-350, -340]
    assert survey.resistivity_ohm_m.tolist() == [20, 30]
    assert survey.assumed == ("electrode", "orientation")
    plain = read(tmp_path, "x,y,potential,rho\n1,5,-350,20\n", origin_m=(1.0, 2.0))
    assert plain.uv_m.tolist() == [[2.0, 7.0]]
    assert plain.assumed == (
        *("potential_unit", "electrode", "coordinate_unit"),
        *("resistivity_unit", "orientation"),
    )


def test_the_electrode_in_a_heading(tmp_path: Path) -> None:
    survey = read(tmp_path, "x_m,y_m,E [mV vs SCE]\n0,0,-300\n")
    assert survey.settings.electrode == "SCE"
    assert "electrode" not in survey.assumed
    silver = "x_m,y_m,E (mV Ag/AgCl)\n0,0,-300\n"
    assert "s.csv:1:9: cell C1: the heading says Ag/AgCl" in refusal(tmp_path, silver)
    known = read(tmp_path, silver, electrode="Ag/AgCl 1 M KCl")
    assert known.settings.electrode == "Ag/AgCl 1 M KCl"
    said = refusal(tmp_path, "x_m,y_m,E [mV SCE]\n0,0,-300\n", electrode="CSE")
    assert "cell C1: the heading says SCE where the settings say CSE" in said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x,y\n0,0\n", "s.csv:1:1: cell A1: columns of coordinates, but none of potentials"),
        ("label,potential\nA,-300\n", "cell A1: a column of potentials, but no x and y"),
        ("x,potential\n1,-300\n", "cell A1: a column of potentials, but no x and y"),
        ("E,X,Y\n-300,0,0\n", "cell A1: the first row may name a list's columns or a grid's"),
        ("x,y,E [furlong]\n0,0,-300\n", "s.csv:1:5: cell C1: the heading 'E [furlong]' has no"),
        ("x [kg],y,E\n0,0,-300\n", "s.csv:1:1: cell A1: the heading 'x [kg]' has no unit of"),
        ("x [mV],y,E\n0,0,-300\n", "s.csv:1:1: cell A1: the heading 'x [mV]' has no unit of"),
        ("x,y,E,E_mV\n0,0,-300,-300\n", "s.csv:1:7: cell D1: a second column of potential"),
        ("x,y,E\n,0,-300\n", "s.csv:2:1: cell A2: '' stands where a number is needed"),
        ("x,y,E\n0,n/a,-300\n", "s.csv:2:3: cell B2: 'n/a' stands where a number is needed"),
        ("x,y,z,E\n0,0,1,-300\n0,1,,-300\n", "s.csv:3:5: cell C3: '' stands where a number is"),
        ("x,y,E\n0,0,-300\n0,1,wet\n", "s.csv:3:5: cell C3: 'wet' is not a number"),
        ('name,x,y,E\n"A, 1",0,inf,-300\n', "s.csv:2:10: cell C2: 'inf' is not a number"),
        ("x,y,E [V]\n0,0,-300\n", "s.csv:2:5: cell C2: -300 V is no half-cell potential"),
        ("x,y,E [V]\n0,0,-0.3 mV\n", "cell C2: '-0.3 mV' is in mV where the column is in V"),
        ("x,y,E\n0,0,-300\n1e300,0,-3\n", "s.csv:3:1: cell A3: 1e+300 m is no coordinate: beyond"),
        ("u,v_mm,E\n0,-2e11,-300\n", "s.csv:2:3: cell B2: -2e+11 mm is no coordinate: beyond ±100"),
        ("x,y,z,E\n0,0,1e9,-3\n", "s.csv:2:5: cell C2: 1e+09 m is no coordinate"),
        ("x,y,E,rho\n0,0,-300,0\n", "s.csv:2:10: cell D2: 0 is not a positive resistivity"),
        ("x,y,E,rho\n0,0,-300,1e300\n", "s.csv:2:10: cell D2: 1e+300 kΩ·cm is no resistivity of"),
        ("x,y,E,rho\n0,0,-300,1e-99\n", "s.csv:2:10: cell D2: 1e-99 kΩ·cm is no resistivity of"),
        ("x,y,E,temp\n0,0,-300,999\n", "s.csv:2:10: cell D2: 999 °C: potentials are corrected"),
        ("x,y,E\n", "s.csv: holds no rows of numbers"),
        ("x,y,E,surface\n0,0,-3,a\n0,0,-3,b\n", "s.csv:3:8: cell D3: the surface 'b' in a list"),
        ("x_m;y_m;E_mV\n0,5;1;-300\n0.5;1;-300\n", "s.csv:2:1: cell A2: a decimal comma in a"),
    ],
)
def test_what_is_uncertain_is_refused_by_its_address(tmp_path: Path, text: str, said: str) -> None:
    assert said in refusal(tmp_path, text)


def test_headings_and_settings_have_to_agree(tmp_path: Path) -> None:
    said = refusal(tmp_path, "x_mm,y_mm,E\n0,0,-300\n", coordinate_unit="m")
    assert "s.csv:1:1: cell A1: the heading says mm where the settings say m" in said
    said = refusal(tmp_path, "1,2,-300\n3,4,-300\n", layout="list")
    assert "s.csv:1:1: cell A1: the first row names no column potential" in said


def wall(n_W: np.ndarray, count: int = 40, rough_m: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Points on a plane through (3, 1, 2), and the level axes that a surveyor would draw on it."""
    right = np.cross([0.0, 0.0, 1.0], n_W)
    right /= np.linalg.norm(right)
    up = np.cross(n_W, right)
    rng = np.random.default_rng(1)
    uv = rng.uniform(0, 4, (count, 2))
    uv[0] = 0.0  # the corner
    off = rough_m * rng.choice([-1.0, 1.0], count)
    return np.array([3.0, 1.0, 2.0]) + uv @ [right, up] + np.outer(off, n_W), uv


def as_text(p_W: np.ndarray) -> str:
    rows = (f"{x!r},{y!r},{z!r},-300" for x, y, z in p_W.tolist())
    return "x_m,y_m,z_m,E_mV\n" + "\n".join(rows) + "\n"


@pytest.mark.parametrize("tilt_deg", [0.0, 35.0, -20.0])
def test_points_in_space_are_laid_out_on_their_plane(tmp_path: Path, tilt_deg: float) -> None:
    # The normal of a leaning wall that is seen from the origin.
    n_W = Rotation.from_euler("zy", [200.0, tilt_deg], degrees=True).apply([1.0, 0.0, 0.0])
    p_W, uv = wall(n_W)
    survey = read(tmp_path, as_text(p_W))
    assert survey.plane is not None
    np.testing.assert_allclose(survey.p_W, p_W, rtol=0, atol=0)
    np.testing.assert_allclose(survey.plane.R_WS[:, 2], n_W, atol=1e-9)
    np.testing.assert_allclose(survey.uv_m, uv - uv.min(axis=0), atol=1e-9)
    laid = survey.plane.p_WS + survey.uv_m @ survey.plane.R_WS[:, :2].T
    np.testing.assert_allclose(laid, p_W, atol=1e-9)
    assert survey.plane.rms_m < 1e-9
    assert survey.assumed == ("electrode", "seen_from_m")
    behind = read(tmp_path, as_text(p_W), seen_from_m=(30.0, 10.0, 2.0))
    assert behind.plane is not None
    np.testing.assert_allclose(behind.plane.R_WS[:, 2], -n_W, atol=1e-9)
    # From behind, right is left, and up stays up.
    np.testing.assert_allclose(behind.uv_m[:, 0], uv[:, 0].max() - uv[:, 0], atol=1e-9)
    assert behind.assumed == ("electrode",)


def test_rough_points_are_mapped_with_a_warning(tmp_path: Path) -> None:
    n_W = np.array([-1.0, 0.0, 0.0])
    p_W, uv = wall(n_W, 400, rough_m=0.05)
    survey = read(tmp_path, as_text(p_W))
    assert survey.plane is not None
    # The fit leans into the noise by at most about 0.05 m / (1.15 m √400).
    assert survey.plane.rms_m == pytest.approx(0.05, rel=0.02)
    np.testing.assert_allclose(survey.uv_m, uv - uv.min(axis=0), atol=0.02)
    assert "off the plane that fits them best (RMS 0.050 m)" in survey.warnings[0]
    smooth = read(tmp_path, as_text(wall(n_W, 400, rough_m=0.005)[0]))
    assert not any("off the plane" in sentence for sentence in smooth.warnings)


def test_a_deck_is_seen_from_above_unless_stated(tmp_path: Path) -> None:
    """At 400 m above the sea, the origin lies far below the deck."""
    text = "x,y,z,E\n0,0,400,-300\n2,0,400,-310\n2,1,400,-320\n0,1,400,-330\n"
    survey = read(tmp_path, text)
    np.testing.assert_allclose(survey.uv_m, [(0, 0), (2, 0), (2, 1), (0, 1)], atol=1e-9)
    assert survey.warnings == ("The surface is assumed to be seen from above.",)
    soffit = read(tmp_path, text, seen_from_m=(1.0, 0.5, 395.0))
    assert soffit.warnings == ()
    assert soffit.plane is not None
    np.testing.assert_allclose(soffit.plane.R_WS[:, 2], (0, 0, -1), atol=1e-9)
    np.testing.assert_allclose(soffit.uv_m, [(0, 1), (2, 1), (2, 0), (0, 0)], atol=1e-9)


def test_a_wall_through_the_origin_needs_its_side(tmp_path: Path) -> None:
    text = "x,y,z,E\n0,0,0,-300\n2,0,0,-310\n2,0,1,-320\n"
    said = refusal(tmp_path, text)
    assert "s.csv: the origin of the coordinates lies on the surface" in said
    assert "seen_from_m" in said
    assert "seen_from_m lies on the surface" in refusal(tmp_path, text, seen_from_m=(5.0, 0.0, 0.0))
    front = read(tmp_path, text, seen_from_m=(0.0, -3.0, 0.0))
    np.testing.assert_allclose(front.uv_m, [(0, 0), (2, 0), (2, 1)], atol=1e-9)
    back = read(tmp_path, text, seen_from_m=(0.0, 3.0, 0.0))
    np.testing.assert_allclose(back.uv_m, [(2, 0), (0, 0), (0, 1)], atol=1e-9)


def test_points_on_a_line_determine_no_plane(tmp_path: Path) -> None:
    line = np.outer(np.arange(5.0), [1.0, 2.0, 3.0])
    assert "s.csv: the points lie on a line" in refusal(tmp_path, as_text(line))


def test_an_empty_column_z_is_none(tmp_path: Path) -> None:
    survey = read(tmp_path, "x,y,z,E\n0,0,,-300\n0,1,,-300\n")
    assert survey.p_W is None
    assert survey.uv_m.tolist() == [[0, 0], [0, 1]]


def test_own_coordinates_along_the_surface_come_first(tmp_path: Path) -> None:
    survey = read(tmp_path, "u_m,v_m,x_m,y_m,z_m,E_mV\n1,2,3,4,5,-300\n")
    assert survey.uv_m.tolist() == [[1, 2]]
    assert survey.p_W is not None
    assert survey.p_W.tolist() == [[3, 4, 5]]
    assert survey.plane is None


def test_resistivities_of_a_second_list(tmp_path: Path) -> None:
    text = "x_m,y_m,E_mV\n0,0,-300\n0,1,-310\n0,1,-311\n"
    (tmp_path / "rho.csv").write_text("X (mm),Y (mm),rho [Ω·m]\n0,1000,50\n0,1000,60\n0,0,40\n")
    survey = read(tmp_path, text, resistivity="rho.csv")
    assert survey.resistivity_ohm_m.tolist() == [40, 50, 60]  # repeated places in their order
    assert "resistivity_unit" not in survey.assumed
    (tmp_path / "rho.csv").write_text("x,y,rho\n0,1,50\n0,2,60\n0,0,40\n")
    said = refusal(tmp_path, text, resistivity="rho.csv")
    assert "s.csv:4:1: cell A4: the reading '3' has no resistivity" in said
    (tmp_path / "rho.csv").write_text("x,y,rho\n0,1,50\n")
    said = refusal(tmp_path, text, resistivity="rho.csv")
    assert "rho.csv: 1 resistivities where" in said
    assert "has 3 readings" in said
    (tmp_path / "rho.csv").write_text("1 2\n3 4\n")
    assert "rho.csv: a grid of resistivities" in refusal(tmp_path, text, resistivity="rho.csv")
    both = "x_m,y_m,E_mV,rho\n0,0,-300,1\n"
    said = refusal(tmp_path, both, resistivity="rho.csv")
    assert "s.csv:1:14: cell D1: a column of resistivities" in said


def test_labels_join_lists_where_both_have_them(tmp_path: Path) -> None:
    (tmp_path / "rho.csv").write_text("point,x,y,rho_ohm_m\nB,9,9,50\nA,9,9,40\n")
    survey = read(tmp_path, "point,x,y,E\nA,0,0,-300\nB,0,1,-310\n", resistivity="rho.csv")
    assert survey.resistivity_ohm_m.tolist() == [40, 50]
