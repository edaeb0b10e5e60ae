"""How the points of an instrument from outside are shown, beside those of a half-cell."""

from __future__ import annotations

import csv
import html
import json
import re
from pathlib import Path

import ifcopenshell
import ifcopenshell.util.element
import pytest

LEGEND = """
import sys
from pathlib import Path
from inspect_cli.commands.pictures import mark_styles
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.pictures.direction import direct

log = read_log(Path(sys.argv[1]))
print([entry.label for entry in direct(log, evaluate(log), mark_styles("en")).script.legend])
"""
"""Prints what the pictures of a flight explain."""


def in_terminal(said: str) -> None:
    """Each instrument has a table of its own points."""
    values, potentials = said.split("points of thermometer")[1].split("points ", 1)
    rows = [line.split() for line in values.splitlines() if "valid" in line]
    assert [row[:2] for row in rows] == [["1", "valid"], ["2", "valid"]]
    assert [float(row[2]) for row in rows] == pytest.approx([17.6, 17.4], abs=0.02)
    assert "temperature" in values
    assert "/°C" in values
    assert [line.split()[0] for line in potentials.splitlines() if " valid  " in line] == ["3"]


def section(page: str, name: str) -> str:
    """The text of a section, its cells apart; empty where the page has no such section."""
    found = re.search(rf'<section id="{name}".*?</section>', page, re.DOTALL)
    text = re.sub(r"<script.*?</script>", "", found.group() if found else "", flags=re.DOTALL)
    return re.sub(r"(\s*\|\s*)+", " | ", html.unescape(re.sub(r"<[^>]+>", "|", text)))


def scene(page: str) -> dict[str, list[str]]:
    """What the view of the structure shows under the pointer, by the names of its traces."""
    found = re.search(r'data-plot="plot-scene"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert found
    return {t["name"]: t["customdata"] for t in json.loads(found[1])["data"] if "customdata" in t}


def on_page(page: str) -> None:
    """A generic table beside the package's own chapter; the half-cell's shows its own point."""
    readings, potentials = section(page, "readings"), section(page, "survey")
    assert "temperature | °C" in readings
    for label, celsius in (("1", 17.6), ("2", 17.4)):
        row = re.search(rf"\| {label} \| wall \| [^|]+ \| [^|]+ \| ([0-9.]+) \|", readings)
        assert row
        assert float(row[1]) == pytest.approx(celsius, abs=0.02)
    assert readings.count("| valid |") == 2
    assert "| 1 | wall |" not in potentials
    assert "| 3 | wall |" in potentials
    assert "2 of 2 readings of the instrument “thermometer” are valid." in section(page, "summary")
    assert re.search(r"Point 1: 17\.(59|60|61) degrees\.", section(page, "temperatures"))
    marks = scene(page)
    assert len(marks["valid readings"]) == 1
    first, second = marks["valid readings of thermometer"]
    assert re.fullmatch(r"1<br>temperature 17\.[0-9]+ °C", first)
    assert second.startswith("2<br>")
    assert "invalid readings" not in marks


def handed_out(flown: Path) -> None:
    """Every export has name, value and unit, and whether the reading is valid."""
    with (flown / "readings.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["instrument"] for row in rows] == ["thermometer", "thermometer", ""]
    assert [row["temperature_unit"] for row in rows] == ["°C", "°C", ""]
    assert [row["valid"] for row in rows] == ["true"] * 3
    assert float(rows[1]["temperature"]) == pytest.approx(17.4, abs=0.02)
    features = json.loads((flown / "readings.geojson").read_text(encoding="utf-8"))["features"]
    first, _, potential = (feature["properties"] for feature in features)
    assert first["temperature"] == pytest.approx(17.6, abs=0.02)
    assert (first["temperature_unit"], first["valid"]) == ("°C", True)
    assert potential["temperature"] is None
    model = ifcopenshell.open(str(flown / "readings.ifc"))
    sets = [
        ifcopenshell.util.element.get_psets(proxy)
        for proxy in model.by_type("IfcBuildingElementProxy")
    ]
    assert [list(found) for found in sets] == [
        ["InstrumentReading"],
        ["InstrumentReading"],
        ["HalfCellPotential"],
    ]
    held = sets[0]["InstrumentReading"]
    assert held["temperature"] == pytest.approx(17.6, abs=0.02)
    assert (held["temperature unit"], held["Valid"]) == ("°C", True)


def without_half_cell(flown: Path) -> None:
    """The half-cell has no chapter, no marks and no potentials where it read nothing."""
    page = (flown / "report.html").read_text(encoding="utf-8")
    assert not section(page, "survey")
    assert "Half-cell readings" not in section(page, "flight")
    assert set(scene(page)) == {"valid readings of thermometer"}
    handed = json.loads((flown / "readings.geojson").read_text(encoding="utf-8"))
    assert "potential_reference" not in handed
    assert "potential_mv" not in handed["features"][0]["properties"]
