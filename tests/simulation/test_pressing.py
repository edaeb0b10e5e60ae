"""The whole stack presses a wall in MuJoCo: the force that Rᵀ M̃ R K̃ x̃ says, at any arm angle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from worlds import CALM, Array, placed, plant_of, structure_of, vehicle_at

from inspect_cli.compiled.joined import joined
from inspect_cli.records import Pose, Reference, State
from inspect_cli.schema.geometry import PlaneShape
from inspect_cli.schema.truth import ProximityEffects
from inspect_cli.vehicles.tilt_rotor import TiltRotor
from inspect_cli.vehicles.tilt_rotor.model import tool_transform

DT = 1e-3
CONTROL_STEPS = 4


def press(
    vehicle: TiltRotor, depth_m: float, effects: ProximityEffects = CALM, duration_s: float = 15.0
) -> tuple[State, Reference, float]:
    """Level before a wall square to the tool, told to be ``depth_m`` behind it.

    The stack is given the true motion; it observes the wrench itself. Returns the last state, the
    reference and the largest normal force.
    """
    p_BT, R_BT = tool_transform(vehicle.platform)
    z_T = R_BT[:, 2]
    start = np.array([0.0, 0.0, 2.0])
    touch = start + p_BT + 0.01 * z_T
    wall = PlaneShape(
        center_m=tuple(touch.tolist()), normal=tuple((-z_T).tolist()), size_m=(1.0, 1.0)
    )
    plant = plant_of(vehicle, structure_of([wall]), effects=effects)
    placed(plant, start.tolist())
    stack, pose, reference = (
        vehicle.flight_control(),
        Pose.create(),
        Reference.create(vehicle.capabilities.lengths),
    )
    pose.p_WB[:], pose.q_WB[:] = start, [1.0, 0.0, 0.0, 0.0]
    stack.start(pose)
    control = joined(*stack.bind(reference))
    reference.p_WB[:] = touch + depth_m * z_T - p_BT
    reference.q_WB[0] = 1.0
    reference.impedance = float(vehicle.capabilities.impedances.index("contact_ndt"))
    peak = 0.0
    for tick in range(round(duration_s / (CONTROL_STEPS * DT))):
        state = plant.observe(tick * CONTROL_STEPS * DT)
        if tick % 5 == 0:
            plant.feel_surroundings()
        tell(stack.estimate.views, state)
        assert stack.prepare(reference, True)
        control()
        plant.apply(stack.command)
        plant.step(CONTROL_STEPS)
        peak = max(peak, state.f_normal)
    assert not plant.diverged
    return plant.observe(duration_s), reference, peak


def tell(estimate: dict[str, Array], state: State) -> None:
    for name in ("p_WB", "q_WB", "v_WB_W", "w_WB_B"):
        estimate[name][:] = state.views[name]


@pytest.mark.parametrize("pitch_deg", [90.0, 150.0])
@pytest.mark.parametrize("depth_m", [0.05, 0.10])
def test_at_rest_the_wrench_is_the_shaped_spring(pitch_deg: float, depth_m: float) -> None:
    vehicle = vehicle_at(pitch_deg)
    assert isinstance(vehicle, TiltRotor)
    state, reference, _ = press(vehicle, depth_m)
    np.testing.assert_allclose(state.v_WB_W, 0.0, atol=2e-3)

    control = vehicle.platform.control
    profile, R = control.profiles["contact_ndt"], tool_transform(vehicle.platform)[1]
    turned = Rotation.from_quat(np.roll(state.q_WB, -1))
    x = turned.inv().apply(state.p_WB - reference.p_WB)
    force = R @ np.diag(profile.mass) @ R.T @ np.diag(control.stiffness_npm) @ x
    np.testing.assert_allclose(state.wrench_ext_B[:3], force, atol=0.02)
    theta = turned.as_rotvec()
    torque = R @ np.diag(profile.inertia) @ R.T @ np.diag(control.stiffness_nmprad) @ theta
    np.testing.assert_allclose(state.wrench_ext_B[3:], torque, atol=0.02)
    # The tip sinks by F/K, so the set-point is that much less behind it: 0.25 · 72 N/m.
    expected = 18.0 * depth_m / (1.0 + 18.0 / 3000.0)
    assert state.f_normal == pytest.approx(expected, rel=0.02)
    along_tool = state.f_tool_W @ turned.apply(R[:, 2])
    assert along_tool == pytest.approx(-state.f_normal, abs=1e-6)


def test_the_ceilings_lift_is_an_external_force_that_the_stack_observes() -> None:
    """Under a soffit the rotors lift more than they are told; the vehicle still holds on."""
    vehicle = vehicle_at(180.0)
    assert isinstance(vehicle, TiltRotor)
    calm, *_ = press(vehicle, 0.10)
    state, *_ = press(vehicle, 0.10, ProximityEffects(wall=False, ground=False))
    assert state.f_body == 0.0
    assert state.f_normal > calm.f_normal
