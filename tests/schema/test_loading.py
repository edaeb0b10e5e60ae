"""From files to models: what is refused, where, and with which advice."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli.errors import EXIT_INPUT_REFUSED, SchemaError
from inspect_cli.schema.campaign import builtin_root, campaign_root
from inspect_cli.schema.loading import load_mission, load_platform
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.vehicle import OdometryModel, TiltRotorPlatform

Refusal = Callable[[str, str], list[str]]


def test_a_good_mission_is_split_into_belief_and_truth(campaign: Path) -> None:
    loaded = load_mission(campaign / "missions" / "m.yaml")
    assert type(loaded.mission) is Mission
    assert not hasattr(loaded.mission, "truth")
    assert loaded.truth.structure["wall"].friction == 0.4
    assert loaded.root == campaign.resolve()
    assert loaded.mission_file == campaign / "missions" / "m.yaml"
    assert loaded.platform_file == builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml"
    assert isinstance(loaded.platform, TiltRotorPlatform)


def test_paths_become_relative_to_the_campaign(campaign: Path) -> None:
    loaded = load_mission(campaign / "missions" / "m.yaml")
    assert loaded.mission.structure[1].surface.cloud == "missions/scans/tank.ply"
    specimen = loaded.truth.structure["wall"].specimen
    assert specimen is not None
    assert specimen.model == "grid"
    assert specimen.potential_mv == "data/p.csv"
    assert specimen.resistivity_kohm_cm == "data/r.csv"


def test_the_resolved_mission_survives_json(campaign: Path) -> None:
    mission = load_mission(campaign / "missions" / "m.yaml").mission
    assert Mission.model_validate_json(mission.model_dump_json(by_alias=True)) == mission


@pytest.mark.parametrize(
    ("old", "new", "messages"),
    [
        (
            "pitch_m: 0.05",
            "pitch_cm: 5",
            [
                "m.yaml:18:7: tasks[0].contact_grid.pitch_cm: unknown key 'pitch_cm'\n"
                "    the key is 'pitch_m', in metres: write pitch_m: 0.05"
            ],
        ),
        (
            "pitch_m: 0.05",
            "pitch: 0.05",
            [
                "m.yaml:18:7: tasks[0].contact_grid.pitch: unknown key 'pitch'\n"
                "    the key is 'pitch_m', in metres"
            ],
        ),
        (
            "press_m: 0.1",
            "press_m: 10cm",
            [
                "m.yaml:19:16: tasks[0].contact_grid.press_m: must be a number; found 10cm\n"
                "    'press_m' is a plain number in metres: write 0.1"
            ],
        ),
        (
            "acceptance:",
            "acceptence:",
            [
                "m.yaml:27:1: acceptence: unknown key 'acceptence'\n"
                "    did you mean 'acceptance'? valid keys: schema, name, title, description, "
                "platform, impedance, estimation, seeds, tags, start, flight, structure, tasks, "
                "expect_status, acceptance, extends, truth"
            ],
        ),
        (
            "pitch_m: 0.05",
            "pitch_m: .nan",
            ["m.yaml:18:16: tasks[0].contact_grid.pitch_m: must be a finite number; found nan"],
        ),
        (
            "press_m: 0.1",
            "press_m: 1e999",
            ["m.yaml:19:16: tasks[0].contact_grid.press_m: must be a finite number; found inf"],
        ),
        (
            "pitch_m: 0.05",
            "pitch_m: -1",
            ["m.yaml:18:16: tasks[0].contact_grid.pitch_m: must be above 0; found -1"],
        ),
        (
            "      pitch_m: 0.05\n",
            "",
            ["m.yaml:14:5: tasks[0].contact_grid: missing key 'pitch_m'"],
        ),
        (
            "on: wall",
            "on: wal",
            [
                "m.yaml:15:11: tasks[0].contact_grid.on: no surface is named 'wal'\n"
                "    did you mean 'wall'? choices: wall, tank"
            ],
        ),
        (
            "fit: cylinder",
            "fit: cilinder",
            [
                "m.yaml:11:12: structure[1].surface.fit: no such choice: cilinder\n"
                "    did you mean 'cylinder'? choices: plane, sphere, cylinder, auto"
            ],
        ),
        (
            "kind: plane",
            "kind: plan",
            [
                "m.yaml:7:29: structure[0].surface.shape.kind: no such kind: plan\n"
                "    did you mean 'plane'? choices: plane, sphere, cylinder"
            ],
        ),
        (
            "{kind: plane, ",
            "{",
            [
                "m.yaml:7:15: structure[0].surface.shape: missing key 'kind'\n"
                "    choices: plane, sphere, cylinder"
            ],
        ),
        (
            "size_m: [3, 2]",
            "size: [3, 2]",
            [
                "m.yaml:7:79: structure[0].surface.shape.size: unknown key 'size'\n"
                "    the key is 'size_m', in metres"
            ],
        ),
        (
            "center_m: [3, 0, 1.5]",
            "center_m: [3, 0]",
            ["m.yaml:7:46: structure[0].surface.shape.center_m: must have 3 items; found 2"],
        ),
        (
            "normal: [-1, 0, 0]",
            "normal: [0, 0, 0]",
            ["m.yaml:7:67: structure[0].surface.shape.normal: a direction must not be zero"],
        ),
        (
            "normal: [-1, 0, 0]",
            "normal: [1.7e308, 1.7e308, 0]",
            [
                "m.yaml:7:67: structure[0].surface.shape.normal: "
                "a direction must be of finite length"
            ],
        ),
        (
            "max_m: [1, 1, 1]",
            "max_m: [1, -1, 1]",
            [
                "m.yaml:12:13: structure[1].surface.crop: "
                "min_m must be below max_m, but y has 0.0 ≥ -1.0"
            ],
        ),
        (
            "scans/tank.ply",
            "../../secret.ply",
            [
                "m.yaml:10:14: structure[1].surface.cloud: "
                "leads out of the campaign folder: ../../secret.ply\n"
                "    copy it into the campaign; paths are relative to the folder of m.yaml"
            ],
        ),
        (
            "scans/tank.ply",
            "scans/tnk.ply",
            [
                "m.yaml:10:14: structure[1].surface.cloud: no such file: scans/tnk.ply\n"
                "    paths are relative to the folder of m.yaml"
            ],
        ),
        (
            "platform: tilt_rotor_hexarotor",
            "platform: tilt_rotor_hexarotr",
            [
                "m.yaml:3:11: platform: no platform is named 'tilt_rotor_hexarotr'\n"
                "    did you mean 'tilt_rotor_hexarotor'? "
                "choices: tilt_rotor_hexarotor, tilt_rotor_hexarotor_30, "
                "tilt_rotor_hexarotor_force_evaluation"
            ],
        ),
        (
            "    wall:\n",
            "    wahl:\n",
            [
                "m.yaml:23:5: truth.structure.wahl: "
                "the truth of a surface that is not there: 'wahl'\n"
                "    did you mean 'wall'? choices: wall, tank; "
                "one that only the truth knows states its geometry"
            ],
        ),
        (
            "  - name: tank",
            "  - name: wall",
            ["m.yaml:8:11: structure[1].name: a second surface 'wall'"],
        ),
        (
            "friction: 0.4",
            "absent: yes",
            [
                "m.yaml:24:15: truth.structure.wall.absent: must be true or false; found yes\n"
                "    YAML 1.2 knows only true and false"
            ],
        ),
        (
            "min: 1.44, max: 2.16",
            "min: 2.16, max: 1.44",
            ["m.yaml:28:5: acceptance[0]: min 2.16 is above max 1.44"],
        ),
        ("schema: 1", "schema: 2", ["m.yaml:1:9: schema: no such choice: 2\n    choices: 1"]),
        ("seeds: [1, 2]", "seeds: []", ["m.yaml:4:8: seeds: must not be empty"]),
        ("seeds: [1, 2]", "seeds: [-1]", ["m.yaml:4:9: seeds[0]: must be at least 0; found -1"]),
    ],
)
def test_a_spoiled_mission(refusal: Refusal, old: str, new: str, messages: list[str]) -> None:
    assert refusal(old, new) == messages


def test_an_unknown_impedance_profile_lists_those_there_are(refusal: Refusal) -> None:
    (message,) = refusal("seeds: [1, 2]", "impedance: contact_ntd")
    assert message.startswith(
        "m.yaml:4:12: impedance: tilt_rotor_hexarotor has no impedance profile 'contact_ntd'\n"
        "    did you mean 'contact_ndt'? choices: "
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "      friction: 0.4\n",
            "      friction: 0.4\n      force_sensor: {rate_hz: 800}\n",
            "m.yaml:25:21: truth.structure.wall.force_sensor: rate_hz 800 does not divide "
            "physics_hz 1000 of tilt_rotor_hexarotor\n    the nearest that does is 1000; "
            "or fly a platform with a faster physics_hz",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: odometry}]\nacceptance:",
            "m.yaml:27:21: truth.faults[0].sensor: estimation external flies on pose; "
            "a fault of another has no effect\n    choices: pose",
        ),
        (
            "seeds: [1, 2]",
            "estimation: on-board",
            "m.yaml:4:13: estimation: no such choice: on-board\n"
            "    did you mean 'onboard'? choices: external, onboard",
        ),
    ],
)
def test_what_the_mission_asks_for_and_does_not_get(
    refusal: Refusal, old: str, new: str, message: str
) -> None:
    assert message in refusal(old, new)[0]


def test_onboard_estimation_needs_a_platform_with_odometry(campaign: Path) -> None:
    text = (builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()
    begin, end = text.index("  odometry:\n    kind: odometry"), text.index("  tof:\n")
    platform = campaign / "platforms" / "tilt_rotor_hexarotor.yaml"
    platform.write_text(text[:begin] + text[end:])
    mission = campaign / "missions" / "m.yaml"
    assert load_mission(mission).platform.find(OdometryModel) is None
    mission.write_text(mission.read_text().replace("seeds: [1, 2]", "estimation: onboard"))
    with pytest.raises(SchemaError) as caught:
        load_mission(mission)
    assert str(caught.value).endswith(
        "m.yaml:4:13: estimation: tilt_rotor_hexarotor has no sensor of kind odometry to fly on\n"
        "    choices: external"
    )


def test_one_surface_carries_a_force_sensor(refusal: Refusal) -> None:
    two = (
        "    tank: {force_sensor: {rate_hz: 500}}\n    wall:\n      force_sensor: {rate_hz: 250}\n"
    )
    (message,) = refusal("  structure:\n    wall:\n", f"  structure:\n{two}")
    assert message == (
        "m.yaml:25:21: truth.structure.wall.force_sensor: "
        "a second force sensor; one surface may carry one"
    )


def test_every_problem_of_a_file_is_reported_at_once_in_order(refusal: Refusal) -> None:
    messages = refusal(
        "      on: wall\n      rows: 1\n      columns: 2\n",
        "      on: roof\n      rows: 0\n      column: 2\n      cloud: none.ply\n",
    )
    assert [message.split(": ")[0] for message in messages] == [
        "m.yaml:15:11",  # no surface of that name
        "m.yaml:16:13",  # rows must be at least 1
        "m.yaml:17:7",  # column for columns, which is not also reported as missing
        "m.yaml:18:7",  # no such key
    ]


def test_a_symlink_out_of_the_campaign_is_refused(campaign: Path, refusal: Refusal) -> None:
    outside = campaign.parent / "secret.ply"
    outside.write_text("ply\n")
    (campaign / "missions" / "scans" / "link.ply").symlink_to(outside)
    (message,) = refusal("scans/tank.ply", "scans/link.ply")
    assert "m.yaml:10:14: structure[1].surface.cloud: leads out of the campaign" in message


def test_a_direction_is_made_a_unit_whatever_its_length(campaign: Path) -> None:
    file = campaign / "missions" / "m.yaml"
    file.write_text(file.read_text().replace("[-1, 0, 0]", "[3e200, 0, 4e200]"))
    shape = load_mission(file).mission.structure[0].surface.shape
    assert shape is not None
    assert shape.kind == "plane"
    assert shape.normal == pytest.approx((0.6, 0.0, 0.8), abs=1e-15)


def test_a_platform_of_the_campaign_comes_before_a_built_in_one(campaign: Path) -> None:
    text = (builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()
    own = campaign / "platforms" / "tilt_rotor_hexarotor.yaml"
    own.write_text(text.replace("title: ", "title: my "))
    loaded = load_mission(campaign / "missions" / "m.yaml")
    assert loaded.platform_file == own.resolve()
    assert loaded.platform.title.startswith("my ")


def test_a_platform_given_by_path_or_by_option(campaign: Path) -> None:
    text = (builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()
    (campaign / "platforms" / "heavy.yaml").write_text(text.replace("title: ", "title: heavy "))
    (campaign.parent / "other.yaml").write_text(text.replace("title: ", "title: other "))
    mission = campaign / "missions" / "m.yaml"
    mission.write_text(
        mission.read_text().replace(
            "platform: tilt_rotor_hexarotor", "platform: ../platforms/heavy.yaml"
        )
    )
    assert load_mission(mission).platform.title.startswith("heavy ")
    other = load_mission(mission, campaign.parent / "other.yaml")
    assert other.platform.title.startswith("other ")


def test_a_platform_given_by_name_in_the_option(campaign: Path) -> None:
    mission = campaign / "missions" / "m.yaml"
    builtin = load_mission(mission, Path("tilt_rotor_hexarotor_30"))
    assert builtin.platform_file == builtin_root() / "platforms" / "tilt_rotor_hexarotor_30.yaml"
    text = (builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()
    own = campaign / "platforms" / "heavy.yaml"
    own.write_text(text.replace("name: tilt_rotor_hexarotor", "name: heavy"))
    assert load_mission(mission, Path("heavy")).platform.name == "heavy"
    with pytest.raises(SchemaError) as caught:
        load_mission(mission, Path("heavi"))
    assert str(caught.value) == (
        "no platform is named 'heavi'\n    did you mean 'heavy'? "
        "choices: tilt_rotor_hexarotor, tilt_rotor_hexarotor_30, "
        "tilt_rotor_hexarotor_force_evaluation, heavy"
    )
    with pytest.raises(SchemaError, match=r"heavi\.yaml: there is no such file\n.*heavy\.yaml\?"):
        load_mission(mission, campaign / "platforms" / "heavi.yaml")


def test_problems_of_mission_and_platform_come_together(campaign: Path) -> None:
    (campaign / "platforms" / "tilt_rotor_hexarotor.yaml").write_text("kind: tilt_rotr\n")
    mission = campaign / "missions" / "m.yaml"
    mission.write_text(mission.read_text().replace("rows: 1", "rows: 0"))
    with pytest.raises(SchemaError) as caught:
        load_mission(mission)
    assert caught.value.exit_code == EXIT_INPUT_REFUSED
    assert [Path(p.where.file).name for p in caught.value.problems if p.where] == [
        "m.yaml",
        "tilt_rotor_hexarotor.yaml",
    ]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("mass_kg: 2.76", "mass_kg: -2.76", "42:12: core.mass_kg: must be above 0; found -2.76"),
        ("mass_kg: 2.76", "mass_g: 2760", "42:3: core.mass_g: unknown key 'mass_g'"),
        (
            "schema: 1\n",
            "schema: 1\nrates: {control_hz: -250}\n",
            "2:21: rates.control_hz: must be at least 1; found -250",
        ),
        (
            "schema: 1\n",
            "schema: 1\nrates: {control_hz: 300}\n",
            "2:8: rates: control_hz 300 does not divide physics_hz 1000",
        ),
        ("kind: tilt_rotor", "kind: tilt_rotr", "3:7: kind: no such kind of platform: tilt_rotr"),
        ("kind: tilt_rotor\n", "", "1:1: missing key 'kind'"),
        (
            "upper_spin: ccw",
            "upper_spin: left",
            "groups[0].upper_spin: no such choice: left",
        ),
        ("observer_gain: [1.0, ", "observer_gain: [.inf, ", "must be a finite number; found inf"),
    ],
)
def test_a_spoiled_platform(platform_refusal: Refusal, old: str, new: str, message: str) -> None:
    (found,) = platform_refusal(old, new)
    assert found.startswith("p.yaml:")
    assert message in found


def test_every_built_in_platform_loads() -> None:
    files = sorted((builtin_root() / "platforms").glob("*.yaml"))
    assert files
    for file in files:
        assert load_platform(file).name == file.stem


def test_the_campaign_is_the_folder_that_holds_missions(campaign: Path, tmp_path: Path) -> None:
    deep = campaign / "missions" / "walls" / "m.yaml"
    assert campaign_root(deep) == campaign.resolve()
    assert campaign_root(tmp_path / "m.yaml") == tmp_path.resolve()


def test_the_truth_may_add_a_surface_that_states_its_geometry(campaign: Path) -> None:
    (campaign / "missions" / "scans" / "vault.ply").write_text("not read yet")
    mission = campaign / "missions" / "m.yaml"
    text = mission.read_text()
    added = "    vault: {geometry: {kind: mesh, file: scans/vault.ply}, friction: 0.3}\n    wall:\n"
    mission.write_text(text.replace("    wall:\n", added))
    loaded = load_mission(mission)
    shape = loaded.truth.structure["vault"].geometry
    assert shape is not None
    assert shape.kind == "mesh"
    assert shape.file == "missions/scans/vault.ply"  # relative to the campaign
    assert "vault" not in [surface.name for surface in loaded.mission.structure]


@pytest.mark.parametrize(
    ("geometry", "message"),
    [
        ("{kind: mesh, file: scans/none.ply}", "structure.vault.geometry.file: no such file"),
        ("{kind: mesh, file: ../../x.ply}", "geometry.file: leads out of the campaign folder"),
        ("{kind: mesh}", "structure.vault.geometry: missing key 'file'"),
        ("{kind: mesh, file: scans/tank.ply, pitch_m: 0}", "pitch_m: must be at least 0.002"),
        ("{kind: msh, file: scans/tank.ply}", "choices: plane, sphere, cylinder, mesh"),
    ],
)
def test_a_spoiled_mesh_of_the_truth(refusal: Refusal, geometry: str, message: str) -> None:
    found = "\n".join(refusal("    wall:\n", f"    vault: {{geometry: {geometry}}}\n    wall:\n"))
    assert message in found


def test_no_planner_may_believe_in_a_mesh(refusal: Refusal) -> None:
    found = "\n".join(refusal("kind: plane", "kind: mesh"))
    assert "mesh" in found
    assert "choices: plane, sphere, cylinder" in found
