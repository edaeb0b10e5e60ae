"""Readings as GeoJSON (RFC 7946), one feature per point.

RFC 7946 has coordinates in WGS 84. With a georeference they are: longitude, latitude, height.
Without one they are local metres x, y, z, which section 4 allows among parties that agree on it;
the foreign member ``coordinate_system`` says so, since no reader could tell.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from operator import attrgetter

import numpy as np

from inspect_cli.exchange.earth import on_earth
from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.exchange.readings_csv import FIELDS, value_columns
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.survey import Georeference

DEGREE_DIGITS = 10
"""1e-10° is 0.01 mm."""
HEIGHT_DIGITS = 5

LOCAL = {
    "kind": "local engineering coordinates",
    "axes": ["x", "y", "z"],
    "unit": "metre",
    "note": "not WGS 84: no georeference was given",
}


def geojson(readings: HandedReadings, georeference: Georeference | None = None) -> str:
    """A FeatureCollection; the same readings give the same text.

    The properties of a feature are the label, the surface, (u, v) and the fields of its
    PointResult under their own names, which hold the unit. A field that no point has is left
    out, one that this point lacks is null.
    """
    points = readings.points
    columns = _columns(readings)
    names = list(columns)
    head = {
        "type": "FeatureCollection",
        "name": readings.title,
        "coordinate_system": _system(georeference),
        "potential_reference": "CSE" if readings.holds_potentials else None,
        "read_against": readings.electrode if readings.holds_potentials else None,
        "structure": readings.structure,
        "date": readings.date,
    }
    encode = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode
    features = [
        encode(
            {
                "type": "Feature",
                "id": point.index,
                "geometry": {"type": "Point", "coordinates": place},
                "properties": dict(zip(names, values, strict=True)),
            }
        )
        for point, place, values in zip(
            points, _places(points, georeference), zip(*columns.values(), strict=True), strict=True
        )
    ]
    known = {key: value for key, value in head.items() if value is not None}
    return f'{encode(known)[:-1]},"features":[\n' + ",\n".join(features) + "\n]}\n"


def _system(georeference: Georeference | None) -> dict[str, object]:
    if georeference is None:
        return dict(LOCAL)
    return {
        "kind": "WGS 84",
        "axes": ["longitude", "latitude", "height above the ellipsoid"],
        "origin": georeference.model_dump(),
    }


def _places(points: Sequence[PointResult], georeference: Georeference | None) -> list[list[float]]:
    p_W = np.array([point.p_W for point in points], dtype=np.float64).reshape(-1, 3)
    if georeference is None:
        local: list[list[float]] = p_W.tolist()
        return local
    places = on_earth(p_W, georeference)
    places[:, :2] = np.round(places[:, :2], DEGREE_DIGITS)
    places[:, 2] = np.round(places[:, 2], HEIGHT_DIGITS) + 0.0  # no −0.0
    rounded: list[list[float]] = places.tolist()
    return rounded


def _columns(readings: HandedReadings) -> dict[str, Sequence[object]]:
    """The properties of all points by name, without those that no point has."""
    points = readings.points
    columns: dict[str, Sequence[object]] = {
        "label": [point.label for point in points],
        "surface": [point.surface or None for point in points],
        "u_m": [point.uv_m and point.uv_m[0] for point in points],
        "v_m": [point.uv_m and point.uv_m[1] for point in points],
    }
    columns |= {name: list(map(attrgetter(name), points)) for name in FIELDS}
    columns |= value_columns(points)
    return {
        name: values
        for name, values in columns.items()
        if name == "label" or any(value is not None for value in values)
    }
