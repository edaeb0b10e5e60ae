"""The units that headings and cells of surveys are written in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Dimension = Literal["length", "potential", "resistivity", "temperature"]


@dataclass(frozen=True)
class Unit:
    """A unit and what it is in the one that this room hands on: m, mV, Ω·m, °C."""

    key: str
    """As settings write it."""
    name: str
    dimension: Dimension
    factor: float


UNITS = {
    unit.key: unit
    for unit in (
        Unit("m", "m", "length", 1.0),
        Unit("cm", "cm", "length", 0.01),
        Unit("mm", "mm", "length", 0.001),
        Unit("ft", "ft", "length", 0.3048),
        Unit("in", "in", "length", 0.0254),
        Unit("mV", "mV", "potential", 1.0),
        Unit("V", "V", "potential", 1000.0),
        Unit("ohm_m", "Ω·m", "resistivity", 1.0),
        Unit("kohm_cm", "kΩ·cm", "resistivity", 10.0),
        Unit("ohm_cm", "Ω·cm", "resistivity", 0.01),
        Unit("c", "°C", "temperature", 1.0),
    )
}
_IGNORED = str.maketrans("", "", " \u00a0·•⋅*._-")


def _folded(text: str) -> str:
    # casefold() makes Ω, the letter and the ohm sign alike, an ω.
    return text.casefold().translate(_IGNORED).replace("ω", "ohm").replace("°", "")


_BY_NAME = {_folded(unit.key): unit for unit in UNITS.values()} | {
    "degc": UNITS["c"],
    "metre": UNITS["m"],
    "meter": UNITS["m"],
    "inch": UNITS["in"],
    '"': UNITS["in"],
    "feet": UNITS["ft"],
}


def unit_named(text: str) -> Unit | None:
    """The unit that a text names, however it is written; None if it names none."""
    return _BY_NAME.get(_folded(text))
