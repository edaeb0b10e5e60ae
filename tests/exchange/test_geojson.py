"""GeoJSON as any parser sees it."""

from __future__ import annotations

import json

import numpy as np
from handed import handed, point

from inspect_cli.exchange.earth import on_earth
from inspect_cli.exchange.geojson import geojson
from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.schema.survey import Georeference

HERE = Georeference(longitude_deg=8.5, latitude_deg=47.4, height_m=400.0, heading_deg=30.0)


def test_local_metres_say_so() -> None:
    readings = handed()
    parsed = json.loads(geojson(readings))
    assert parsed["type"] == "FeatureCollection"
    assert parsed["name"] == "Deck of the north ramp"
    assert parsed["coordinate_system"]["kind"] == "local engineering coordinates"
    assert parsed["coordinate_system"]["unit"] == "metre"
    assert (parsed["potential_reference"], parsed["read_against"]) == ("CSE", "SCE")
    for feature, each in zip(parsed["features"], readings.points, strict=True):
        assert feature["type"] == "Feature"
        assert feature["id"] == each.index
        assert feature["geometry"] == {"type": "Point", "coordinates": list(each.p_W)}
        properties = feature["properties"]
        assert properties["label"] == each.label
        assert properties["potential_mv"] == each.potential_mv
        assert properties["astm_class"] == each.astm_class
        assert properties["u_m"] == (each.uv_m[0] if each.uv_m else None)
        assert "true_force_n" not in properties  # which no point has


def test_a_georeference_makes_it_wgs_84() -> None:
    readings = handed()
    parsed = json.loads(geojson(readings, HERE))
    assert parsed["coordinate_system"]["kind"] == "WGS 84"
    assert parsed["coordinate_system"]["origin"]["heading_deg"] == 30.0
    found = np.array([f["geometry"]["coordinates"] for f in parsed["features"]])
    expected = on_earth(np.array([p.p_W for p in readings.points]), HERE)
    # Written to 1e-10 of a degree and 1e-5 m.
    np.testing.assert_allclose(found[:, :2], expected[:, :2], rtol=0, atol=0.51e-10)
    np.testing.assert_allclose(found[:, 2], expected[:, 2], rtol=0, atol=0.51e-5)


def test_the_same_readings_make_the_same_text_and_a_feature_has_a_line() -> None:
    text = geojson(handed(), HERE)
    assert text == geojson(handed(), HERE)
    assert len(text.splitlines()) == 2 + 4
    assert "Brücke 12" in text


def test_few_readings_and_none() -> None:
    assert json.loads(geojson(HandedReadings((), "nothing")))["features"] == []
    assert json.loads(geojson(HandedReadings((), "nothing"), HERE))["features"] == []
    parsed = json.loads(geojson(handed(point(7))))
    assert [f["id"] for f in parsed["features"]] == [7]


def test_what_another_instrument_read_is_a_property_of_its_own_name() -> None:
    warm = point(0, values={"temperature_c": 12.5})
    (plain,) = json.loads(geojson(handed(point(0))))["features"]
    (feature,) = json.loads(geojson(handed(warm)))["features"]
    assert "values" not in plain["properties"]
    assert feature["properties"] == plain["properties"] | {"temperature_c": 12.5}
