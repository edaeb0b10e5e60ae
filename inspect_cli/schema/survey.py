"""``<readings>.survey.yaml``: what a file of readings does not say about itself.

Every key has a default, so that a plain table of millivolts needs no settings. What was not
given is told as assumed by whoever reads the file (``model_fields_set`` knows).
"""

from __future__ import annotations

import datetime
from typing import Annotated, Literal, TypeAlias

from pydantic import AfterValidator, BeforeValidator, Field

from inspect_cli.schema.base import Strict

Electrode = Literal[
    "CSE", "SCE", "Ag/AgCl sat. KCl", "Ag/AgCl 1 M KCl", "Ag/AgCl 0.1 M KCl"
]  # fmt: skip
"""Reference electrodes. Silver chloride is named with its filling, on which it depends."""
PotentialUnit = Literal["mV", "V"]
LengthUnit = Literal["m", "cm", "mm", "ft", "in"]
ResistivityUnit = Literal["kohm_cm", "ohm_m", "ohm_cm"]
LanguageCode = Literal["en", "de"]
"""The languages of a report."""

FOUR_INCHES_M = 0.1016
MOST_M = 1e8
"""Coordinates beyond it are none: those of national grids reach 10 000 km, and at ten times that a
double still tells 15 nm apart."""

Coordinate = Annotated[float, Field(ge=-MOST_M, le=MOST_M)]
Between = Annotated[float, Field(ge=1e-3, le=1e3)]
"""From reading to reading, m: no electrode is finer than a millimetre."""


def _pair(value: object) -> object:
    """One number stands for both spacings."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return (float(value), float(value))
    if isinstance(value, tuple | list) and len(value) == 2:
        return tuple(value)
    raise ValueError("give one number, or [between columns, between rows]")


Spacings: TypeAlias = Between | tuple[Between, Between]
"""What a file may say."""


def _day(value: str) -> str:
    try:
        day = datetime.date.fromisoformat(value).isoformat()
    except ValueError:
        day = ""
    if day != value:
        raise ValueError(f"a date is written as 2025-03-31; found {value!r}")
    # Somewhere on Earth it may be tomorrow already.
    if datetime.date.fromisoformat(value) > datetime.date.today() + datetime.timedelta(days=1):
        raise ValueError(f"{value} is in the future: give the day when the readings were taken")
    return value


class Georeference(Strict):
    """Where on the Earth (WGS 84) the coordinates of readings begin, and how they are turned."""

    longitude_deg: Annotated[float, Field(ge=-180, le=180)]
    latitude_deg: Annotated[float, Field(gt=-90, lt=90)]
    height_m: Annotated[float, Field(ge=-1000, le=10000)] = 0.0
    """Above the ellipsoid."""
    heading_deg: Annotated[float, Field(ge=-360, le=360)] = 0.0
    """Of the y axis, clockwise from true north; at 0, x points east."""


class SurveySettings(Strict):
    """How the readings of one file were taken, and who they belong to."""

    potential_unit: PotentialUnit = "mV"
    electrode: Electrode = "CSE"
    """What the potentials were read against."""
    sign: Literal["as_read", "inverted"] = "as_read"
    """``inverted``: the device showed −350 mV as 350."""
    temperature_c: Annotated[float, Field(ge=-30, le=60)] | None = None
    """Of the concrete and the electrode; a column of temperatures comes before it."""
    layout: Literal["grid", "list"] | None = None
    """Without it, the file's header tells."""
    spacing_m: Annotated[
        tuple[Between, Between], BeforeValidator(_pair, json_schema_input_type=Spacings)
    ] = (
        FOUR_INCHES_M,
        FOUR_INCHES_M,
    )
    """Of a grid: between its columns, between its rows."""
    origin_m: tuple[Coordinate, Coordinate] = (0.0, 0.0)
    """(u, v) of a grid's reading at the bottom left; added to the coordinates of a list."""
    coordinate_unit: LengthUnit = "m"
    """Of a list's coordinates where the header has no unit."""
    orientation: Literal["level", "upright"] = "level"
    """How a grid or a list without z lies in space: ``level`` like a deck, u along x and v along
    y, or ``upright`` like a wall, u along x and v along z."""
    seen_from_m: tuple[Coordinate, Coordinate, Coordinate] | None = None
    """A place before the surface, in the coordinates of a list with x, y and z."""
    georeference: Georeference | None = None
    """For exports to maps."""
    resistivity: str | None = None
    """File of resistivities at the same points, relative to the file of readings."""
    resistivity_unit: ResistivityUnit = "kohm_cm"
    sheet: str | None = None
    """Of a workbook."""
    title: str | None = None
    structure: str | None = None
    client: str | None = None
    inspector: str | None = None
    date: Annotated[str, AfterValidator(_day)] | None = None
    """When the readings were taken, such as 2025-03-31."""
    language: LanguageCode = "en"
    """Of the report."""
