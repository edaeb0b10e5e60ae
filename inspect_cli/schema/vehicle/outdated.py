"""Platform files in the form before sensors were named: what to write instead, at its place."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.errors import Problem
from inspect_cli.schema.explain import shown
from inspect_cli.schema.nodes import Node

INSTEAD = {
    "imu": "imu: {kind: imu, rate_hz: 250, …}",
    "pose": "pose: {kind: pose_tracker, rate_hz: 100, …}",
    "odometry": "odometry: {kind: odometry, rate_hz: 30, …}",
    "tof": (
        "tof: {kind: depth_camera, rate_hz: 10, "
        "mount: {frame: body, axes: tool, position_m: [x, y, z]}, …}"
    ),
    "half_cell": "probe: {kind: half_cell, rate_hz: 50, …}",
}
"""The sensors that every platform used to have, and how they are written now."""
RATES = ("imu", "pose", "odometry", "tof", "probe")
"""Sensors whose rates used to stand in ``rates:``."""


def outdated_entries(platform: Node) -> list[Problem]:
    """Every entry of a platform file that was valid before sensors were a map of names."""
    problems: list[Problem] = []
    rates, sensors = platform.child("rates"), platform.child("sensors")
    if rates is not None:
        problems += _rates(rates)
    if sensors is not None:
        for name, sensor in sensors.children():
            problems += _sensor(str(name), sensor)
    return problems


def _rates(rates: Node) -> Iterator[Problem]:
    for name in RATES:
        rate = rates.child(f"{name}_hz")
        if rate is not None:
            yield Problem(
                f"{name}_hz is no rate of the platform",
                rate.key_at(f"rates.{name}_hz"),
                "rates of sensors stand in sensors.<name>.rate_hz: "
                f"write sensors: {{{name}: {{rate_hz: {shown(rate.value)}}}}}",
            )


def _sensor(name: str, sensor: Node) -> Iterator[Problem]:
    place = sensor.child("position_B_m")
    if sensor.child("kind") is None and name in INSTEAD and isinstance(sensor.value, dict):
        missing = "kind" if sensor.child("rate_hz") is not None else "kind and rate_hz"
        what = f"{name} does not say its {missing}"
        yield Problem(what, sensor.key_at(f"sensors.{name}"), f"write {INSTEAD[name]}")
    elif place is not None:
        numbers = [shown(axis.value) for _, axis in place.children()] or ["x", "y", "z"]
        yield Problem(
            "position_B_m is no key of a sensor",
            place.key_at(f"sensors.{name}.position_B_m"),
            f"write mount: {{frame: body, axes: tool, position_m: [{', '.join(numbers)}]}}",
        )
