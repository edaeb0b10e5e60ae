"""Flights with sensors that are mounted, timed or broken otherwise than on shipped platforms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from modes import Mode
from scenarios import ONE_POINT, Scenario

VARIANT = "schema: 1\nextends: tilt_rotor_hexarotor.yaml\n"


@pytest.mark.parametrize(
    ("name", "mount"),
    [
        # The same place: 0.06 m above the arm, against x_T, and 0.39 m behind the tip.
        ("on_the_tool", "{frame: tool, axes: null, position_m: [-0.06, 0.0, -0.39]}"),
        # z_D along x_B and x_D along −z_B: the tool's axes, from those of the body.
        ("on_the_body", "{axes: null, rotation_rad: [0.0, 1.5707963267948966, 0.0]}"),
        # Upside down, so that what it sees has to be turned back.
        ("upside_down", "{rotation_rad: [0.0, 0.0, 3.141592653589793]}"),
    ],
)
def test_a_camera_sees_the_wall_from_any_mount(campaign: Path, name: str, mount: str) -> None:
    (campaign / "platforms" / f"{name}.yaml").write_text(
        f"{VARIANT}name: {name}\nsensors: {{tof: {{rate_hz: 15, mount: {mount}}}}}\n"
    )
    flight = Scenario(name, tasks=f"platform: {name}\n{ONE_POINT}").fly(campaign)
    assert flight.outcome.result.status == "completed"
    assert flight.reasons == [""]
    seen = flight.log.channels["/guidance/surface"]
    # 15 Hz of 1000 Hz physics: each image at the first step at or after k/15 s.
    late = seen["t_s"] - np.arange(len(seen)) / 15.0
    assert late.min() >= -1e-9
    assert late.max() < 1e-3
    state = flight.state[
        np.searchsorted(flight.state["t_s"], seen["t_s"]).clip(max=len(flight.state) - 1)
    ]
    mode = flight.mode[
        np.searchsorted(flight.state["t_s"], seen["t_s"]).clip(max=len(flight.mode) - 1)
    ]
    near = (mode == float(Mode.APPROACH)) & (seen["valid"] > 0.5)
    assert near.sum() > 10
    normals = seen["n_W"][near]
    assert np.degrees(np.arccos(-normals[:, 0])).mean() < 2.0
    # Noise of 4 mm at one pixel, hundreds of them; log rows are up to 10 ms late at 0.1 m/s.
    gap = 2.0 - state["p_WT"][near, 0]
    assert np.abs(seen["distance"][near] - gap).mean() < 0.005


@pytest.mark.parametrize("kind", ["off", "nan"])
def test_a_flight_whose_inertial_unit_fails_ends_with_a_status(campaign: Path, kind: str) -> None:
    fault = f"faults: [{{sensor: imu, fault: {kind}, start_s: 6.0}}]\n"
    flight = Scenario(f"imu-{kind}", fault, ONE_POINT).fly(campaign)
    assert flight.outcome.result.status in ("aborted", "diverged")
    assert flight.outcome.result.status_reason
    assert not any(point.valid for point in flight.outcome.result.points)
