"""What became of the targets of the plan that were to be read, whatever the instrument."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, SupportsFloat

import numpy as np

from inspect_cli.metrics.contact import position_error
from inspect_cli.metrics.flight import Dwell, FlightData, NotMeasured
from inspect_cli.metrics.instrument import PointReader, Values
from inspect_cli.records import InvalidReason, PointReading
from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import PointResult, Status
from inspect_cli.schema.vehicle import InstrumentModel
from inspect_cli.spatial.arrays import Structured


def points_read_by(reader: PointReader, flight: FlightData) -> dict[int, PointResult]:
    """One result for each target that an instrument is read at, by the target's index."""
    readings = flight.log.rows(reader.reading)
    last = {} if readings is None else {float(row["target"]): row for row in readings}
    return {
        target.index: _point(reader, flight, target, last.get(target.index))
        for target in flight.plan.targets
        if target.sensor == reader.kind
    }


def contact_points(reader: PointReader, flight: FlightData) -> list[PointResult]:
    """The results of the targets that an instrument was to read, in the plan's order.

    Raises:
        NotMeasured: the plan has none, or the log has no channel of its readings.
    """
    if flight.log.rows(reader.reading) is None:
        raise NotMeasured(f"the log has nothing on {reader.reading.topic}")
    flight.read_by(reader.kind)
    return list(points_read_by(reader, flight).values())


def sensor_of(reader: PointReader, flight: FlightData) -> InstrumentModel:
    """The model of the sensor that took an instrument's readings.

    Raises:
        NotMeasured: the platform has none.
    """
    model = flight.platform.instruments.get(reader.kind)
    if model is None:
        raise NotMeasured(f"the platform has no instrument '{reader.kind}'")
    return model


def _point(
    reader: PointReader, flight: FlightData, target: Target, reading: Structured | None
) -> PointResult:
    model = sensor_of(reader, flight)
    values = {} if reading is None else _values(reader.reading, reading)
    first = reader.reading.values()[0]
    valid = reading is not None and bool(reading["valid"] > 0.5) and first in values
    why = "" if valid else _reason(reading, flight.log.status, first, reader.reasons(model))
    point = PointResult(
        index=target.index,
        label=target.label,
        valid=valid,
        reason=why,
        p_W=_where(target, reading),
        surface=target.surface or "",
        uv_m=target.uv_m,
        probe_force_n=_read(reading, "force_mean"),
        contact_s=_read(reading, "contact_s") or 0.0,
        **_true_touch(flight, target),
        **reader.described(),
    )
    return reader.complete(flight, target, point, values if valid else {})


def dwell_on(flight: FlightData, target: Target) -> Dwell | None:
    """When a target was truly pressed; None where it was not or the log has no truth about it."""
    try:
        return flight.dwells.get(target.index)
    except NotMeasured:
        return None


def _true_touch(flight: FlightData, target: Target) -> dict[str, Any]:
    """How a target was truly touched; nothing where the log has no truth about it."""
    try:
        dwell = flight.dwells.get(target.index)
        if dwell is None:
            return {}
        force = flight.state["f_normal"]
        return {
            "true_force_n": finite(np.mean(force[dwell.steady])),
            "true_force_peak_n": finite(np.max(force[dwell.rows])),
            "position_error_m": finite(position_error(flight, target)),
        }
    except NotMeasured:
        return {}


def _values(kind: type[PointReading], reading: Structured) -> Values:
    read = {name: finite(reading[name]) for name in kind.values()}
    return {name: value for name, value in read.items() if value is not None}


def _reason(
    reading: Structured | None, status: Status, first: str, own: Mapping[float, str]
) -> str:
    """Why a point has no valid reading."""
    if reading is None:
        return "not visited" if status == "completed" else "the flight ended before it was read"
    if reading["valid"] > 0.5:
        return f"the reading counts as valid but has no {first}"
    number = float(reading["reason"])
    known = REASONS if number in REASONS else own
    return known.get(number, f"reason {number:g}")


REASONS: Mapping[float, str] = {
    InvalidReason.NOT_VISITED: "not visited",
    InvalidReason.NO_CONTACT: "force: the probe never touched anything",
    InvalidReason.NO_SIGNAL: "the probe sent nothing",
    InvalidReason.OFF_TARGET: "off target: the tool touched the surface too far from its point",
    InvalidReason.ABORTED: "the flight was aborted",
}
"""Reasons that every instrument may have."""


def _where(target: Target, reading: Structured | None) -> tuple[float, float, float]:
    if reading is None or not np.all(np.isfinite(reading["p_WT"])):
        return target.p_WC
    x, y, z = (float(value) for value in reading["p_WT"])
    return (x, y, z)


def _read(reading: Structured | None, field: str) -> float | None:
    return None if reading is None else finite(reading[field])


def finite(value: SupportsFloat | None) -> float | None:
    """The number, or None where a diverged flight or an invalid reading left none."""
    if value is None or not math.isfinite(float(value)):
        return None
    return float(value)
