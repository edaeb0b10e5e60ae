"""What became of each target of the plan that was to be read."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import SupportsFloat

import numpy as np

from inspect_cli.assessment.classes import astm_class, combined_verdict, resistivity
from inspect_cli.assessment.electrodes import as_evaluated, to_standard
from inspect_cli.metrics.assessed import basis_on
from inspect_cli.metrics.contact import position_error
from inspect_cli.metrics.flight import Dwell, Flight, NotMeasured
from inspect_cli.records import InvalidReason, Reading, TrueContact
from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import PointResult, Status
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.spatial.arrays import Structured


@dataclass(frozen=True)
class TrueValues:
    """What was so while a point was pressed; None where the log has no truth about it."""

    force_n: float | None = None
    force_peak_n: float | None = None
    position_error_m: float | None = None
    potential_v: float | None = None
    """As a CSE at the concrete's temperature would have read it."""
    resistivity_ohm_m: float | None = None


def point_results(flight: Flight) -> tuple[PointResult, ...]:
    """One result for each target of the plan that is read, in the plan's order."""
    readings = flight.log.rows(Reading)
    last = {} if readings is None else {float(row["target"]): row for row in readings}
    read = (target for target in flight.plan.targets if target.sensor is not None)
    return tuple(_point(flight, target, last.get(target.index)) for target in read)


def probe_of(flight: Flight) -> HalfCellModel:
    """The half-cell that took the flight's readings.

    Raises:
        NotMeasured: the platform has none.
    """
    probe = flight.platform.find(HalfCellModel)
    if probe is None:
        raise NotMeasured("the platform has no half-cell")
    return probe


def _point(flight: Flight, target: Target, reading: Structured | None) -> PointResult:
    probe = probe_of(flight)
    basis = basis_on(flight.mission, target.surface, probe.electrode)
    true = true_values(flight, target)
    read_v = _read(reading, "potential")
    valid = reading is not None and bool(reading["valid"] > 0.5) and read_v is not None
    resistance_ohm = _read(reading, "resistance") if valid else None
    rho = None if resistance_ohm is None else resistivity(resistance_ohm, probe.cell_constant_m)
    if not valid:
        read_v = None
    potential_v = None if read_v is None else float(to_standard(read_v, basis))
    true_potential_v, true_corrosion = None, None
    if true.potential_v is not None:
        true_potential_v = float(as_evaluated(true.potential_v, basis))
        true_corrosion = combined_verdict(true_potential_v, true.resistivity_ohm_m)
    return PointResult(
        index=target.index,
        label=target.label,
        valid=valid,
        reason="" if valid else _reason(reading, flight.log.status, probe),
        p_W=_where(target, reading),
        surface=target.surface or "",
        uv_m=target.uv_m,
        read_mv=_millivolts(read_v),
        potential_mv=_millivolts(potential_v),
        resistance_ohm=resistance_ohm,
        resistivity_ohm_m=rho,
        probe_force_n=_read(reading, "force_mean"),
        contact_s=_read(reading, "contact_s") or 0.0,
        astm_class=None if potential_v is None else astm_class(potential_v),
        corrosion=None if potential_v is None else combined_verdict(potential_v, rho),
        true_force_n=true.force_n,
        true_force_peak_n=true.force_peak_n,
        position_error_m=true.position_error_m,
        true_potential_mv=_millivolts(true_potential_v),
        true_resistivity_ohm_m=true.resistivity_ohm_m,
        true_corrosion=true_corrosion,
    )


def true_values(flight: Flight, target: Target) -> TrueValues:
    """What was so at a target, averaged over the last 2 s of its dwell."""
    try:
        dwell = flight.dwells.get(target.index)
        return TrueValues() if dwell is None else _while_pressed(flight, target, dwell)
    except NotMeasured:
        return TrueValues()


def _while_pressed(flight: Flight, target: Target, dwell: Dwell) -> TrueValues:
    force = flight.state["f_normal"]
    potential, rho = None, None
    if flight.log.rows(TrueContact) is not None:
        contact = flight.on_state_ticks(TrueContact)[dwell.steady]
        potential = _finite(np.mean(contact["potential"]))
        rho = _finite(np.mean(contact["resistivity"]))
    return TrueValues(
        force_n=_finite(np.mean(force[dwell.steady])),
        force_peak_n=_finite(np.max(force[dwell.rows])),
        position_error_m=_finite(position_error(flight, target)),
        potential_v=potential,
        resistivity_ohm_m=rho,
    )


def _reason(reading: Structured | None, status: Status, probe: HalfCellModel) -> str:
    if reading is None:
        return "not visited" if status == "completed" else "the flight ended before it was read"
    if reading["valid"] > 0.5:
        return "the reading counts as valid but has no potential"
    words: dict[float, str] = {
        InvalidReason.NOT_VISITED: "not visited",
        InvalidReason.NO_CONTACT: "force: the probe never touched anything",
        InvalidReason.FORCE: (
            f"force: it did not stay at {probe.min_force_n:g} N for {probe.min_contact_s:g} s"
        ),
        InvalidReason.UNSTABLE: (
            f"the potential did not stay within {1e3 * probe.stable_v:g} mV "
            f"for {probe.stable_s:g} s"
        ),
        InvalidReason.OPEN_CIRCUIT: "open circuit between probe and reinforcement",
        InvalidReason.NO_SIGNAL: "the probe sent nothing",
        InvalidReason.OFF_TARGET: "off target: the tool touched the surface too far from its point",
        InvalidReason.ABORTED: "the flight was aborted",
    }
    number = float(reading["reason"])
    return words.get(number, f"reason {number:g}")


def _where(target: Target, reading: Structured | None) -> tuple[float, float, float]:
    if reading is None or not np.all(np.isfinite(reading["p_WT"])):
        return target.p_WC
    x, y, z = (float(value) for value in reading["p_WT"])
    return (x, y, z)


def _read(reading: Structured | None, field: str) -> float | None:
    return None if reading is None else _finite(reading[field])


def _finite(value: SupportsFloat | None) -> float | None:
    """The number, or None where a diverged flight or an invalid reading left none."""
    if value is None or not math.isfinite(float(value)):
        return None
    return float(value)


def _millivolts(volts: float | None) -> float | None:
    return None if volts is None else 1e3 * volts
