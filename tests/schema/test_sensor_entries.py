"""``sensors:`` of a platform file: names, kinds, rates, and what older files are told."""

from __future__ import annotations

from pathlib import Path

import pytest

from inspect_cli.errors import SchemaError
from inspect_cli.schema.campaign import builtin_root
from inspect_cli.schema.loading import load_mission, load_platform
from inspect_cli.schema.vehicle import DepthCameraModel, HalfCellModel, ImuModel

HEXAROTOR = (builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()
VARIANT = "schema: 1\nextends: base.yaml\nname: v\n"


def refusals(folder: Path, text: str, base: str = HEXAROTOR) -> list[str]:
    (folder / "base.yaml").write_text(base)
    file = folder / "v.yaml"
    file.write_text(text)
    with pytest.raises(SchemaError) as caught:
        load_platform(file)
    return [str(problem).removeprefix(f"{folder}/") for problem in caught.value.problems]


@pytest.mark.parametrize(
    ("name", "instead"),
    [
        ("imu", "write imu: {kind: imu, rate_hz: 250, …}"),
        ("pose", "write pose: {kind: pose_tracker, rate_hz: 100, …}"),
        ("odometry", "write odometry: {kind: odometry, rate_hz: 30, …}"),
        (
            "tof",
            "write tof: {kind: depth_camera, rate_hz: 10, "
            "mount: {frame: body, axes: tool, position_m: [x, y, z]}, …}",
        ),
    ],
)
def test_a_sensor_without_kind_is_told_how_it_is_written_now(
    tmp_path: Path, name: str, instead: str
) -> None:
    text = HEXAROTOR.replace(f"  {name}:\n    kind: ", f"  {name}:\n    # ")
    line = text.splitlines().index(f"  {name}:") + 1
    (message,) = refusals(tmp_path, text)
    assert message == (
        f"v.yaml:{line}:3: sensors.{name}: {name} does not say its kind\n    {instead}"
    )


def test_the_half_cell_of_an_older_file_has_a_name_now(tmp_path: Path) -> None:
    (message,) = refusals(tmp_path, VARIANT + "sensors: {half_cell: {electrode: SCE}}\n")
    assert message == (
        "v.yaml:4:11: sensors.half_cell: half_cell does not say its kind and rate_hz\n"
        "    write probe: {kind: half_cell, rate_hz: 50, …}"
    )


def test_the_position_of_an_older_camera_is_its_mount_now(tmp_path: Path) -> None:
    (message,) = refusals(
        tmp_path, VARIANT + "sensors:\n  tof: {position_B_m: [0.028, 0.0, 0.169]}\n"
    )
    assert message == (
        "v.yaml:5:9: sensors.tof.position_B_m: position_B_m is no key of a sensor\n"
        "    write mount: {frame: body, axes: tool, position_m: [0.028, 0.0, 0.169]}"
    )


@pytest.mark.parametrize("name", ["imu", "pose", "odometry", "tof", "probe"])
def test_a_rate_of_a_sensor_stands_with_the_sensor_now(tmp_path: Path, name: str) -> None:
    (message,) = refusals(tmp_path, VARIANT + f"rates: {{{name}_hz: 20}}\n")
    assert message == (
        f"v.yaml:4:9: rates.{name}_hz: {name}_hz is no rate of the platform\n"
        "    rates of sensors stand in sensors.<name>.rate_hz: "
        f"write sensors: {{{name}: {{rate_hz: 20}}}}"
    )


def test_a_platform_that_extends_another_merges_sensors_by_name(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(HEXAROTOR)
    file = tmp_path / "v.yaml"
    file.write_text(VARIANT + "sensors: {tof: {rate_hz: 7}, odometry: null}\n")
    base, platform = load_platform(tmp_path / "base.yaml"), load_platform(file)
    camera = base.sensor(DepthCameraModel)
    assert platform.sensors == {
        "imu": base.sensors["imu"],
        "pose": base.sensors["pose"],
        "tof": camera.model_copy(update={"rate_hz": 7}),
        "probe": base.sensors["probe"],
    }


def test_a_sensor_of_another_kind_replaces_the_inherited_one(tmp_path: Path) -> None:
    (message,) = refusals(tmp_path, VARIANT + "sensors: {probe: {kind: imu, rate_hz: 250}}\n")[:1]
    assert message == "v.yaml:4:11: sensors.probe: missing key 'accel_noise'"


@pytest.mark.parametrize(
    ("sensors", "message"),
    [
        (
            "{imu: {rate_hz: 300}}",
            "v.yaml:4:26: sensors.imu.rate_hz: rate_hz 300 does not divide physics_hz 1000",
        ),
        (
            "{probe: {rate_hz: 30}}",
            "v.yaml:4:28: sensors.probe.rate_hz: rate_hz 30 does not divide physics_hz 1000",
        ),
        (
            "{tof: {rate_hz: 1200}}",
            "v.yaml:4:26: sensors.tof.rate_hz: rate_hz 1200 is above physics_hz 1000",
        ),
        ("{imu: null}", "sensors: a platform of kind tilt_rotor needs a sensor of kind imu"),
        (
            "{tof: null}",
            "sensors: a platform of kind tilt_rotor needs a sensor of kind depth_camera",
        ),
        (
            "{pose: null, odometry: null}",
            "sensors: a platform of kind tilt_rotor needs a sensor that tells its pose, "
            "of kind pose_tracker or odometry",
        ),
        (
            "{probe: {kind: sonar}}",
            "v.yaml:4:25: sensors.probe.kind: no such kind: sonar\n"
            "    choices: imu, pose_tracker, odometry, depth_camera, half_cell",
        ),
        (
            "{tof: {mount: {frame: head}}}",
            "v.yaml:4:32: sensors.tof.mount.frame: no such choice: head\n    choices: body, tool",
        ),
    ],
)
def test_sensors_that_do_not_fit_are_refused_at_their_place(
    tmp_path: Path, sensors: str, message: str
) -> None:
    (found,) = refusals(tmp_path, VARIANT + f"sensors: {sensors}\n")
    assert found.endswith(message)


def test_two_sensors_of_a_kind_are_refused(tmp_path: Path) -> None:
    begin, end = HEXAROTOR.index("  imu:\n"), HEXAROTOR.index("  pose:\n")
    second = HEXAROTOR[begin:end].replace("imu:", "spare:", 1)
    (message,) = refusals(tmp_path, VARIANT + "sensors:\n" + second)
    assert message == (
        "v.yaml:5:3: sensors.spare: a platform has one sensor of each kind; "
        "imu and spare are of kind imu"
    ) or message.startswith("v.yaml:6:5: sensors.spare: a platform has one sensor of each kind")


def test_a_camera_and_the_odometry_may_be_uneven_to_the_physics(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(HEXAROTOR)
    file = tmp_path / "v.yaml"
    file.write_text(VARIANT + "sensors: {tof: {rate_hz: 15}, odometry: {rate_hz: 35}}\n")
    assert {name: s.rate_hz for name, s in load_platform(file).sensors.items()} == {
        "imu": 250,
        "pose": 100,
        "odometry": 35,
        "tof": 15,
        "probe": 50,
    }


def test_a_probe_that_a_task_reads_with_has_to_be_there(campaign: Path) -> None:
    begin = HEXAROTOR.index("  probe:\n")
    platform = campaign / "platforms" / "tilt_rotor_hexarotor.yaml"
    platform.write_text(HEXAROTOR[:begin])
    assert load_platform(platform).find(HalfCellModel) is None
    with pytest.raises(SchemaError, match="has no sensor of kind half_cell to read with"):
        load_mission(campaign / "missions" / "m.yaml")


def test_sensors_may_have_any_name(campaign: Path) -> None:
    platform = campaign / "platforms" / "tilt_rotor_hexarotor.yaml"
    platform.write_text(HEXAROTOR.replace("  imu:\n", "  inertial:\n"))
    loaded = load_mission(campaign / "missions" / "m.yaml").platform
    assert loaded.sensor(ImuModel) is loaded.sensors["inertial"]
    assert type(loaded).model_validate_json(loaded.model_dump_json(by_alias=True)) == loaded


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (
            "{sensor: tofu}",
            "truth.faults[0].sensor: tilt_rotor_hexarotor has no sensor 'tofu'\n"
            "    did you mean 'tof'? choices: imu, pose, odometry, tof, probe",
        ),
        (
            "{sensor: wall}",
            "truth.faults[0].sensor: tilt_rotor_hexarotor has no sensor 'wall'\n"
            "    choices: imu, pose, odometry, tof, probe",
        ),
    ],
)
def test_a_fault_of_a_sensor_that_is_not_there_is_refused(
    campaign: Path, fault: str, message: str
) -> None:
    mission = campaign / "missions" / "m.yaml"
    mission.write_text(
        mission.read_text().replace("\nacceptance:", f"\n  faults: [{fault}]\nacceptance:")
    )
    with pytest.raises(SchemaError) as caught:
        load_mission(mission)
    assert str(caught.value).endswith(message)


def test_the_inertial_unit_may_fail_too(campaign: Path) -> None:
    mission = campaign / "missions" / "m.yaml"
    text = mission.read_text()
    mission.write_text(text.replace("\nacceptance:", "\n  faults: [{sensor: imu}]\nacceptance:"))
    assert load_mission(mission).truth.faults[0].sensor == "imu"


@pytest.mark.parametrize("name", ["tool", "body", "wall", "wind"])
def test_a_sensor_is_not_called_as_something_else_is(tmp_path: Path, name: str) -> None:
    """Frames, the wall's force sensor and the gusts are asked for by these names."""
    base = HEXAROTOR.replace("\n  tof:\n", f"\n  {name}:\n")
    (message,) = refusals(tmp_path, base)
    line = base.splitlines().index(f"  {name}:") + 2
    assert message.startswith(f"v.yaml:{line}:5: sensors.{name}: ")
    assert f"a sensor cannot be called {name!r}" in message
