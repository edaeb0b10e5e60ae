"""Readings in Excel workbooks: stored values of one sheet, or a refusal that names the cell."""

from __future__ import annotations

import datetime
import io
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from inspect_cli.errors import InputError
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.surveys.survey import Survey, read_survey

ROWS: list[list[object]] = [["row", "B", "D"], [2, -350.5, -340], [4, -250, -200]]
Change = Callable[[Any], object]


def book(path: Path, rows: list[list[object]] = ROWS, change: Change = lambda sheet: None) -> Path:
    workbook = openpyxl.Workbook()
    sheet = workbook.active
    sheet.title = "Deck"
    for row in rows:
        sheet.append(row)
    change(sheet)
    workbook.save(path)
    return path


def read(path: Path, **settings: object) -> Survey:
    return read_survey(path, SurveySettings(**settings))  # type: ignore[arg-type]


def refusal(path: Path, **settings: object) -> str:
    with pytest.raises(InputError) as caught:
        read(path, **settings)
    return str(caught.value).replace(str(path.parent) + "/", "")


@pytest.mark.parametrize("name", ["s.xlsx", "s.xlsm", "S.XLSX"])
def test_a_grid(tmp_path: Path, name: str) -> None:
    survey = read(book(tmp_path / name))
    assert survey.labels == ("2/B", "2/D", "4/B", "4/D")
    assert survey.potential_mv.tolist() == [-350.5, -340, -250, -200]
    assert survey.warnings == ()


def test_a_list_with_gaps_text_and_unread_dates(tmp_path: Path) -> None:
    day = datetime.datetime(2025, 3, 31, 12, 0)
    rows: list[list[object]] = [
        ["Point", "X (mm)", "Y (mm)", "E [mV]", "taken"],
        ["A", 0, 500, -350, day],
        ["B", 100, 500, None, day],
        ["C", 200, 500, "n/a", day],
        [None, None, None, None, None],
        [17, 300, "500", "-300,5", day],
    ]
    survey = read(book(tmp_path / "s.xlsx", rows))
    assert survey.labels == ("A", "B", "C", "17")
    assert survey.valid.tolist() == [True, False, False, True]
    assert survey.why[1:3] == ("the cell is empty", "the file says 'n/a'")
    assert survey.potential_mv[3] == -300.5
    assert survey.uv_m[3].tolist() == [0.3, 0.5]


def test_a_table_may_stand_anywhere_below_comments(tmp_path: Path) -> None:
    def shift(sheet: Any) -> None:
        sheet.insert_rows(1, 3)
        sheet.insert_cols(1, 2)
        sheet["A1"] = "# measured on a wet deck"

    path = book(tmp_path / "s.xlsx", change=shift)
    assert read(path).potential_mv.tolist() == [-350.5, -340, -250, -200]

    def spoil(sheet: Any) -> None:
        shift(sheet)
        sheet["E6"] = "wet"

    assert "s.xlsx: Deck!E6: 'wet' is not a number" in refusal(
        book(tmp_path / "s.xlsx", change=spoil)
    )


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("wet", "'wet' is not a number"),
        (True, "the truth value TRUE is not a plain number"),
        (datetime.datetime(2025, 3, 31), "the date or time 2025-03-31 00:00:00 is not a plain"),
        (datetime.time(12, 30), "the date or time 12:30:00 is not a plain"),
        ("#DIV/0!", "the error #DIV/0! is not a plain number"),
        ("inf", "'inf' is not a number"),
        ("-0.3 V", "'-0.3 V' is in V where the column is in mV"),
        ("=B2-10", "a formula without a stored value"),
        (-0.3, "-0.3 looks like V among readings in mV"),
        (-9998, "-9998 mV is no half-cell potential"),
        (-9999, "-9999 far from all other readings stands for no reading"),
    ],
)
def test_cells_that_are_no_potentials(tmp_path: Path, value: object, said: str) -> None:
    path = book(tmp_path / "s.xlsx", [*ROWS[:2], [4, -250, value]])
    assert f"s.xlsx: Deck!C3: {said}" in refusal(path)


def test_percentages(tmp_path: Path) -> None:
    def percent(sheet: Any) -> None:
        sheet["C3"] = -0.5
        sheet["C3"].number_format = "0.0%"

    assert "s.xlsx: Deck!C3: the percentage -50 %" in refusal(
        book(tmp_path / "s.xlsx", change=percent)
    )


def test_merged_cells_are_refused_within_the_table_alone(tmp_path: Path) -> None:
    inside = book(tmp_path / "s.xlsx", change=lambda s: s.merge_cells("B2:C2"))
    assert "s.xlsx: Deck!B2:C2: merged cells within the table" in refusal(inside)
    outside = book(tmp_path / "s.xlsx", change=lambda s: s.merge_cells("B9:C9"))
    assert read(outside).potential_mv[0] == -350.5


def test_empty_rows_within_a_grid_are_refused(tmp_path: Path) -> None:
    path = book(tmp_path / "s.xlsx", change=lambda s: s.insert_rows(3, 2))
    assert "s.xlsx: Deck!A5: empty rows above this one" in refusal(path)


def test_hidden_rows_and_columns_are_told(tmp_path: Path) -> None:
    def hide(sheet: Any) -> None:
        sheet.row_dimensions[3].hidden = True
        sheet.column_dimensions["C"].hidden = True

    survey = read(book(tmp_path / "s.xlsx", change=hide))
    assert survey.potential_mv.size == 4
    assert survey.warnings == ("Deck: 1 hidden rows and 1 hidden columns were read, too.",)


def test_formulas_count_with_their_stored_value(tmp_path: Path) -> None:
    path = book(tmp_path / "s.xlsx", [*ROWS[:2], [4, -250, "=-100-100"]])
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    name = "xl/worksheets/sheet1.xml"
    assert b"<f>-100-100</f><v />" in parts[name] or b"<f>-100-100</f><v/>" in parts[name]
    for empty in (b"<v />", b"<v/>"):
        parts[name] = parts[name].replace(b"</f>" + empty, b"</f><v>-200</v>")
    with zipfile.ZipFile(path, "w") as archive:
        for part, data in parts.items():
            archive.writestr(part, data)
    assert read(path).potential_mv.tolist() == [-350.5, -340, -250, -200]


def test_a_column_of_formulas_does_not_vanish(tmp_path: Path) -> None:
    rows: list[list[object]] = [["=1", "=2"], ["=3", "=4"]]
    path = book(
        tmp_path / "s.xlsx",
        [[*row, extra] for row, extra in zip([[-1, -2]] * 2, ["=1"] * 2, strict=True)],
    )
    assert "s.xlsx: Deck!C1: a formula without a stored value" in refusal(path)
    said = refusal(book(tmp_path / "t.xlsx", rows))
    assert "t.xlsx: Deck!A1: the sheet is empty" in said
    assert "a grid of readings is expected, or a list with columns x, y and potential" in said
    assert "a formula counts with the value that was stored with it" in said


def test_sheets_are_chosen_by_name(tmp_path: Path) -> None:
    def second(sheet: Any) -> None:
        other = sheet.parent.create_sheet("Soffit")
        other.append([-10, -20])
        sheet.parent.create_sheet("Empty")
        hidden = sheet.parent.create_sheet("Old")
        hidden.append([-30, -40])
        hidden.sheet_state = "hidden"

    path = book(tmp_path / "s.xlsx", change=second)
    said = refusal(path)
    assert "s.xlsx: several sheets hold something" in said
    assert "choose one with sheet: Deck, Soffit\n" in said + "\n"
    assert read(path, sheet="Soffit").potential_mv.tolist() == [-10, -20]
    assert read(path, sheet="Old").potential_mv.tolist() == [-30, -40]
    said = refusal(path, sheet="deck")
    assert "s.xlsx: has no sheet 'deck'" in said
    assert "choices: Deck, Soffit, Empty, Old" in said
    assert "s.xlsx: Empty!A1: the sheet is empty" in refusal(path, sheet="Empty")


def test_a_hidden_sheet_is_not_taken_unasked(tmp_path: Path) -> None:
    def hide(sheet: Any) -> None:
        sheet.parent.create_sheet("Cover")
        sheet.sheet_state = "hidden"

    path = book(tmp_path / "s.xlsx", change=hide)
    assert "s.xlsx: no visible sheet holds anything" in refusal(path)
    assert read(path, sheet="Deck").potential_mv[0] == -350.5


def test_a_cell_far_away_is_refused_quickly(tmp_path: Path) -> None:
    def far(sheet: Any) -> None:
        sheet["XFD1048576"] = "x"

    assert "s.xlsx: Deck!" in refusal(book(tmp_path / "s.xlsx", change=far))


def test_damaged_workbooks(tmp_path: Path) -> None:
    path = tmp_path / "s.xlsx"
    path.write_bytes(b"row,B\n1,-3\n")
    assert "s.xlsx: cannot be read as a workbook" in refusal(path)
    whole = book(tmp_path / "t.xlsx").read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert "s.xlsx: cannot be read as a workbook" in refusal(path)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("hello.txt", "hello")
    path.write_bytes(buffer.getvalue())
    assert "s.xlsx: cannot be read as a workbook" in refusal(path)
