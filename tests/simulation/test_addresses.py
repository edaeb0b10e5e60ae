"""What a vehicle states that its model or its records do not have is refused when it is built."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import pytest
from worlds import plant_of, structure_of, vehicle_at

from inspect_cli.errors import InputError
from inspect_cli.schema.truth import TruePlatform
from inspect_cli.simulation.addresses import addresses_of
from inspect_cli.simulation.world import build_world
from inspect_cli.vehicles.actuators import Servo
from inspect_cli.vehicles.contacts import PointContact
from inspect_cli.vehicles.kinds import Bodies, Vehicle

STATED = (
    "platform", "capabilities", "bodies", "frames", "contacts", "joints", "posture_joints",
    "actuators", "nominal_spec",
)  # fmt: skip


@pytest.fixture(scope="module")
def vehicle() -> Vehicle:
    return vehicle_at()


def altered(vehicle: Vehicle, **parts: object) -> Vehicle:
    return SimpleNamespace(**{name: getattr(vehicle, name) for name in STATED} | parts)


def refusal(vehicle: Vehicle) -> str:
    with pytest.raises(InputError) as refused:
        plant_of(vehicle)
    return str(refused.value)


def test_every_number_is_found_by_name_wherever_it_stands(vehicle: Vehicle) -> None:
    """The vehicle with its joints in reverse order and a passive joint before the tilts."""

    def jointed() -> mujoco.MjSpec:
        spec = vehicle.nominal_spec()
        spec.body("tool").add_joint(name="passive", axis=[0.0, 1.0, 0.0])
        return spec

    joints = (*reversed(vehicle.joints), "passive")
    lengths = {**vehicle.capabilities.lengths, "n_joints": 7}
    other = altered(vehicle, joints=joints, nominal_spec=jointed)
    model = build_world(other, TruePlatform(), structure_of([]))
    where = addresses_of(model, other, lengths)
    for place, joint in zip(where.angles, joints, strict=True):
        assert place == model.joint(joint).qposadr[0]
    assert where.angles[-1] == 7  # the tool is the first body with a joint
    assert [model.actuator(k).name for k in where.servos] == [f"tilt_{k}" for k in range(6)]


def test_a_command_that_does_not_fit_the_actuators_is_refused(vehicle: Vehicle) -> None:
    text = refusal(altered(vehicle, actuators=vehicle.actuators[1:]))
    assert "n_rotors of the records is 12, but the vehicle states 11: rotor_0_lower" in text
    joints = vehicle.joints[:-1]
    assert "n_joints of the records is 6, but the vehicle states 5" in refusal(
        altered(vehicle, joints=joints)
    )


def test_two_actuators_of_one_name_are_refused(vehicle: Vehicle) -> None:
    first, second, *others = vehicle.actuators
    doubled = (first, replace(second, name=first.name), *others)
    text = refusal(altered(vehicle, actuators=doubled))
    assert "the vehicle states the actuator 'rotor_0_upper' 2 times" in text


def test_a_joint_that_is_not_there_is_refused(vehicle: Vehicle) -> None:
    text = refusal(altered(vehicle, joints=(*vehicle.joints[:-1], "elbow")))
    assert "the vehicle states the joint 'elbow', which its model does not have" in text
    assert "root, tilt_0" in text
    assert "tilt_5 names the joint 'tilt_5'" in text


def test_a_servo_of_another_joint_is_refused(vehicle: Vehicle) -> None:
    swapped = [
        replace(a, joint="tilt_0") if isinstance(a, Servo) and a.name == "tilt_1" else a
        for a in vehicle.actuators
    ]
    text = refusal(altered(vehicle, actuators=tuple(swapped)))
    assert "actuator 'tilt_1' does not act on the joint 'tilt_0'" in text


@pytest.mark.parametrize(
    ("parts", "what"),
    [
        ({"frames": ("tool", "lamp")}, "the site 'lamp'"),
        ({"frames": ("rotor_0_upper",)}, "contact 'tip' names the frame 'tool'"),
        ({"bodies": Bodies(gear=("skid",))}, "the body 'skid'"),
        ({"bodies": Bodies(base="group_0")}, "not the free joint of 'group_0'"),
        ({"contacts": (PointContact("tip", ("tip",), "tool", 1e3, 1.0),) * 2}, "geom 'tip' stands"),
        ({"contacts": (PointContact("pin", ("pin",), "tool", 1e3, 1.0),)}, "names the geom 'pin'"),
    ],
)
def test_other_names_that_are_not_there_are_refused(
    vehicle: Vehicle, parts: dict[str, object], what: str
) -> None:
    assert what in refusal(altered(vehicle, **parts))
