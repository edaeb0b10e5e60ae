"""A survey without a robot, from its file to what is handed over."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from inspect_cli import cli

SLABS = ("slab1", "slab2", "slab3", "slab4")
SMALL = "row,A,B,C\n1,-120,-180,-420\n2,-200,-350,-351\n3,-150,n/a,-199\n"


def reported(folder: Path, *arguments: str) -> dict[str, Any]:
    assert cli.run(["report", "--out", str(folder), *arguments]) == 0
    result: dict[str, Any] = json.loads((folder / "metrics.json").read_text(encoding="utf-8"))
    return result


def surface_of(result: dict[str, Any]) -> dict[str, Any]:
    surface: dict[str, Any]
    (surface,) = result["assessment"]
    return surface


@pytest.mark.real_data
@pytest.mark.parametrize("slab", SLABS)
def test_a_plain_grid_of_millivolts_agrees_with_numpy_to_the_last_digit(
    slab: str, shared_data: Path, tmp_path: Path
) -> None:
    file = shared_data / "half_cell" / f"{slab}.csv"
    surface = surface_of(reported(tmp_path, "--readings", str(file)))
    mv = np.genfromtxt(file, delimiter=",", skip_header=1)[:, 1:].ravel()
    potential = surface["potential"]
    assert potential["min_mv"] == np.min(mv)
    assert potential["max_mv"] == np.max(mv)
    assert potential["median_mv"] == np.median(mv)
    for percent in (5, 10, 25, 50, 75, 90, 95):
        assert potential[f"p{percent}_mv"] == np.percentile(mv, percent)
    shares = {row["name"]: row["share"] for row in surface["astm"]}
    assert shares == {
        "passive": np.mean(mv > -200),
        "uncertain": np.mean((mv <= -200) & (mv >= -350)),
        "active": np.mean(mv < -350),
    }
    assert surface["valid"] == mv.size == 261
    assert surface["gradient"]["minima"] > 0
    assert surface["mixture"]["verdict"] is not None


@pytest.mark.real_data
def test_resistivity_joined_gives_the_table_of_combined_verdicts(
    shared_data: Path, tmp_path: Path
) -> None:
    folder = shared_data / "half_cell"
    rho_file = folder / "resistivity_S1AC.txt"
    result = reported(
        tmp_path, "--readings", str(folder / "slab1.csv"), "--resistivity", str(rho_file)
    )
    surface = surface_of(result)
    mv = np.genfromtxt(folder / "slab1.csv", delimiter=",", skip_header=1)[:, 1:].ravel()
    rho = 10.0 * np.genfromtxt(rho_file).ravel()
    active = (mv < -350) & (rho <= 100.0)
    none = mv > -200
    counts = {row["name"]: row["count"] for row in surface["verdicts"]}
    assert counts == {
        "none": np.sum(none),
        "possible": np.sum(~none & ~active),
        "active": np.sum(active),
    }
    crossed = {
        (row["astm_class"], row["resistivity_class"]): row["count"]
        for row in surface["astm_by_risk"]
    }
    assert crossed["active", "high"] == np.sum(active)
    assert sum(crossed.values()) == 261
    assert [file["name"] for file in result["files"]] == [
        "slab1.csv",
        "resistivity_S1AC.txt",
    ]


@pytest.fixture
def small(tmp_path: Path) -> Path:
    file = tmp_path / "deck.csv"
    file.write_text(SMALL, encoding="utf-8")
    return file


def test_everything_that_is_handed_over(small: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    reported(out, "--readings", str(small), "--pdf", "--export", "geojson,ifc")
    files = {file.name for file in out.iterdir()}
    assert files == {
        *("metrics.json", "readings.csv", "readings.geojson", "readings.ifc"),
        *("report.html", "report.pdf"),
    }
    with (out / "readings.csv").open(encoding="utf-8", newline="") as text:
        rows = list(csv.DictReader(text))
    assert [row["label"] for row in rows][:4] == ["1/A", "1/B", "1/C", "2/A"]
    assert [row["astm_class"] for row in rows] == [
        *("passive", "passive", "active"),
        *("uncertain", "uncertain", "active"),
        *("passive", "", "passive"),
    ]
    assert rows[7]["valid"] == "false"
    assert rows[7]["reason"]
    reported(out, "--readings", str(small))
    assert {file.name for file in out.iterdir()} == {
        *("metrics.json", "readings.csv", "report.html"),
    }


def test_the_electrode_and_the_temperature_move_the_potentials(small: Path, tmp_path: Path) -> None:
    plain = surface_of(reported(tmp_path / "a", "--readings", str(small)))
    sce = surface_of(reported(tmp_path / "b", "--readings", str(small), "--electrode", "SCE"))
    warm = surface_of(reported(tmp_path / "c", "--readings", str(small), "--temperature-c", "32.2"))
    assert sce["potential"]["min_mv"] == plain["potential"]["min_mv"] - 75.0
    assert warm["potential"]["min_mv"] == pytest.approx(plain["potential"]["min_mv"] + 9.0)
    assert sce["basis"]["electrode"] == "SCE"


def test_each_reading_is_corrected_by_its_own_temperature(tmp_path: Path) -> None:
    file = tmp_path / "list.csv"
    file.write_text(
        "x_m,y_m,potential_mv,temperature_c\n0,0,-300,22.2\n1,0,-300,32.2\n2,0,-300,\n",
        encoding="utf-8",
    )
    reported(tmp_path / "out", "--readings", str(file))
    with (tmp_path / "out" / "readings.csv").open(encoding="utf-8", newline="") as text:
        potentials = [float(row["potential_mv"]) for row in csv.DictReader(text)]
    assert potentials == pytest.approx([-300.0, -291.0, -300.0])


def test_readings_of_a_place_that_differ_are_warned_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "twice.csv"
    file.write_text("x,y,potential [mV]\n0,0,-150\n1,0,-156\n1,0,-420\n2,0,-160\n")
    result = reported(tmp_path / "out", "--readings", str(file))
    (warning,) = result["warnings"]
    assert warning.startswith("The readings at the place of point 2 differ by 264 mV;")
    assert f"warning: {warning}" in capsys.readouterr().err
    assert warning in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert surface_of(result)["uncertainty"]["doubtful"] == 1


def test_a_sidecar_says_what_the_file_does_not(small: Path, tmp_path: Path) -> None:
    small.with_name("deck.survey.yaml").write_text(
        "title: Deck of the north span\nspacing_m: 0.5\nelectrode: SCE\nlanguage: de\n",
        encoding="utf-8",
    )
    result = reported(tmp_path / "out", "--readings", str(small))
    assert result["survey"] == "Deck of the north span"
    assert surface_of(result)["area_m2"] == pytest.approx(9 * 0.25)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert '<html lang="de"' in page
    assert "Deck of the north span" in page


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--electrode", "Ag/AgCl"], "electrode"),
        (["--unit", "X"], "choices: mV, V"),
        (["--spacing-m", "wide"], "--spacing-m"),
        (["--spacing-m", "1,5"], "decimal points"),
        (["--spacing-m", "-1"], "spacing_m"),
        (["--export", "dxf"], "dxf"),
        (["--export", ","], "--export names nothing"),
        (["--export", ""], "choices: geojson, ifc"),
        (["--resistivity-unit", "ohm_m"], "there are no resistivities"),
        (["--coordinate-unit", "mm"], "a grid has no coordinates"),
        (["--resistivity", ""], "a path is empty"),
        (["--temperature-c", "55"], "55"),
        (["--resistivity", "nowhere.txt"], "nowhere.txt"),
        (["some/run"], "--readings"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_written(
    small: Path,
    tmp_path: Path,
    arguments: list[str],
    told: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = tmp_path / "out"
    assert cli.run(["report", "--readings", str(small), "--out", str(out), *arguments]) == 2
    assert told in capsys.readouterr().err
    assert not out.exists()


def test_a_cell_that_is_no_number_is_refused_by_its_address(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    small.write_text(SMALL.replace("-351", "wet"), encoding="utf-8")
    assert cli.run(["report", "--readings", str(small), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert f"{small}:3:" in told
    assert "D3" in told


@pytest.mark.parametrize("value", ["-250", "-200", "-350"])
def test_readings_that_are_all_equal_are_reported(value: str, tmp_path: Path) -> None:
    file = tmp_path / "equal.csv"
    file.write_text(f"A,B,C\n{value},{value},{value}\n{value},{value},{value}\n", encoding="utf-8")
    surface = surface_of(reported(tmp_path / "out", "--readings", str(file)))
    assert [row["count"] for row in surface["astm"]] == [0, 6, 0]
    assert surface["mixture"]["verdict"] is None


def test_options_of_readings_are_refused_without_readings(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.run(["report", "somewhere", "--electrode", "SCE"]) == 2
    assert "--readings" in capsys.readouterr().err
    assert cli.run(["report"]) == 2
    assert "nothing to report" in capsys.readouterr().err


def test_two_spacings(small: Path, tmp_path: Path) -> None:
    result = reported(tmp_path / "out", "--readings", str(small), "--spacing-m", "0.5x0.25")
    assert surface_of(result)["area_m2"] == pytest.approx(9 * 0.5 * 0.25)


@pytest.mark.parametrize("beneath", ["", "deeper/still"])
def test_a_file_is_no_folder(
    small: Path, tmp_path: Path, beneath: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    out = tmp_path / "file" / beneath
    assert cli.run(["report", "--readings", str(small), "--out", str(out)]) == 2
    assert "cannot be a folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    "name",
    [
        *("metrics.json", "readings.csv", "report.html", "report.pdf"),
        *("readings.geojson", "readings.ifc"),
    ],
)
@pytest.mark.parametrize("wanted", [[], ["--pdf", "--export", "geojson,ifc"]])
def test_a_folder_where_a_file_has_to_be_is_refused_first(
    name: str,
    wanted: list[str],
    small: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = tmp_path / "out"
    (out / name).mkdir(parents=True)
    small.write_text("wet", encoding="utf-8")  # it is not even read
    assert cli.run(["report", "--readings", str(small), "--out", str(out), *wanted]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert f"{out / name} is a folder" in told
    assert list(out.iterdir()) == [out / name]


@pytest.mark.parametrize("option", ["--out", "--readings"])
def test_an_empty_path_is_not_this_folder(
    option: str,
    small: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(small.parent)
    assert cli.run(["report", "--readings", str(small), option, ""]) == 2
    assert "a path is empty" in capsys.readouterr().err
    assert list(small.parent.iterdir()) == [small]


def test_a_list_has_no_spacing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "list.csv"
    file.write_text("x,y,E\n0,0,-300\n1,0,-310\n", encoding="utf-8")
    asked = ["report", "--readings", str(file), "--out", str(tmp_path / "out")]
    assert cli.run([*asked, "--spacing-m", "1"]) == 2
    assert "a list has coordinates of its own" in capsys.readouterr().err
    assert cli.run(asked) == 0


def test_the_unit_of_what_may_be_volts_has_to_be_stated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "few.csv"
    file.write_text("A,B\n-0.35,-1.8\n-0.3,-0.2\n", encoding="utf-8")
    asked = ["report", "--readings", str(file), "--out", str(tmp_path / "out")]
    assert cli.run(asked) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert f"{file}:2:1: cell A2: -0.35, like all others within ±3, looks like volts" in said
    assert "state the unit: --unit V or --unit mV" in said
    for unit, least in (("V", -1800.0), ("mV", -1.8)):
        found = reported(tmp_path / unit, "--readings", str(file), "--unit", unit)
        assert surface_of(found)["potential"]["min_mv"] == least


@pytest.mark.parametrize("name", [".", ".."])
def test_a_folder_is_no_file_of_readings(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.run(["report", "--readings", name]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert f"{name} is a folder" in told
    assert "name one file of readings" in told


@pytest.mark.parametrize("option", ["--readings", "--resistivity"])
def test_a_report_has_one_file_of_each_kind(
    option: str, small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "other.csv"
    other.write_text(SMALL, encoding="utf-8")
    asked = ["report", "--readings", str(small), option, str(other)]
    asked += [option, str(other)] if option != "--readings" else []
    assert cli.run([*asked, "--out", str(tmp_path / "out")]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert f"{option} is given 2 times" in told
    assert "one file, one surface, one report" in told
    assert not (tmp_path / "out").exists()


def test_more_readings_than_a_model_takes_are_refused_before_anything_is_written(
    small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("inspect_cli.exchange.ifc.MAX_POINTS", 8)
    out = tmp_path / "out"
    asked = ["report", "--readings", str(small), "--out", str(out), "--export"]
    assert cli.run([*asked, "geojson,ifc"]) == 2
    assert "9 readings are too many" in capsys.readouterr().err
    assert not out.exists()
    assert cli.run([*asked, "geojson"]) == 0


def test_the_method_tells_what_the_file_turned_out_to_be(small: Path, tmp_path: Path) -> None:
    assert reported(tmp_path / "a", "--readings", str(small))["settings"]["layout"] == "grid"
    assert "Spacing of a grid" in (tmp_path / "a" / "report.html").read_text(encoding="utf-8")
    file = tmp_path / "list.csv"
    file.write_text("x_m,y_m,E\n0,0,-300\n1,0,-310\n", encoding="utf-8")
    assert reported(tmp_path / "b", "--readings", str(file))["settings"]["layout"] == "list"
    assert "Spacing of a grid" not in (tmp_path / "b" / "report.html").read_text(encoding="utf-8")


def test_settings_that_are_a_folder_are_not_passed_over(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "deck.survey.yaml").mkdir()
    assert cli.run(["report", "--readings", str(small), "--out", str(tmp_path / "out")]) == 2
    assert "deck.survey.yaml" in capsys.readouterr().err
