"""The units that keys end in, so that a wrong suffix can be recognised and converted."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Unit:
    """A suffix of keys: what it measures, its name, and its size in the dimension's SI unit."""

    dimension: str
    name: str
    factor: float = 1.0


UNITS: dict[str, Unit] = {
    "m": Unit("length", "metres"),
    "cm": Unit("length", "centimetres", 1e-2),
    "mm": Unit("length", "millimetres", 1e-3),
    "s": Unit("time", "seconds"),
    "ms": Unit("time", "milliseconds", 1e-3),
    "min": Unit("time", "minutes", 60.0),
    "rad": Unit("angle", "radians"),
    "mrad": Unit("angle", "milliradians", 1e-3),
    "deg": Unit("angle", "degrees", math.pi / 180),
    "n": Unit("force", "newtons"),
    "kn": Unit("force", "kilonewtons", 1e3),
    "nm": Unit("torque", "newton metres"),
    "kg": Unit("mass", "kilograms"),
    "g": Unit("mass", "grams", 1e-3),
    "hz": Unit("frequency", "hertz"),
    "khz": Unit("frequency", "kilohertz", 1e3),
    "mps": Unit("speed", "m/s"),
    "kmh": Unit("speed", "km/h", 1 / 3.6),
    "mps2": Unit("acceleration", "m/s²"),
    "radps": Unit("angular rate", "rad/s"),
    "degps": Unit("angular rate", "degrees per second", math.pi / 180),
    "v": Unit("potential", "volts"),
    "mv": Unit("potential", "millivolts", 1e-3),
    "w": Unit("power", "watts"),
    "wh": Unit("energy", "watt hours", 3600.0),
    "j": Unit("energy", "joules"),
    "npm": Unit("stiffness", "N/m"),
    "nspm": Unit("damping", "N·s/m"),
    "nmprad": Unit("angular stiffness", "N·m/rad"),
    "nmsprad": Unit("angular damping", "N·m·s/rad"),
    "kgm2": Unit("inertia", "kg·m²"),
    "kgpm": Unit("mass per length", "kg/m"),
    "gpm": Unit("mass per length", "g/m", 1e-3),
    "m2": Unit("area", "m²"),
    "cm2": Unit("area", "cm²", 1e-4),
    "ns2": Unit("thrust constant", "N·s²"),
    "ohm": Unit("resistance", "ohms"),
    "ohm_m": Unit("resistivity", "Ω·m"),
    "kohm_cm": Unit("resistivity", "kΩ·cm", 10.0),
    "apm2": Unit("current density", "A/m²"),
    "uapcm2": Unit("current density", "µA/cm²", 1e-2),
    "vpdec": Unit("Tafel slope", "V/decade"),
    "mvpdec": Unit("Tafel slope", "mV/decade", 1e-3),
}

_QUANTITY = re.compile(r"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([A-Za-zµ°/²]+[0-9]?)\s*")


def split_key(key: str) -> tuple[str, Unit | None]:
    """``pitch_cm`` into ``("pitch", centimetres)``; a key without a unit has None."""
    parts = key.split("_")
    for count in (2, 1):
        unit = UNITS.get("_".join(parts[-count:]))
        if unit and len(parts) > count:
            return "_".join(parts[:-count]), unit
    return key, None


def converted(value: float, given: Unit, wanted: Unit) -> float | None:
    """``value`` in the wanted unit, None when the two do not measure the same."""
    if given.dimension != wanted.dimension:
        return None
    return float(f"{value * given.factor / wanted.factor:.12g}")


def parse_quantity(text: str) -> tuple[float, Unit] | None:
    """``"10 cm"`` as 10 and centimetres; None when it is not a number with a known unit."""
    match = _QUANTITY.fullmatch(text)
    if not match:
        return None
    symbol = match[2].lower().replace("/s", "ps").replace("²", "2").replace("°", "deg")
    unit = UNITS.get(symbol)
    try:
        return (float(match[1]), unit) if unit else None
    except ValueError:
        return None
