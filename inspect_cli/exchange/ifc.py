"""Readings as an IFC4 model: a small solid at each point, coloured by its class.

Each reading is an ``IfcBuildingElementProxy`` at its place, which every viewer shows and lets
one select, with the property set ``HalfCellPotential``, or ``InstrumentReading`` if another
instrument was read (the prefix ``Pset_`` belongs to the sets that buildingSMART publishes). Its
shape, an octahedron, is one map per class that all readings of the class share. Lengths are metres
in the readings' own coordinates; with a georeference the site has latitude, longitude and height,
and the context the direction of true north. Identifiers are derived from the content and no time is
written: the same readings give the same bytes.
"""

from __future__ import annotations

import hashlib
import math
import uuid
from typing import Any

from inspect_cli.errors import EnvironmentFault, InputError
from inspect_cli.exchange.readings import HandedReadings
from inspect_cli.exchange.readings_csv import value_names
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.survey import Georeference

MAX_POINTS = 20_000
"""The library makes some 30 entities per point; beyond this a map is the better picture."""
RADIUS_M = 0.02
PROPERTY_SET = "HalfCellPotential"
OTHER_PROPERTY_SET = "InstrumentReading"
"""Of a point that another instrument than a half-cell read."""
OBJECT_TYPE = "Half-cell reading"
COLOURS = {
    "passive": (0.15, 0.55, 0.30),
    "uncertain": (0.93, 0.70, 0.13),
    "active": (0.80, 0.16, 0.16),
    "no reading": (0.60, 0.60, 0.60),
    "reading": (0.20, 0.45, 0.75),
}
_SPACE = uuid.UUID("6f1d1c1e-6b0a-5c56-9a43-0d7a2f6c9b11")
_CORNERS = ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
_FACES = (
    (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5),
    (2, 1, 6), (3, 2, 6), (4, 3, 6), (1, 4, 6),
)  # fmt: skip


def ifc(
    readings: HandedReadings,
    georeference: Georeference | None = None,
    *,
    radius_m: float = RADIUS_M,
) -> str:
    """The model as STEP text (ISO 10303-21).

    Args:
        readings: at most ``MAX_POINTS`` points.
        georeference: where the coordinates begin.
        radius_m: of the octahedra.

    Raises:
        InputError: there are too many points.
        EnvironmentFault: ifcopenshell is not installed.
    """
    require_model(len(readings.points))
    model = _Model(_ifcopenshell(), readings, georeference)
    used = {_class_of(point) for point in readings.points}
    shapes = {name: model.shape(name, radius_m) for name in COLOURS if name in used}
    proxies = [model.proxy(k, point, shapes) for k, point in enumerate(readings.points)]
    model.finish(proxies)
    text: str = model.file.to_string()
    return text


def require_model(points: int) -> None:
    """Refuses so many points that a model cannot take, or any where none can be written.

    Raises:
        InputError: there are too many points.
        EnvironmentFault: ifcopenshell is not installed.
    """
    if points > MAX_POINTS:
        raise InputError(
            f"{points} readings are too many for a model of a building, which takes {MAX_POINTS}",
            hint="hand out CSV or GeoJSON, or the readings of one surface",
        )
    _ifcopenshell()


def _ifcopenshell() -> Any:
    try:
        import ifcopenshell
        import ifcopenshell.guid
    except ImportError as error:
        raise EnvironmentFault(
            f"ifcopenshell cannot be imported: {error}",
            hint="pip install 'inspect-cli[bim]'",
        ) from error
    return ifcopenshell


_Property = tuple[object, str, Any]
"""A value, its type in IFC and its unit there."""


class _Model:
    """An IFC file under construction."""

    def __init__(
        self, library: Any, readings: HandedReadings, georeference: Georeference | None
    ) -> None:
        self._compress = library.guid.compress
        self._readings = readings
        self._base = uuid.uuid5(_SPACE, _content(readings))
        self.file = library.file(schema="IFC4")
        self._make = self.file.create_entity
        self._head(georeference)

    def shape(self, name: str, radius_m: float) -> Any:
        """The octahedron of a class, as an IfcRepresentationMap."""
        make = self._make
        corners = [tuple(radius_m * c for c in corner) for corner in _CORNERS]
        body = make(
            "IfcTriangulatedFaceSet",
            make("IfcCartesianPointList3D", corners),
            Closed=True,
            CoordIndex=_FACES,
        )
        colour = make("IfcColourRgb", None, *COLOURS[name])
        shading = make("IfcSurfaceStyleShading", colour, 0.0)
        make("IfcStyledItem", body, [make("IfcSurfaceStyle", name, "BOTH", [shading])])
        drawn = make("IfcShapeRepresentation", self._body, "Body", "Tessellation", [body])
        return make("IfcRepresentationMap", self._origin, drawn)

    def proxy(self, k: int, point: PointResult, shapes: dict[str, Any]) -> Any:
        """One reading with its place, its shape and its properties."""
        make = self._make
        moved = make("IfcCartesianTransformationOperator3D", LocalOrigin=self._zero)
        item = make("IfcMappedItem", shapes[_class_of(point)], moved)
        drawn = make("IfcShapeRepresentation", self._body, "Body", "MappedRepresentation", [item])
        place = make("IfcAxis2Placement3D", make("IfcCartesianPoint", point.p_W))
        proxy = make(
            "IfcBuildingElementProxy",
            self._id(f"reading {k}"),
            Name=point.label,
            Description=point.reason or None,
            ObjectType=f"Reading by {point.instrument}" if point.instrument else OBJECT_TYPE,
            ObjectPlacement=make("IfcLocalPlacement", self._site_place, place),
            Representation=make("IfcProductDefinitionShape", Representations=[drawn]),
            Tag=str(point.index),
        )
        held = make(
            "IfcPropertySet",
            self._id(f"properties {k}"),
            Name=OTHER_PROPERTY_SET if point.instrument else PROPERTY_SET,
            HasProperties=self._properties(point),
        )
        make(
            "IfcRelDefinesByProperties",
            self._id(f"properties of {k}"),
            RelatedObjects=[proxy],
            RelatingPropertyDefinition=held,
        )
        return proxy

    def finish(self, proxies: list[Any]) -> None:
        """Puts the readings on the site, and those of each surface into a group."""
        make = self._make
        if not proxies:
            return
        make(
            "IfcRelContainedInSpatialStructure",
            self._id("contained"),
            RelatedElements=proxies,
            RelatingStructure=self._site,
        )
        groups: dict[str, list[Any]] = {}
        for point, proxy in zip(self._readings.points, proxies, strict=True):
            if point.surface:
                groups.setdefault(point.surface, []).append(proxy)
        for surface, members in groups.items():
            group = make("IfcGroup", self._id(f"surface {surface}"), Name=surface)
            make(
                "IfcRelAssignsToGroup",
                self._id(f"on {surface}"),
                RelatedObjects=members,
                RelatingGroup=group,
            )

    def _head(self, georeference: Georeference | None) -> None:
        make, readings = self._make, self._readings
        header = self.file.header
        header.file_name.name = ""
        header.file_name.time_stamp = f"{readings.date or '1970-01-01'}T00:00:00"
        header.file_name.originating_system = "inspect-cli"
        self._zero = make("IfcCartesianPoint", (0.0, 0.0, 0.0))
        self._origin = make("IfcAxis2Placement3D", self._zero)
        north = None
        if georeference is not None:
            h = math.radians(georeference.heading_deg)
            north = make("IfcDirection", (-math.sin(h), math.cos(h)))
        context = make(
            "IfcGeometricRepresentationContext", None, "Model", 3, 1e-6, self._origin, north
        )
        self._body = make(
            "IfcGeometricRepresentationSubContext",
            "Body",
            "Model",
            ParentContext=context,
            TargetView="MODEL_VIEW",
        )
        self._units()
        project = make(
            "IfcProject",
            self._id("project"),
            Name=readings.title,
            RepresentationContexts=[context],
            UnitsInContext=make("IfcUnitAssignment", [self._metre, self._radian, self._volt]),
        )
        self._site_place = make("IfcLocalPlacement", None, self._origin)
        self._site = make(
            "IfcSite",
            self._id("site"),
            Name=readings.structure or readings.title,
            ObjectPlacement=self._site_place,
            CompositionType="ELEMENT",
            **_on_earth(georeference),
        )
        make(
            "IfcRelAggregates",
            self._id("aggregates"),
            RelatingObject=project,
            RelatedObjects=[self._site],
        )

    def _units(self) -> None:
        make = self._make
        self._metre = make("IfcSIUnit", None, "LENGTHUNIT", None, "METRE")
        self._radian = make("IfcSIUnit", None, "PLANEANGLEUNIT", None, "RADIAN")
        self._volt = make("IfcSIUnit", None, "ELECTRICVOLTAGEUNIT", None, "VOLT")
        self._millivolt = make("IfcSIUnit", None, "ELECTRICVOLTAGEUNIT", "MILLI", "VOLT")
        ohm = make("IfcSIUnit", None, "ELECTRICRESISTANCEUNIT", None, "OHM")
        self._ohm_metre = make(
            "IfcDerivedUnit",
            [
                make("IfcDerivedUnitElement", ohm, 1),
                make("IfcDerivedUnitElement", self._metre, 1),
            ],
            "USERDEFINED",
            "RESISTIVITY",
        )

    def _properties(self, point: PointResult) -> list[Any]:
        make = self._make
        rows = self._values(point) if point.instrument else self._potentials(point)
        rows |= {
            "Valid": (point.valid, "IfcBoolean", None),
            "WhyInvalid": (point.reason or None, "IfcText", None),
            "Date": (self._readings.date, "IfcDate", None),
        }
        return [
            make("IfcPropertySingleValue", name, None, make(kind, value), unit)
            for name, (value, kind, unit) in rows.items()
            if value is not None
        ]

    def _values(self, point: PointResult) -> dict[str, _Property]:
        """What another instrument read. Its units stand beside it as words: IFC may lack them."""
        rows: dict[str, _Property] = {"Instrument": (point.instrument, "IfcLabel", None)}
        for name in value_names([point]):
            rows[name] = (point.values.get(name), "IfcReal", None)
            rows[f"{name} unit"] = (point.units.get(name), "IfcLabel", None)
        return rows

    def _potentials(self, point: PointResult) -> dict[str, _Property]:
        readings = self._readings
        potential = (point.potential_mv, "IfcElectricVoltageMeasure", self._millivolt)
        resistivity = (point.resistivity_ohm_m, "IfcReal", self._ohm_metre)
        return {
            "Potential": potential,
            "PotentialAgainst": ("CSE", "IfcLabel", None),
            "ReadAgainst": (readings.electrode, "IfcLabel", None),
            "AstmClass": (point.astm_class, "IfcLabel", None),
            "Resistivity": resistivity,
            "Corrosion": (point.corrosion, "IfcLabel", None),
        }

    def _id(self, what: str) -> str:
        """An identifier that belongs to this content and to this part of it."""
        found: str = self._compress(uuid.uuid5(self._base, what).hex)
        return found


def _class_of(point: PointResult) -> str:
    if point.instrument and point.valid:
        return "reading"
    return point.astm_class or "no reading"


def _content(readings: HandedReadings) -> str:
    """A digest of everything that the model says."""
    digest = hashlib.sha256()
    for part in (readings.title, readings.structure, readings.date, readings.electrode):
        digest.update(repr(part).encode())
    for point in readings.points:
        digest.update(point.model_dump_json().encode())
    return digest.hexdigest()


def _on_earth(georeference: Georeference | None) -> dict[str, object]:
    if georeference is None:
        return {}
    return {
        "RefLatitude": _angle(georeference.latitude_deg),
        "RefLongitude": _angle(georeference.longitude_deg),
        "RefElevation": georeference.height_m,
    }


def _angle(degrees: float) -> tuple[int, int, int, int]:
    """Degrees, minutes, seconds and millionths of a second, all of the sign of the angle."""
    millionths = round(abs(degrees) * 3_600_000_000)
    seconds, millionths = divmod(millionths, 1_000_000)
    minutes, seconds = divmod(seconds, 60)
    whole, minutes = divmod(minutes, 60)
    sign = -1 if degrees < 0 else 1
    return (sign * whole, sign * minutes, sign * seconds, sign * millionths)
