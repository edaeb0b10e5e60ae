"""What the names of a list's columns say: ``X (mm)``, ``E_mV``, ``Potenzial [mV vs SCE]``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from inspect_cli.schema.survey import Electrode
from inspect_cli.surveys.cells import Cells, Odd
from inspect_cli.surveys.units import Dimension, Unit, unit_named

Role = Literal[
    "x", "y", "z", "u", "v", "potential", "resistivity", "temperature", "label", "surface"
]

DIMENSIONS: dict[str, Dimension] = {
    **dict.fromkeys(("x", "y", "z", "u", "v"), "length"),
    "potential": "potential",
    "resistivity": "resistivity",
    "temperature": "temperature",
}
_NAMES: dict[str, Role] = {
    **{axis: axis for axis in ("x", "y", "z", "u", "v")},
    **dict.fromkeys(("easting", "east", "rechtswert"), "x"),
    **dict.fromkeys(("northing", "north", "hochwert"), "y"),
    **dict.fromkeys(("e", "ecorr", "hcp", "halfcell", "mv"), "potential"),
    **dict.fromkeys(("rho", "ρ"), "resistivity"),
    **dict.fromkeys(("temperature", "temperatur", "temp", "t"), "temperature"),
    **dict.fromkeys(
        ("label", "name", "id", "point", "punkt", "messpunkt", "nr", "no", "bezeichnung"), "label"
    ),
    **dict.fromkeys(("surface", "fläche"), "surface"),
}
_PARTS: tuple[tuple[str, Role], ...] = (
    ("potential", "potential"),
    ("potenzial", "potential"),
    ("resistivity", "resistivity"),
    ("spezwiderstand", "resistivity"),
    ("spezifischerwiderstand", "resistivity"),
)
_AXIS_WORDS = re.compile(r"coordinates?|koordinaten?|coord|pos|position|achse|axis")
_SEPARATORS = re.compile(r"[\s_.\-]+")
_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*(.*?)\s*[\])]\s*")
_ELECTRODES: dict[str, Electrode] = {
    "cse": "CSE",
    "cu/cuso4": "CSE",
    "sce": "SCE",
}
_SILVER = ("ag/agcl", "agcl", "ssc")
_FILLERS = frozenset({"vs", "vs.", "versus", "gegen", "against", "ggü."})


@dataclass(frozen=True)
class Heading:
    """A column's name, understood."""

    role: Role | None
    """None for a column that is not read."""
    unit: Unit | None
    """None where the name has none."""
    electrode: Electrode | Literal["silver chloride"] | None = None
    """What the name says that potentials were read against."""


def headings(cells: Cells) -> list[Heading]:
    """The names in the first row.

    Raises:
        InputError: a name that is read carries a unit or a note that is not understood, with its
            address.
    """
    return [_heading(cells, j) for j in range(cells.width)]


def _heading(cells: Cells, j: int) -> Heading:
    value = cells.rows[0][j]
    if isinstance(value, Odd | float):
        return Heading(None, None)
    stem, note = _split(value.strip())
    role = _role(stem)
    if role is None:
        return Heading(None, None)
    unit, electrode, rest = _understood(note)
    wanted = DIMENSIONS.get(role)
    if rest or (unit and unit.dimension != wanted):
        if stem.casefold() == "t" and not unit:
            return Heading(None, None)  # "T (remarks)" need not be a temperature
        what = f"the heading {value.strip()!r} has no unit of {wanted or 'anything'}: {note!r}"
        raise cells.refused(0, j, what, _choices(wanted))
    if unit is None and wanted == "potential":
        unit = unit_named(stem)  # a heading that is nothing but "mV"
    return Heading(role, unit, electrode)


def _choices(dimension: Dimension | None) -> str:
    names = {
        "length": "m, cm, mm, ft, in",
        "potential": "mV, V, with the electrode if it is written: mV CSE",
        "resistivity": "kohm_cm, ohm_m, ohm_cm",
        "temperature": "°C",
    }
    return f"choices: {names[dimension]}" if dimension else "such a name has no unit"


def _split(name: str) -> tuple[str, str]:
    """A name's stem and what it says of its unit."""
    bracketed = _BRACKETS.fullmatch(name)
    if bracketed:
        return bracketed[1], bracketed[2]
    for separator in ("/", " in "):
        stem, found, unit = name.partition(separator)
        if found and unit_named(unit):
            return stem, unit.strip()
    parts = [p for p in re.split(r"[\s_]+", name) if p]
    for count in (2, 1):
        if len(parts) > count and unit_named("".join(parts[-count:])):
            return " ".join(parts[:-count]), "".join(parts[-count:])
    return name, ""


def _role(stem: str) -> Role | None:
    key = _SEPARATORS.sub("", stem.casefold())
    if key.startswith("true"):
        return None  # what a simulation adds to its readings
    if key.endswith("sd"):
        return None  # how uncertain a value is, not the value
    bare = _AXIS_WORDS.sub("", key)
    if bare in ("x", "y", "z", "u", "v"):
        key = bare
    if key in _NAMES:
        return _NAMES[key]
    return next((role for part, role in _PARTS if part in key), None)


def _understood(
    note: str,
) -> tuple[Unit | None, Electrode | Literal["silver chloride"] | None, Sequence[str]]:
    """Unit and electrode that a note names, and the words that it says besides."""
    whole = unit_named(note) if note else None
    if whole or not note:
        return whole, None, ()
    unit: Unit | None = None
    electrode: Electrode | Literal["silver chloride"] | None = None
    rest: list[str] = []
    for word in re.split(r"[\s,;]+", note.casefold()):
        found = unit_named(word)
        if word in _ELECTRODES:
            electrode = _ELECTRODES[word]
        elif word in _SILVER:
            electrode = "silver chloride"
        elif found and unit is None:
            unit = found
        elif word not in _FILLERS:
            rest.append(word)
    return unit, electrode, rest
