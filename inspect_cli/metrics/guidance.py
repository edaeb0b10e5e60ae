"""How well the surface was seen and the tool held against it."""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured, mean, nearest
from inspect_cli.metrics.geometry import direction_angle
from inspect_cli.records import SurfaceEstimate, TrueContact
from inspect_cli.schema.modes import AT_SURFACE
from inspect_cli.spatial.rotations import rotate

NO_SURFACE = -1.0


def normal_error_mean_deg(flight: FlightData) -> float:
    """Mean angle between the seen and the true outward normal, degrees.

    Over the valid estimates of approach, press and retreat, when the surface on the tool's axis
    is the one that is nearest to the tip. Each is held against the true normal nearest in time.
    """
    seen = flight.rows(SurfaceEstimate)
    true = flight.rows(TrueContact)
    same_time = true[nearest(true["t_s"], seen["t_s"])]
    reference = flight.reference[nearest(flight.state["t_s"], seen["t_s"])]
    busy = flight.modes.within(reference["mode"], AT_SURFACE)
    usable = (seen["valid"] > 0.5) & (same_time["surface"] != NO_SURFACE) & busy
    if not np.any(usable):
        raise NotMeasured("no valid estimate of a surface during approach, press or retreat")
    angles = direction_angle(seen["n_W"][usable], same_time["n_W"][usable])
    return float(np.degrees(mean(angles)))


def tool_axis_error_mean_deg(flight: FlightData) -> float:
    """Mean angle between z_T and the true inward normal while the tool touches, degrees."""
    contact = flight.on_state_ticks(TrueContact)
    usable = flight.touching & flight.airborne & (contact["surface"] != NO_SURFACE)
    if not np.any(usable):
        raise NotMeasured("the tool never touched a surface")
    z_T = np.array([0.0, 0.0, 1.0])
    axes_W = np.array([rotate(q_WT, z_T) for q_WT in flight.state["q_WT"][usable]])
    return float(np.degrees(mean(direction_angle(axes_W, -contact["n_W"][usable]))))
