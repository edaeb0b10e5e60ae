"""The observer's force against a force sensor in the wall (paper A, section V-F, Table IV).

Ground truth is the sensor's signal through a Butterworth low-pass of order 5 and 5 Hz, designed
for the sensor's rate. It is run forwards and backwards: the paper filters its recorded data and
does not say which, and a single pass is late by 0.10 s at low frequencies (3.24 / (2π · 5 Hz)),
which would excuse an estimate that is late itself. Zero phase is the stricter comparison.

The estimate is the observer's wrench on the vehicle, turned into W by the ESTIMATED attitude, as
the paper's is. The sensor feels the opposite: f = −R_WS f_S. Torques are about the tool's tip,

    τ̂_T = R̂_WB (t̂_B − p_BT × f̂_B)        τ_T = −(R_WS t_S − (p_WT − p_WS) × R_WS f_S)

with the true tip of the sensor's side; a point contact has none, so that it is the torque which
the observer makes up. The estimate holds all external force, wind and near surfaces too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured, largest, root_mean_square
from inspect_cli.metrics.geometry import turned_back_by, turned_by
from inspect_cli.records import Estimate, WallForce
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.rotations import quaternion_to_matrix

ORDER = 5
CUTOFF_HZ = 5.0
AWAY_S = 1.0
"""The noise is measured this far in time from any touch."""


@dataclass(frozen=True)
class Signal:
    """The sensor's samples, one after the other."""

    t_s: Vector
    raw: Points
    """Force and torque on the surface about O_S, (n, 6) in S."""
    filtered: Points
    R_WS: Matrix
    p_WS: Vector


def signal(flight: FlightData) -> Signal:
    """The sensor's samples of a flight, raw and filtered.

    Raises:
        NotMeasured: samples are missing in between, or are too few or too slow to be filtered.
    """
    blocks = flight.rows(WallForce)
    period, count = float(blocks["period"][0]), blocks["f_S"].shape[1]
    if np.any(np.abs(np.diff(blocks["t_s"]) - count * period) > 0.5 * period):
        raise NotMeasured("samples of the wall's force sensor are missing")
    if not 0.0 < period < 0.5 / CUTOFF_HZ:
        raise NotMeasured(f"the wall's force sensor is too slow for a filter of {CUTOFF_HZ:g} Hz")
    ages = period * np.arange(count - 1, -1, -1)
    times = (blocks["t_s"][:, None] - ages).ravel()
    raw = np.concatenate([blocks["f_S"], blocks["t_S"]], axis=2).reshape(-1, 6)
    filtered = low_pass(raw, 1.0 / period)
    return Signal(times, raw, filtered, quaternion_to_matrix(blocks["q_WS"][0]), blocks["p_WS"][0])


def low_pass(samples: Points, rate_hz: float) -> Points:
    """Samples (n, k) through the filter, without a lag."""
    from scipy.signal import butter, sosfiltfilt  # slow to import, and planning reads this page

    sections = butter(ORDER, CUTOFF_HZ, fs=rate_hz, output="sos")
    filtered: Points = sosfiltfilt(sections, samples, axis=0)
    return filtered


def force_errors(flight: FlightData) -> Points:
    """Estimated less measured force on the vehicle in W, (n, 3) N, on the ticks of the state."""
    estimate = flight.on_state_ticks(Estimate)
    estimated = turned_by(estimate["q_WB"], estimate["wrench_B"][:, :3])
    errors: Points = estimated - measured_force(flight)
    return errors


def measured_force(flight: FlightData) -> Points:
    """Filtered force of the surface on the vehicle in W, (n, 3) N, on the ticks of the state."""
    measured = signal(flight)
    force: Points = -(_on_ticks(flight, measured)[:, :3] @ measured.R_WS.T)
    return force


def torque_errors(flight: FlightData) -> Points:
    """Estimated less measured torque on the vehicle about the tip in W, (n, 3) N·m."""
    measured, state = signal(flight), flight.state
    wrench = _on_ticks(flight, measured)
    force, torque = wrench[:, :3] @ measured.R_WS.T, wrench[:, 3:] @ measured.R_WS.T
    about_tip = torque - np.cross(state["p_WT"] - measured.p_WS, force)
    estimate = flight.on_state_ticks(Estimate)
    observed = estimate["wrench_B"]
    p_BT = turned_back_by(state["q_WB"], state["p_WT"] - state["p_WB"])
    moment = observed[:, 3:] - np.cross(p_BT, observed[:, :3])
    errors: Points = turned_by(estimate["q_WB"], moment) + about_tip
    return errors


def force_rmse(flight: FlightData, axis: int) -> float:
    """RMS force error along an axis of W, N, between take-off and landing."""
    return root_mean_square(force_errors(flight)[flight.off_ground, axis])


def contact_force_rmse(flight: FlightData, axis: int) -> float:
    """The same while the tool touches."""
    rows = flight.off_ground & flight.touching
    return root_mean_square(force_errors(flight)[rows, axis])


def sensor_force_rmse(flight: FlightData, axis: int) -> float:
    """RMS force error along an axis of the sensor's frame S, N, between take-off and landing."""
    in_S = force_errors(flight)[flight.off_ground] @ signal(flight).R_WS
    return root_mean_square(in_S[:, axis])


def torque_rmse(flight: FlightData, axis: int) -> float:
    """RMS torque error about the tip and an axis of W, N·m, between take-off and landing."""
    return root_mean_square(torque_errors(flight)[flight.off_ground, axis])


def contact_torque_rmse(flight: FlightData, axis: int) -> float:
    """The same while the tool touches."""
    rows = flight.off_ground & flight.touching
    return root_mean_square(torque_errors(flight)[rows, axis])


def peak(flight: FlightData) -> float:
    """Largest pressing force of the filtered signal, N: what a plot of it shows.

    A short blow at the touch is smoothed away, and a release at full force makes the filter
    overshoot by about 6 %; ``contact.force_peak_n`` has neither.
    """
    return largest(-signal(flight).filtered[:, 2])


def noise(flight: FlightData) -> float:
    """RMS of the raw less the filtered normal force, N, at least 1 s from any touch."""
    measured = signal(flight)
    away = np.interp(measured.t_s, flight.state["t_s"], flight.near_touch(AWAY_S)) == 0.0
    return root_mean_square((measured.raw - measured.filtered)[away, 2])


def _on_ticks(flight: FlightData, measured: Signal) -> Points:
    """The filtered signal (n, 6) at the times of the state; the last block may be missing."""
    times = flight.state["t_s"]
    columns = [np.interp(times, measured.t_s, column) for column in measured.filtered.T]
    return np.column_stack(columns)
