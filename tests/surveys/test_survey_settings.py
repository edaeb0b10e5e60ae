"""The settings beside a file of readings, and the options that come before them."""

from __future__ import annotations

import datetime
from pathlib import Path

import pytest

from inspect_cli.errors import InputError, SchemaError
from inspect_cli.surveys.settings import read_settings, sidecar_of
from inspect_cli.surveys.survey import read_survey

FULL = """\
potential_unit: V
electrode: Ag/AgCl 1 M KCl
sign: inverted
orientation: upright
temperature_c: 14.5
layout: grid
spacing_m: [0.5, 0.25]
origin_m: [1, 2]
coordinate_unit: mm
seen_from_m: [0, -5, 1]
georeference: {longitude_deg: 8.5, latitude_deg: 47.4, heading_deg: 30}
resistivity: rho.txt
resistivity_unit: ohm_m
sheet: Deck
title: Deck of the north ramp
structure: Bridge 12
client: City
inspector: M. Muster
date: 2025-03-31
language: de
"""


def settings_file(folder: Path, text: str) -> Path:
    (folder / "slab.survey.yaml").write_text(text, encoding="utf-8")
    return folder / "slab.csv"


def test_every_key_is_read(tmp_path: Path) -> None:
    settings = read_settings(settings_file(tmp_path, FULL))
    assert settings.model_fields_set == set(type(settings).model_fields)
    assert settings.electrode == "Ag/AgCl 1 M KCl"
    assert settings.spacing_m == (0.5, 0.25)
    assert settings.georeference is not None
    assert settings.georeference.heading_deg == 30
    assert settings.date == "2025-03-31"


def test_without_a_file_all_is_default(tmp_path: Path) -> None:
    assert sidecar_of(tmp_path / "slab.xlsx") == tmp_path / "slab.survey.yaml"
    settings = read_settings(tmp_path / "slab.csv")
    assert settings.model_fields_set == set()
    assert settings.spacing_m == (0.1016, 0.1016)


def test_today_and_tomorrow_are_no_future(tmp_path: Path) -> None:
    """Where the file was written, the day may have begun already."""
    today = datetime.date.today()
    for days in (0, 1):
        day = (today + datetime.timedelta(days)).isoformat()
        assert read_settings(settings_file(tmp_path, f"date: {day}\n")).date == day
    late = (today + datetime.timedelta(3)).isoformat()
    with pytest.raises(SchemaError, match="is in the future"):
        read_settings(settings_file(tmp_path, f"date: {late}\n"))


def test_options_come_before_the_file(tmp_path: Path) -> None:
    readings = settings_file(tmp_path, "spacing_m: 0.5\nelectrode: SCE\nresistivity: rho.txt\n")
    options = {"spacing_m": (0.2, 0.3), "resistivity": "here.txt", "title": None}
    settings = read_settings(readings, options)
    assert settings.spacing_m == (0.2, 0.3)
    assert settings.electrode == "SCE"
    assert settings.resistivity == str(Path("here.txt").absolute())
    assert settings.model_fields_set == {"spacing_m", "electrode", "resistivity"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("electrode: Ag/AgCl\n", "slab.survey.yaml:1:12: electrode: no such choice: Ag/AgCl"),
        ("electrode: AgCl\n", "choices: CSE, SCE, Ag/AgCl sat. KCl, Ag/AgCl 1 M KCl, Ag/AgCl 0.1"),
        ("a: 1\n", "slab.survey.yaml:1:1: a: unknown key 'a'"),
        ("spacing_m: 0\n", "slab.survey.yaml:1:12: spacing_m"),
        ("spacing_m: [1, -1]\n", "slab.survey.yaml:1:16: spacing_m[1]: must be at least 0.001"),
        ("spacing_m: 1e300\n", "slab.survey.yaml:1:12: spacing_m: must be at most 1000"),
        ("origin_m: [0, 1e9]\n", "slab.survey.yaml:1:15: origin_m[1]: must be at most 1e+08"),
        ("seen_from_m: [-1e9, 0, 0]\n", "slab.survey.yaml:1:15: seen_from_m[0]: must be at least"),
        ("spacing_m: wide\n", "give one number, or [between columns, between rows]"),
        ("spacing_cm: 5\n", "spacing_m: 0.05"),
        ("date: 31.3.2025\n", "slab.survey.yaml:1:7: date: a date is written as 2025-03-31"),
        ("date: 2025-02-30\n", "a date is written as 2025-03-31; found '2025-02-30'"),
        ("date: 2999-01-01\n", "slab.survey.yaml:1:7: date: 2999-01-01 is in the future"),
        ("temperature_c: 300\n", "slab.survey.yaml:1:16: temperature_c: must be at most 60"),
        ("language: fr\n", "choices: en, de"),
        ("sign: inverted\nsign: as_read\n", "slab.survey.yaml:2:1: sign: the key 'sign' a second"),
        ("title: [\n", "slab.survey.yaml:2:1"),
        ("georeference: {longitude_deg: 8}\n", "missing key 'latitude_deg'"),
    ],
)
def test_bad_settings_are_refused_by_their_place(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(SchemaError) as caught:
        read_settings(settings_file(tmp_path, text))
    assert said in str(caught.value)


def test_bad_options_are_refused_by_their_name(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read_settings(tmp_path / "slab.csv", {"electrode": "Ag/AgCl", "spacing_m": (0.0, 1.0)})
    assert "option: electrode: no such choice: Ag/AgCl" in str(caught.value)
    assert "option: spacing_m[0]: must be at least 0.001" in str(caught.value)


@pytest.mark.parametrize("number", ["-1", ".nan", "0"])
def test_a_number_that_stands_for_a_pair_is_refused_once(tmp_path: Path, number: str) -> None:
    with pytest.raises(SchemaError) as caught:
        read_settings(settings_file(tmp_path, f"spacing_m: {number}\n"))
    (problem,) = caught.value.problems
    assert str(problem.where).endswith("slab.survey.yaml:1:12: spacing_m")
    with pytest.raises(InputError) as option:
        read_settings(tmp_path / "other.csv", {"spacing_m": float(number.lstrip("."))})
    assert len(option.value.problems) == 1


def test_the_settings_reach_the_survey(tmp_path: Path) -> None:
    readings = settings_file(tmp_path, "potential_unit: V\nresistivity: rho.txt\nsign: inverted\n")
    readings.write_text("0.35,0.34\n0.3,0.2\n")
    (tmp_path / "rho.txt").write_text("1 2\n3 4\n")
    survey = read_survey(readings, read_settings(readings))
    assert survey.potential_mv.tolist() == [-350, -340, -300, -200]
    assert survey.resistivity_ohm_m.tolist() == [10, 20, 30, 40]
