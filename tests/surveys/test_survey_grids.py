"""Grids of readings from text files: read as they are, or refused by the cell's address."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import numpy as np
import pytest

from inspect_cli.errors import InputError
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.surveys.survey import Survey, read_survey

VALUES = [[-350.5, -340.0, -300.0], [-250.0, -200.5, -100.0]]
LABELLED = "row,B,D,F\n2,-350.5,-340,-300\n4,-250,-200.5,-100\n"


def read(folder: Path, text: str | bytes, name: str = "s.csv", **settings: object) -> Survey:
    data = text.encode() if isinstance(text, str) else text
    (folder / name).write_bytes(data)
    return read_survey(folder / name, SurveySettings(**settings))  # type: ignore[arg-type]


def refusal(folder: Path, text: str | bytes, name: str = "s.csv", **settings: object) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, text, name, **settings)
    return str(caught.value).replace(str(folder) + "/", "")


@pytest.mark.parametrize(
    "text",
    [
        LABELLED,
        LABELLED.replace("\n", "\r\n"),
        LABELLED.replace("\n", "\r"),
        LABELLED.replace(",", "\t"),
        LABELLED.replace(",", ";"),
        LABELLED.replace(",", ";").replace(".", ","),
        LABELLED.replace(",", "\t").replace(".", ","),
        LABELLED.replace(",", "  "),
        LABELLED.replace("row,", ","),
        LABELLED.replace("row,", "Zeile,"),
        LABELLED.replace("-", "−"),
        LABELLED.replace("\n", ",\n"),
        "# from the bridge\n\n" + LABELLED + "\n,,,\n,,,\n",
        '"row","B","D","F"\n"2","-350,5","-340","-300"\n"4","-250","-200,5","-100"\n',
        LABELLED.replace("-340", "-340 mV").replace("-100", "-100mV"),
    ],
)
def test_the_same_grid_in_its_usual_shapes(tmp_path: Path, text: str) -> None:
    survey = read(tmp_path, text)
    assert survey.potential_mv.reshape(2, 3).tolist() == VALUES
    assert survey.labels == ("2/B", "2/D", "2/F", "4/B", "4/D", "4/F")
    assert survey.grid is not None
    assert (survey.grid.row_names, survey.grid.column_names) == (("2", "4"), ("B", "D", "F"))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_encodings(tmp_path: Path, encoding: str) -> None:
    survey = read(tmp_path, LABELLED.replace("\n2", "\nSüd").encode(encoding))
    assert survey.labels[0] == "Süd/B"
    assert survey.potential_mv[0] == -350.5


def test_latin_1(tmp_path: Path) -> None:
    text = LABELLED.replace("\n2", "\nSüd")
    assert read(tmp_path, text.encode("latin-1")).labels[0] == "Süd/B"


@pytest.mark.parametrize(
    ("text", "labels"),
    [
        ("-350 -340\n-250 -240\n", ("R1C1", "R1C2", "R2C1", "R2C2")),
        ("A,C\n-350,-340\n-250,-240\n", ("R1/A", "R1/C", "R2/A", "R2/C")),
        ("P,-350,-340\nQ,-250,-240\n", ("P/C1", "P/C2", "Q/C1", "Q/C2")),
        ("row,0,1\n1,-350,-340\n2,-250,-240\n", ("1/0", "1/1", "2/0", "2/1")),
        # A spreadsheet's columns, of which some could name a list's: X, Y and E are no headings.
        ("row,E,F,X,Y\n1,-1,-2,-3,-4\n", ("1/E", "1/F", "1/X", "1/Y")),
        ("-350\n-340\n", ("R1C1", "R2C1")),
    ],
)
def test_labels(tmp_path: Path, text: str, labels: tuple[str, ...]) -> None:
    assert read(tmp_path, text).labels == labels


GRID = "{},{}\n{},-350,-340,-330\n{},-250,-240,-230\n"


@pytest.mark.parametrize(
    ("columns", "rows", "where", "said"),
    [
        ("0,0.5,1.0", ("0", "0.5"), "B1: the names of the columns and rows", "--spacing-m 0.5x0.5"),
        ("0,0.1,0.2", ("0.25", "0"), "B1: the names of the columns and", "--spacing-m 0.1x0.25"),
        ("0,20,40", ("50", "0"), "B1: the names of the columns and rows", "--spacing-m 20x50"),
        ("1,2,3", ("0", "10"), "A2: the names of the columns and rows", "--spacing-m 1x10"),
        ("1.0,2.0,3.0", ("A", "B"), "B1: the names of the columns look", "--spacing-m 1xDV"),
        ("A,B,C", ("0", "0.5"), "A2: the names of the rows look", "--spacing-m DUx0.5"),
        (
            "0,0.5,1.5",
            ("1", "2"),
            "B1: the names of the columns",
            "their steps differ: give a list",
        ),
    ],
)
@pytest.mark.parametrize("corner", ["", "row"])
def test_names_that_are_distances_need_a_spacing(
    tmp_path: Path, corner: str, columns: str, rows: tuple[str, str], where: str, said: str
) -> None:
    text = GRID.format(corner, columns, *rows)
    told = refusal(tmp_path, text)
    assert f"cell {where}" in told
    assert "their unit is not known" in told
    assert said in told
    survey = read(tmp_path, text, spacing_m=[0.5, 0.25])
    assert survey.uv_m[:, 0].max() == 1.0
    assert survey.labels[0] == f"{rows[0]}/{columns.split(',')[0]}"


@pytest.mark.parametrize(
    ("columns", "rows"),
    [
        *(("1,2,3", ("1", "2")), ("0,1,2", ("0", "1")), ("B,D,F", ("2", "4"))),
        *(("1,3,5", ("2", "4")), ("A,B,C", ("10", "20")), ("3,2,1", ("P 1", "P 2"))),
        *(("1,2,4", ("1", "2")), ("7,3,5", ("0.5", "0.5a")), ("0.5,0.1,0.7", ("1", "2"))),
    ],
)
def test_names_that_only_count_need_none(
    tmp_path: Path, columns: str, rows: tuple[str, str]
) -> None:
    assert "spacing_m" in read(tmp_path, GRID.format("row", columns, *rows)).assumed


def test_places_run_right_and_up_from_the_bottom_left(tmp_path: Path) -> None:
    survey = read(tmp_path, LABELLED, spacing_m=[0.5, 0.25], origin_m=(10.0, 20.0))
    expected = [(10, 20.25), (10.5, 20.25), (11, 20.25), (10, 20), (10.5, 20), (11, 20)]
    np.testing.assert_allclose(survey.uv_m, expected, rtol=0, atol=1e-12)
    assert survey.p_W is None
    np.testing.assert_allclose(survey.points_W[1], (10.5, 20.25, 0.0))
    assert survey.assumed == ("potential_unit", "electrode", "orientation")
    wall = read(
        tmp_path, LABELLED, spacing_m=[0.5, 0.25], origin_m=(10.0, 20.0), orientation="upright"
    )
    np.testing.assert_allclose(wall.points_W[1], (10.5, 0.0, 20.25))
    assert wall.assumed == ("potential_unit", "electrode")
    plain = read(tmp_path, LABELLED)
    assert plain.assumed == ("potential_unit", "electrode", "spacing_m", "orientation")
    np.testing.assert_allclose(plain.uv_m[0], (0.0, 0.1016))


def test_gaps_are_kept_with_their_reason(tmp_path: Path) -> None:
    text = "row,A,B,C,D,E,F\n1,-350,,-,n/a,NaN,nan\n2,-1,-2,-3,-4,-5,-6\n"
    survey = read(tmp_path, text)
    assert survey.valid.tolist() == [True] + 5 * [False] + 6 * [True]
    assert survey.why[:3] == ("", "the cell is empty", "the file says '-'")
    assert survey.why[3:6] == ("the file says 'n/a'", "the file says 'NaN'", "the file says 'nan'")
    assert np.isnan(survey.potential_mv[1:6]).all()
    trailing = read(tmp_path, "-1\t-2\t\n-1\t-2\t-30\n")
    assert trailing.valid.tolist() == [True, True, False, True, True, True]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("row,A,B\n1,-1,-2\n2,-3,x\n", "s.csv:3:6: cell C3: 'x' is not a number"),
        ("#a\nrow;A;B\n\n1;-1;inf\n", "s.csv:4:6: cell C4: 'inf' is not a number"),
        ("-1 -2\n-3 1e999\n", "s.csv:2:4: cell B2: '1e999' is not a finite number"),
        ("-1,-2\n-3,-1_000\n", "s.csv:2:4: cell B2: '-1_000' is not a number"),
        ("-1\t-2\n-3\t-1 000\n", "s.csv:2:4: cell B2: '-1 000' is not a number"),
        ("-1;-2\n-3;-1.000,5\n", "s.csv:2:4: cell B2: '-1.000,5' is not a number"),
        ("-1,-2\n-3,50%\n", "s.csv:2:4: cell B2: '50%' is not a number"),
        ("-1,-2\n-3,TRUE\n", "s.csv:2:4: cell B2: 'TRUE' is not a number"),
        ("-1,-2\n-3,-0.3 V\n", "s.csv:2:4: cell B2: '-0.3 V' is in V where the column is in mV"),
        ("-1,-2\n-3,-3 furlongs\n", "s.csv:2:4: cell B2: '-3 furlongs' is not a number"),
        ("-1,-2\n-3\n", "s.csv:2: a row of 1 cells where the first has 2"),
        ("row,A,B\n1,-1,-2,-3\n", "s.csv:2: a row of 4 cells where the first has 3"),
        ("-1;-2,5\n-3;-4.5\n", "s.csv:1:4: cell B1: a decimal comma"),
        ("row,A,A\n1,-1,-2\n", "s.csv:1:7: cell C1: the name 'A' a second time"),
        ("row,A,B\n1,-1,-2\n1,-3,-4\n", "s.csv:3:1: cell A3: the name '1' a second time"),
        ("row,A,B\n", "s.csv: holds no rows of numbers"),
        (
            "",
            "s.csv:1:1: cell A1: the file is empty\n    a grid of readings is expected, or a list",
        ),
        ("\n# nothing\n", "s.csv:1:1: cell A1: the file is empty"),
        (",,\n,,\n", "s.csv:1:1: cell A1: the file is empty"),
        ('"a,-1\n', "s.csv:1: is not CSV"),
        (
            b"\x89PNG\r\n\x1a\n\x00\x00\x01",
            "this is no text: it holds the control character U+001A",
        ),
        (b"\xff\xfe\x00", "s.csv: this is no text: byte 3 (0x00) is no character"),
        (b"a,\x81\n", "s.csv: this is no text: byte 3 (0x81) is no character\n    CSV or an Excel"),
        # Names that stand where readings are expected.
        ("Station,A,B\n1,-1,-2\n2,-3,-4\n3,-5,-6\n", "cell A2: 1 and what follows look like"),
        ("1,2,3\n-350,-340,-330\n", "cell A1: 1 and what follows look like the columns' names"),
        # −350,5 and −340,5 in a file whose cells are separated by commas.
        ("-350,5,-340,5\n-300,1,-200,0\n", "cell B1: every second number looks like the decimals"),
        (",-340\n-350,-330\n", "s.csv:1:1: cell A1: an empty cell beside negative numbers"),
        ("-,n/a\n,nan\n", "cell A1: there is not one reading"),
    ],
)
def test_what_is_uncertain_is_refused_by_its_address(
    tmp_path: Path, text: str | bytes, said: str
) -> None:
    assert said in refusal(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "settings", "said"),
    [
        (
            "-350,-340\n-0.3,-320\n",
            {},
            "s.csv:2:1: cell A2: -0.3 looks like V among readings in mV",
        ),
        ("-0.35,-0.34\n-330,-0.31\n", {}, "s.csv:2:1: cell A2: -330 looks like mV among readings"),
        (
            "-350,-340\n-0.3,-32\n",
            {"potential_unit": "mV"},
            "s.csv:2:1: cell A2: -0.3 looks like V",
        ),
        ("-0.35,-0.34\n-0.3,-0.3\n", {}, "s.csv:1:1: cell A1: -0.35, like all others within"),
        ("-1,-2\n-,3\n", {}, "s.csv:1:1: cell A1: -1, like all others within ±3, looks like volts"),
        ("-350,-340\n-3000,-320\n", {}, "s.csv:2:1: cell A2: -3000 mV is no half-cell potential"),
        (
            "-0.35,-0.34\n-350,-0.3\n",
            {"potential_unit": "V"},
            "s.csv:2:1: cell A2: -350 V is no half-cell",
        ),
        ("350,340\n300,-\n", {}, "s.csv:1:1: cell A1: all potentials are positive, up to 350 mV"),
    ],
)
def test_implausible_potentials_are_refused(
    tmp_path: Path, text: str, settings: dict[str, object], said: str
) -> None:
    assert said in refusal(tmp_path, text, **settings)


def test_hints_name_the_setting(tmp_path: Path) -> None:
    assert "sign: inverted" in refusal(tmp_path, "350,340\n300,-\n")
    assert "--unit V or --unit mV" in refusal(tmp_path, "-0.35,-0.34\n-0.3,-0.3\n")
    assert "potential_unit: mV" in refusal(tmp_path, "-350 -340\n", potential_unit="V")


def test_potentials_near_zero_are_read(tmp_path: Path) -> None:
    """Whole millivolts, and tenths where all have tenths, are no volts."""
    assert read(tmp_path, "-350,-1\n0,1\n").potential_mv.tolist() == [-350, -1, 0, 1]
    text = "-350.2,-12.5\n-0.4,1.3\n"
    assert read(tmp_path, text).potential_mv.tolist() == [-350.2, -12.5, -0.4, 1.3]
    text = "-350.2,-0.4\n"
    assert read(tmp_path, text, potential_unit="mV").potential_mv.tolist() == [-350.2, -0.4]


@pytest.mark.parametrize("value", ["-999", "-999.0", "999", "-9999", "9999", "−99999"])
@pytest.mark.parametrize("settings", [{}, {"sign": "as_read"}, {"sign": "inverted"}])
def test_a_number_for_no_reading_is_refused(
    tmp_path: Path, value: str, settings: dict[str, object]
) -> None:
    said = refusal(tmp_path, f"-100,{value},-300\n-110,{value},-350\n", **settings)
    assert "s.csv:1:6: cell B1: " in said
    assert "(2 times) far from all other readings stands for no reading" in said
    assert "leave the cell empty" in said
    assert ("with the unit, if that was read" in said) == ("9999" not in value)
    listed = refusal(tmp_path, f"x,y,E [V]\n0,0,-0.3\n1,0,{value}\n", **settings)
    assert "cell C3: " in listed
    assert listed.endswith("stands for no reading\n    leave the cell empty")


def test_a_true_reading_that_looks_like_none_is_read(tmp_path: Path) -> None:
    values = [-100, -999, -300, -110, -999, -350]
    stated = read(tmp_path, "-100,-999 mV,-300\n-110,-999,-350\n")
    assert stated.potential_mv.tolist() == values
    near = read(tmp_path, "-940,-999,-1020\n")
    assert near.potential_mv.tolist() == [-940, -999, -1020]
    plausible = read(tmp_path, "-100,0,-300\n-99,99,-350\n")
    assert plausible.valid.all()
    listed = read(tmp_path, "x,y,E\n0,0,-300\n1,0,-999mV\n")
    assert listed.potential_mv.tolist() == [-300, -999]


def test_volts_and_signs(tmp_path: Path) -> None:
    survey = read(tmp_path, "-0.35,-0.3405\n-0.1,0.02\n", potential_unit="V")
    assert survey.potential_mv.tolist() == [-350.0, -340.5, -100.0, 20.0]
    assert read(tmp_path, "350,-20\n", sign="inverted").potential_mv.tolist() == [-350, 20]
    assert read(tmp_path, "350,340\n", sign="as_read").potential_mv.tolist() == [350, 340]


def test_a_list_without_names_is_no_grid(tmp_path: Path) -> None:
    text = "0,0,-350\n0,1,-340\n1,0,-330\n1,1,-320\n"
    said = refusal(tmp_path, text)
    assert "s.csv:1:1: cell A1: the first columns look like coordinates" in said
    assert "layout: list or layout: grid" in said
    assert read(tmp_path, text, layout="grid").potential_mv.size == 12


LIST = "{}\n0{d}0{d}-100\n1{d}0{d}-380\n0{d}1{d}-120\n1{d}1{d}-390\n"


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ("Station,Offset,Reading", "A1: names of columns that are not understood: 'Station', 'Of"),
        ("Spalte;Zeile;Messwert", "not understood: 'Spalte', 'Zeile', 'Messwert'"),
        ("Chainage,Width,mV", "but no x and y; not understood: 'Chainage', 'Width'"),
        ("East,North,Value", "of coordinates, but none of potentials; not understood: 'Value'"),
        ("a,b,c", "the first columns look like coordinates and have no such names"),
        ("A,B,C", "the first columns look like coordinates"),
        ("C1;C2;C3", "the first columns look like coordinates"),
    ],
)
def test_a_list_with_other_names_is_no_grid(tmp_path: Path, names: str, said: str) -> None:
    text = LIST.format(names, d=";" if ";" in names else ",")
    told = refusal(tmp_path, text)
    assert said in told
    assert "x_m,y_m,potential_mv" in told
    assert "layout: grid" in told
    grid = read(tmp_path, text, layout="grid").grid
    assert grid is not None
    assert grid.columns == 3


@pytest.mark.parametrize("corner", ["", "Zeile", "row"])
@pytest.mark.parametrize("names", ["Spalte,Messwert", "East 1,West 1", "A,Value"])
def test_words_beside_names_of_rows_are_no_columns(tmp_path: Path, corner: str, names: str) -> None:
    text = f"{corner},{names}\n1,0,-100\n2,0,-380\n"
    assert "not understood: '" + names.split(",")[0] in refusal(tmp_path, text)
    assert read(tmp_path, text, layout="grid").labels[0] == f"1/{names.split(',')[0]}"


def test_coordinates_are_known_beside_gaps_and_decimal_commas(tmp_path: Path) -> None:
    for text in (
        "a;b;c\n0,5;0;-100\n1,5;0;-\n",
        "0,5;0;-100\n1,5;0;-\n",
        ",a,b,c\n0,1,2,-3\n1,2,2,-4\n",
    ):
        assert "the first columns look like coordinates" in refusal(tmp_path, text)


@pytest.mark.parametrize(
    "names",
    ["A,C,AA", "H,F,D", "a,b,c", "C1,C2,C3", "P 3,P 2,P 1", "Spalte 4,Spalte 5,spalte 6"],
)
@pytest.mark.parametrize("corner", ["", "row,", ",", "Achse,"])
def test_names_that_count_are_a_grid(tmp_path: Path, names: str, corner: str) -> None:
    label = "P," if corner else ""
    survey = read(tmp_path, f"{corner}{names}\n{label}-100,-120,-300\n{label and 'Q,'}-1,-2,-3\n")
    assert survey.grid is not None
    assert survey.grid.column_names == tuple(names.split(","))
    assert survey.potential_mv.tolist() == [-100, -120, -300, -1, -2, -3]


def test_a_grid_may_be_stated_for_both_files(tmp_path: Path) -> None:
    text = "row,North,South\n1,{},{}\n2,{},{}\n"
    (tmp_path / "rho.csv").write_text(text.format(1, 2, 3, 4))
    readings = text.format(-100, -200, -300, -400)
    assert "not understood: 'South'" in refusal(tmp_path, readings)
    survey = read(tmp_path, readings, layout="grid", resistivity="rho.csv")
    assert survey.resistivity_ohm_m.tolist() == [10, 20, 30, 40]


def test_resistivities_of_the_same_grid(tmp_path: Path) -> None:
    (tmp_path / "rho.txt").write_text("18.9\t13.8\t11.8\n5.4\t-\t6.0\n")
    survey = read(tmp_path, LABELLED, resistivity="rho.txt")
    np.testing.assert_allclose(survey.resistivity_ohm_m, [189, 138, 118, 54, np.nan, 60])
    assert survey.valid.all()
    assert "resistivity_unit" in survey.assumed
    assert [file.name for file in survey.files] == ["s.csv", "rho.txt"]
    assert survey.files[0].sha256 == hashlib.sha256(LABELLED.encode()).hexdigest()
    in_ohm_m = read(tmp_path, LABELLED, resistivity="rho.txt", resistivity_unit="ohm_m")
    assert in_ohm_m.resistivity_ohm_m[0] == 18.9
    assert "resistivity_unit" not in in_ohm_m.assumed


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1 2\n3 4\n", "rho.txt: 2 rows × 2 columns of resistivities where s.csv has 2 rows × 3"),
        ("1 2 3\n4 0 6\n", "rho.txt:2:3: cell B2: 0 is not a positive resistivity"),
        ("1 2 3\n4 -5 6\n", "rho.txt:2:3: cell B2: -5 is not a positive resistivity"),
        ("row B D G\n2 1 2 3\n4 4 5 6\n", "rho.txt:1:9: cell D1: the column 'G' stands where"),
        ("row B D F\n2 1 2 3\n5 4 5 6\n", "rho.txt:3:1: cell A3: the row '5' stands where"),
        ("x_m y_m rho_ohm_m\n0 0 100\n", "rho.txt: a list of resistivities where"),
    ],
)
def test_resistivities_of_other_points_are_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "rho.txt").write_text(text)
    assert said in refusal(tmp_path, LABELLED, resistivity="rho.txt")


def test_files_that_are_not_there_or_of_no_use(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.csv: cannot be read as a table: No such file"):
        read_survey(tmp_path / "none.csv")
    with pytest.raises(InputError, match=re.escape("'.xls' files are not read")):
        read_survey(tmp_path / "s.xls")
    assert "s.csv: a text file has no sheet 'A'" in refusal(tmp_path, LABELLED, sheet="A")
    with pytest.raises(InputError, match="cannot be read as a table"):
        read_survey(tmp_path)


@pytest.mark.real_data
@pytest.mark.parametrize("name", ["slab1", "slab2", "slab3", "slab4"])
def test_measured_slabs_are_read_as_numpy_reads_them(shared_data: Path, name: str) -> None:
    folder = shared_data / "half_cell"
    settings = SurveySettings(resistivity="resistivity_S1AC.txt")
    survey = read_survey(folder / f"{name}.csv", settings)
    potential = np.genfromtxt(folder / f"{name}.csv", delimiter=",", skip_header=1)[:, 1:]
    resistivity = np.genfromtxt(folder / "resistivity_S1AC.txt")
    np.testing.assert_array_equal(survey.potential_mv.reshape(29, 9), potential)
    np.testing.assert_allclose(
        survey.resistivity_ohm_m.reshape(29, 9), 10 * resistivity, rtol=1e-15
    )
    assert survey.valid.all()
    assert survey.labels[0] == "2/B"
    assert survey.labels[-1] == "58/R"
    assert survey.warnings == ()
    # 28 and 8 spacings of 4 in between the first and the last reading.
    np.testing.assert_allclose(survey.uv_m[0], (0.0, 28 * 0.1016))
    np.testing.assert_allclose(survey.uv_m[-1], (8 * 0.1016, 0.0))


@pytest.mark.parametrize(
    ("text", "options", "address"),
    [
        ("-300,350\n250,-420\n", {}, "cell B1"),
        ("-200,-350\n-200,-300\n", {"sign": "inverted"}, "cell B1"),
    ],
)
def test_a_sign_that_is_missing_or_turned_is_refused_by_its_cell(
    tmp_path: Path, text: str, options: dict[str, str], address: str
) -> None:
    with pytest.raises(InputError) as refused:
        read(tmp_path, text, **options)
    assert address in str(refused.value)
    assert "more positive than steel" in str(refused.value)


def test_a_positive_reading_may_be_stated(tmp_path: Path) -> None:
    survey = read(tmp_path, "-300,350\n250,-420\n", sign="as_read")
    assert survey.potential_mv[1] == 350.0
