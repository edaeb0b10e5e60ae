"""The IFC model, opened again by the library and judged by its validator."""

from __future__ import annotations

import sys
from typing import Any

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.validate
import numpy as np
import pytest
from handed import handed, point

from inspect_cli.errors import EnvironmentFault, InputError
from inspect_cli.exchange.ifc import COLOURS, MAX_POINTS, ifc
from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.schema.survey import Georeference

HERE = Georeference(longitude_deg=-8.51, latitude_deg=47.4, height_m=400.0, heading_deg=30.0)


def opened(text: str) -> Any:
    return ifcopenshell.file.from_string(text)


# The validator leaves its file of rules open.
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_it_is_valid_by_schema_and_rules() -> None:
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(opened(ifc(handed(), HERE)), log, express_rules=True)
    assert log.statements == []


def test_a_model_without_readings_is_valid() -> None:
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(opened(ifc(HandedReadings((), "nothing"))), log)
    assert log.statements == []


def test_every_reading_is_a_proxy_at_its_place_with_its_values() -> None:
    readings = handed()
    model = opened(ifc(readings))
    proxies = model.by_type("IfcBuildingElementProxy")
    assert len(proxies) == 4
    for proxy, each in zip(proxies, readings.points, strict=True):
        assert proxy.Name == each.label
        place = ifcopenshell.util.placement.get_local_placement(proxy.ObjectPlacement)
        np.testing.assert_array_equal(place[:3, 3], each.p_W)
        held = ifcopenshell.util.element.get_psets(proxy)["HalfCellPotential"]
        assert held.get("Potential") == each.potential_mv
        assert held.get("Resistivity") == each.resistivity_ohm_m
        assert held.get("AstmClass") == each.astm_class
        assert held.get("Corrosion") == each.corrosion
        assert held["Valid"] is each.valid
        assert held.get("WhyInvalid") == (each.reason or None)
        assert held["Date"] == "2025-03-31"
        assert (held["PotentialAgainst"], held["ReadAgainst"]) == ("CSE", "SCE")
    assert model.by_type("IfcSite")[0].Name == "Brücke 12"
    assert model.by_type("IfcProject")[0].Name == "Deck of the north ramp"
    groups = {g.Name: len(g.IsGroupedBy[0].RelatedObjects) for g in model.by_type("IfcGroup")}
    assert groups == {"deck": 2, "soffit": 2}


def test_what_another_instrument_read_has_a_property_set_of_its_own() -> None:
    warm = {"instrument": "thermometer", "units": {"temperature": "°C"}, "astm_class": None}
    read = point(1, values={"temperature": 12.5}, **warm)
    lost = point(2, valid=False, reason="not visited", **warm)
    model = opened(ifc(HandedReadings((point(0), read, lost), "both")))
    proxies = model.by_type("IfcBuildingElementProxy")
    sets = [ifcopenshell.util.element.get_psets(proxy) for proxy in proxies]
    assert [next(iter(found)) for found in sets] == [
        *("HalfCellPotential", "InstrumentReading", "InstrumentReading")
    ]
    held, nothing = (found["InstrumentReading"] for found in sets[1:])
    assert (held["Instrument"], held["temperature"]) == ("thermometer", 12.5)
    assert (held["temperature unit"], held["Valid"]) == ("°C", True)
    assert "temperature" not in nothing
    assert (nothing["WhyInvalid"], nothing["Valid"]) == ("not visited", False)
    assert "Potential" not in held
    assert proxies[1].ObjectType == "Reading by thermometer"


def test_lengths_are_metres_and_potentials_millivolts() -> None:
    model = opened(ifc(handed()))
    units = model.by_type("IfcProject")[0].UnitsInContext.Units
    assert (units[0].UnitType, units[0].Prefix, units[0].Name) == ("LENGTHUNIT", None, "METRE")
    first = next(p for p in model.by_type("IfcPropertySingleValue") if p.Name == "Potential")
    assert (first.Unit.Prefix, first.Unit.Name) == ("MILLI", "VOLT")


def test_viewers_get_octahedra_in_the_colour_of_the_class() -> None:
    readings = handed()
    model = opened(ifc(readings, radius_m=0.03))
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    colours = []
    for proxy, each in zip(model.by_type("IfcBuildingElementProxy"), readings.points, strict=True):
        shape = ifcopenshell.geom.create_shape(settings, proxy)
        vertices = np.array(shape.geometry.verts).reshape(-1, 3)
        np.testing.assert_allclose(vertices.mean(axis=0), each.p_W, atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(vertices - each.p_W, axis=1), 0.03, atol=1e-9)
        faces = np.array(shape.geometry.faces).reshape(-1, 3)
        corners = vertices[faces] - each.p_W
        # Outward faces: a · (b × c) / 6 sums to the volume of an octahedron, 4/3 r³.
        volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        assert (volume > 0).all()
        assert volume.sum() == pytest.approx(4 / 3 * 0.03**3, rel=1e-9)
        colour = shape.geometry.materials[0].diffuse
        colours.append((colour.r(), colour.g(), colour.b()))
    expected = [COLOURS[name] for name in ("uncertain", "uncertain", "active", "no reading")]
    np.testing.assert_allclose(colours, expected, atol=1e-6)


def test_the_same_readings_make_the_same_bytes_and_others_other_identifiers() -> None:
    text = ifc(handed(), HERE)
    assert text == ifc(handed(), HERE)
    assert "2025-03-31T00:00:00" in text
    ids = [root.GlobalId for root in opened(text).by_type("IfcRoot")]
    assert len(set(ids)) == len(ids)
    assert not {r.GlobalId for r in opened(ifc(handed(point(0)))).by_type("IfcRoot")} & set(ids)


def test_a_georeference_places_the_site_and_turns_north() -> None:
    model = opened(ifc(handed(), HERE))
    site = model.by_type("IfcSite")[0]
    assert site.RefLatitude == (47, 24, 0, 0)
    assert site.RefLongitude == (-8, -30, -36, 0)
    assert site.RefElevation == 400.0
    # With y 30° clockwise of north, north lies 30° counterclockwise of y.
    north = model.by_type("IfcGeometricRepresentationContext", include_subtypes=False)[0].TrueNorth
    np.testing.assert_allclose(north.DirectionRatios, [-0.5, np.sqrt(0.75)], atol=1e-12)


def test_too_many_readings_are_refused() -> None:
    many = HandedReadings([point(0)] * (MAX_POINTS + 1), "many")
    with pytest.raises(InputError, match=r"20001 readings are too many.*\n.*CSV or GeoJSON"):
        ifc(many)


def test_without_the_extra_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ifcopenshell", None)
    with pytest.raises(EnvironmentFault, match=r"pip install 'inspect-cli\[bim\]'"):
        ifc(handed())
