"""What every file in ``platforms/`` and every kind of platform keep to."""

from __future__ import annotations

import json
from pathlib import Path
from typing import get_args

import jsonschema
import numpy as np
import pytest

from inspect_cli.schema.json_schema import committed_file
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.strict_yaml import read_yaml
from inspect_cli.schema.tasks.base import Pressing
from inspect_cli.schema.vehicle import PLATFORM_KINDS, PlatformBase, TiltRotorPlatform
from inspect_cli.vehicles import VEHICLES, build_vehicle


def test_it_is_valid_in_an_editor(platform_file: Path) -> None:
    schema = json.loads(committed_file("platform").read_text(encoding="utf-8"))
    plain = json.loads(json.dumps(read_yaml(platform_file).plain))
    jsonschema.Draft202012Validator(schema).validate(plain)


def test_it_is_named_like_its_file_and_says_where_its_numbers_come_from(
    platform_file: Path,
) -> None:
    platform = load_platform(platform_file)
    assert platform.name == platform_file.stem
    assert platform.title
    assert platform.source


def test_it_comes_back_from_json(platform_file: Path) -> None:
    platform = load_platform(platform_file)
    assert type(platform).model_validate_json(platform.model_dump_json(by_alias=True)) == platform


def test_it_flies_with_each_of_its_profiles(platform_file: Path) -> None:
    platform = load_platform(platform_file)
    vehicle = build_vehicle(platform)
    assert vehicle.platform is platform
    assert vehicle.capabilities.impedances == tuple(platform.control.profiles)
    for profile in platform.control.profiles:
        # Pressing twice as deep presses twice as hard.
        laws = [
            vehicle.capabilities.contact_law(Pressing(press_m=depth_m), profile)
            for depth_m in (0.05, 0.10)
        ]
        shallow, deep = (law.expected_force_n for law in laws)
        assert deep == pytest.approx(2.0 * shallow)
        assert shallow > 0.0


@pytest.mark.parametrize("kind", sorted(PLATFORM_KINDS | VEHICLES))
def test_a_kind_has_a_file_model_and_a_vehicle(kind: str) -> None:
    model = PLATFORM_KINDS[kind]
    assert issubclass(model, PlatformBase)
    assert get_args(model.model_fields["kind"].annotation) == (kind,)
    assert callable(VEHICLES[kind])


def test_a_tilt_range_in_degrees_is_the_joints_range(root: Path) -> None:
    platform = load_platform(root / "platforms" / "tilt_rotor_hexarotor.yaml")
    assert isinstance(platform, TiltRotorPlatform)
    unit = platform.unit.model_copy(update={"range_deg": 30.0})
    limited = platform.model_copy(update={"unit": unit})
    model = build_vehicle(limited).nominal_spec().compile()
    assert model.jnt_limited[1:].all()
    assert np.allclose(model.jnt_range[1:], np.radians([-30.0, 30.0]))
