"""Whatever is put anywhere into a good file, the loader accepts it or refuses it with a place."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from inspect_cli.errors import Problem, SchemaError
from inspect_cli.schema.campaign import builtin_root
from inspect_cli.schema.loading import load_mission, load_platform
from inspect_cli.schema.strict_yaml import read_yaml

QUIET = settings(
    deadline=None,
    max_examples=150,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)

scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=10),
    st.sampled_from(
        ["plane", "wall", "tank", "10 cm", "contact_ndt", "grid", "../m.yaml", "1e999"]
    ),
)
keys = st.one_of(
    st.sampled_from(["kind", "model", "name", "on", "shape", "pitch", "pitch_cm", "center_m", "x"]),
    st.text(max_size=5),
)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=3),
    max_leaves=8,
)


def places(data: Any) -> list[tuple[Any, Any]]:
    """Every (container, key or index) of nested data."""
    items = data.items() if isinstance(data, dict) else enumerate(data)
    found = []
    for step, child in list(items):
        found.append((data, step))
        if isinstance(child, dict | list):
            found += places(child)
    return found


def spoil(draw: st.DataObject, file: Path) -> Any:
    data = json.loads(json.dumps(read_yaml(file).plain))
    container, step = draw.draw(st.sampled_from(places(data)))
    what = draw.draw(st.sampled_from(["replace", "remove", "add"]))
    if what == "remove":
        del container[step]
    elif what == "add" and isinstance(container, dict):
        container[draw.draw(keys)] = draw.draw(values)
    else:
        container[step] = draw.draw(values)
    return data


def load_or_refuse(load: Callable[[Path], object], file: Path) -> None:
    problems: tuple[Problem, ...] = ()
    try:
        load(file)
    except SchemaError as error:
        problems = error.problems or (Problem(""),)
    for problem in problems:
        assert problem.what
        assert problem.where is not None
        assert problem.where.line is not None


@QUIET
@given(draw=st.data())
def test_a_spoiled_mission_is_refused_at_a_place(campaign: Path, draw: st.DataObject) -> None:
    spoiled = campaign / "missions" / "spoiled.yaml"
    data = spoil(draw, campaign / "missions" / "m.yaml")
    spoiled.write_text(json.dumps(data), encoding="utf-8")
    load_or_refuse(load_mission, spoiled)


@QUIET
@given(draw=st.data())
def test_a_spoiled_platform_is_refused_at_a_place(tmp_path: Path, draw: st.DataObject) -> None:
    spoiled = tmp_path / "spoiled.yaml"
    data = spoil(draw, builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml")
    spoiled.write_text(json.dumps(data), encoding="utf-8")
    load_or_refuse(load_platform, spoiled)


@pytest.mark.parametrize("value", ["null", "[]", "{}", "1", "text", "true"])
def test_the_whole_file_is_something_else(campaign: Path, value: str) -> None:
    file = campaign / "missions" / "other.yaml"
    file.write_text(value)
    load_or_refuse(load_mission, file)
    load_or_refuse(load_platform, file)
