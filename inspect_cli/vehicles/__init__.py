"""One module per kind of platform: nominal MuJoCo model, Capabilities, flight stack.

A new kind is a platform model in ``PLATFORM_KINDS``, a module here, and one line below. A package
outside this one adds a kind as an entry point of the group ``inspect_cli.vehicles``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from inspect_cli.errors import InputError
from inspect_cli.plugins import registered
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.vehicles.kinds import Vehicle
from inspect_cli.vehicles.tilt_rotor import TiltRotor

VEHICLES: dict[str, Callable[[Any], Vehicle]] = registered(
    "inspect_cli.vehicles",
    {"tilt_rotor": TiltRotor},
    Callable,
)


def build_vehicle(platform: PlatformBase) -> Vehicle:
    """The vehicle of a platform file."""
    if platform.kind not in VEHICLES:
        known = ", ".join(sorted(VEHICLES))
        raise InputError(f"no vehicle of kind '{platform.kind}'", hint=f"kinds are: {known}")
    return VEHICLES[platform.kind](platform)
