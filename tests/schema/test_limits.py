"""Values that no structure, flight or body can have: refused where they stand."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from inspect_cli.schema.explain import problems_of
from inspect_cli.schema.geometry import CylinderShape, Shape, SphereShape
from inspect_cli.schema.nodes import Node
from inspect_cli.schema.tasks.base import ContactOptions
from inspect_cli.schema.tasks.contact_points import ContactPoints

Refusal = Callable[[str, str], list[str]]

GRID = "m.yaml:15:7: tasks[0].contact_grid"
SURFACE = "m.yaml:7:14: structure[0].surface"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("rows: 1", "rows: 1001", "m.yaml:16:13: tasks[0].contact_grid.rows: must be at most 1000"),
        ("columns: 2", "columns: 1001", "contact_grid.columns: must be at most 1000; found 1001"),
        (
            "rows: 1\n      columns: 2",
            "rows: 101\n      columns: 100",
            f"{GRID}: 101 rows of 100 columns are 10100 points; at most 10000 in one task: "
            "split it into several missions",
        ),
        ("press_m: 0.1", "dwell_s: 3601", "contact_grid.dwell_s: must be at most 3600; found 3601"),
        ("press_m: 0.1", "standoff_m: 1.6", "contact_grid.standoff_m: must be at most 1.5"),
        ("press_m: 0.1", "off_target_m: 0", "contact_grid.off_target_m: must be above 0; found 0"),
        (
            "seeds: [1, 2]",
            "start: {takeoff_height_m: 121}",
            "m.yaml:4:27: start.takeoff_height_m: must be at most 120; found 121",
        ),
        (
            "seeds: [1, 2]",
            "seeds: [4, 1, 4]",
            "m.yaml:4:8: seeds: the same seed a second time: 4",
        ),
        (
            "{shape: {",
            "{fit: plane, shape: {",
            f"{SURFACE}: a shape is taken as it is given; fit would have no effect",
        ),
        (
            "{shape: {",
            "{options: {inlier_m: 0.1}, crop: {min_m: [0, 0, 0], max_m: [1, 1, 1]}, shape: {",
            f"{SURFACE}: a shape is taken as it is given; options and crop would have no effect",
        ),
        (
            "{kind: plane, center_m: [3, 0, 1.5], normal: [-1, 0, 0], size_m: [3, 2]}",
            "{kind: cylinder, center_m: [3, 0, 1], axis: [0, 0, 2], facing: [0, 0, -1],"
            " radius_m: 1, size_m: [1, 1]}",
            "m.yaml:7:22: structure[0].surface.shape: facing must not be parallel to axis",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: tof, start_s: 5, end_s: 5}]\nacceptance:",
            "m.yaml:27:12: truth.faults[0]: end_s 5 must be after start_s 5",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: pose, fault: holes, share: 0.5}]\nacceptance:",
            "m.yaml:27:12: truth.faults[0]: only the images of tof have holes; "
            "pose can be off or nan",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: tof, fault: holes}]\nacceptance:",
            "m.yaml:27:12: truth.faults[0]: holes need a share of the pixels, such as share: 0.5",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: tof, fault: nan, share: 0.5}]\nacceptance:",
            "m.yaml:27:12: truth.faults[0]: share goes with fault: holes; nan takes everything",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: tof, fault: holes, share: 1.0}]\nacceptance:",
            "m.yaml:27:47: truth.faults[0].share: must be below 1; found 1.0",
        ),
        (
            "acceptance:",
            "  faults: [{sensor: tof, fault: hole}]\nacceptance:",
            "choices: off, nan, holes",
        ),
    ],
)
def test_limits_of_a_mission(refusal: Refusal, old: str, new: str, message: str) -> None:
    (found,) = refusal(old, new)
    assert message in found


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "inertia_kgm2: [0.0090, 0.0131, 0.0164]",
            "inertia_kgm2: [0.0090, 0.0131, 0.0222]",
            "p.yaml:43:17: core.inertia_kgm2: no body has these moments of inertia: "
            "0.0222 about z is more than the sum of the other two, 0.0221",
        ),
        (
            "range_m: [0.1, 3.0]",
            "range_m: [3.0, 3.0]",
            "sensors.tof.range_m: the least range 3 must be below the greatest 3",
        ),
        (
            "field_of_view_deg: [62",
            "field_of_view_deg: [180",
            "sensors.tof.field_of_view_deg[0]: must be below 180; found 180",
        ),
        (
            "azimuth_deg: -150",
            "azimuth_deg: 390",
            "groups: groups 2 and 3 stand in the same place: azimuths 30° and 390°",
        ),
    ],
)
def test_limits_of_a_platform(platform_refusal: Refusal, old: str, new: str, message: str) -> None:
    (found,) = platform_refusal(old, new)
    assert message in found


def test_a_flat_plate_is_a_body(platform_refusal: Refusal) -> None:
    """I_z = I_x + I_y is the limit; only the key that does not exist is refused."""
    (found,) = platform_refusal(
        "inertia_kgm2: [0.0090, 0.0131, 0.0164]", "inertia_kgm2: [0.25, 0.5, 0.75]\n  wings: 2"
    )
    assert "unknown key 'wings'" in found


def test_too_few_items_are_called_too_few(platform_refusal: Refusal) -> None:
    removed = "\n".join(
        f"  - {{azimuth_deg: {azimuth}, upper_spin: {spin}}}"
        for azimuth, spin in ((90, "cw"), (30, "ccw"), (-150, "cw"), (-30, "cw"), (150, "ccw"))
    )
    (found,) = platform_refusal(removed, "")
    assert "groups: has 1 item, which is too few: at least 3" in found


def test_too_many_items_are_called_too_many() -> None:
    """On the model: a file with so many values is refused before it gets there."""
    with pytest.raises(ValidationError) as caught:
        ContactPoints(on="wall", at_m=((0.0, 0.0, 0.0),) * 10_001)
    point = Node(tuple(Node(0.0, "m.yaml", 3, 1) for _ in range(3)), "m.yaml", 3, 1)
    points = Node((point,) * 10_001, "m.yaml", 2, 7)
    file = Node({"on": Node("wall", "m.yaml", 1, 5), "at_m": points}, "m.yaml", 1, 1)
    (problem,) = problems_of(caught.value, ContactPoints, file)
    said = "m.yaml:2:7: at_m: has 10001 items, which is too many: at most 10000"
    assert str(problem) == said


def test_the_limits_themselves_are_allowed() -> None:
    ContactOptions(dwell_s=3600.0, standoff_m=1.5)
    ContactPoints(on="wall", at_m=((0.0, 0.0, 0.0),) * 10_000)
    assert ContactOptions().off_target_m == 0.03


CYLINDER: dict[str, Any] = {
    "kind": "cylinder",
    "center_m": (0.0, 0.0, 1.0),
    "axis": (0.0, 0.0, 1.0),
    "facing": (1.0, 0.0, 1.0),
    "radius_m": 0.5,
    "size_m": (1.0, 1.0),
}
SPHERE: dict[str, Any] = {
    "kind": "sphere",
    "center_m": (0.0, 0.0, 1.0),
    "facing": (1.0, 0.0, 0.0),
    "radius_m": 0.5,
    "size_m": (1.0, 1.0),
}


@pytest.mark.parametrize(
    ("shape", "size", "message"),
    [
        (CYLINDER, (3.15, 9.0), "3.15 is longer than the circumference 2πR, 3.14159"),
        (SPHERE, (3.15, 1.0), "3.15 is longer than the equator 2πR, 3.14159"),
        (SPHERE, (3.0, 1.58), "1.58 is longer than a meridian πR, 1.5708"),
    ],
)
def test_no_patch_goes_around_twice(
    shape: dict[str, Any], size: tuple[float, float], message: str
) -> None:
    with pytest.raises(ValidationError, match=message):
        TypeAdapter(Shape).validate_python(shape | {"size_m": size})


def test_a_patch_may_go_around_once() -> None:
    around = 2.0 * math.pi * 0.5
    assert CylinderShape(**CYLINDER | {"size_m": (around, 9.0)}).size_m == (around, 9.0)
    assert SphereShape(**SPHERE | {"size_m": (around, around / 2)}).size_m[0] == around


def test_an_electrode_that_does_not_exist(platform_refusal: Refusal) -> None:
    (found,) = platform_refusal(
        "    kind: half_cell\n", "    kind: half_cell\n    electrode: Ag/AgCl\n"
    )
    assert "sensors.probe.electrode" in found
    assert "p.yaml:" in found
    for choice in ("CSE", "SCE", "Ag/AgCl sat. KCl", "Ag/AgCl 0.1 M KCl"):
        assert choice in found


@pytest.mark.parametrize("temperature_c", ["-0.5", "49.5", ".nan"])
def test_a_temperature_that_the_standard_does_not_correct(
    refusal: Refusal, temperature_c: str
) -> None:
    (found,) = refusal("  - name: wall\n", f"  - name: wall\n    temperature_c: {temperature_c}\n")
    assert "m.yaml:7:20: structure[0].temperature_c: must be" in found
