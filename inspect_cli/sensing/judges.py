"""What judges the samples of each instrument: one file and one row each.

A package outside this one adds a row as an entry point of the group ``inspect_cli.judges``, under
the name that the instrument's sensor has in ``inspect_cli.sensors``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from inspect_cli.errors import EnvironmentFault
from inspect_cli.interfaces import Judging
from inspect_cli.plugins import registered
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.sensing.half_cell_judge import half_cell_judging

JUDGES: dict[str, Callable[[Any], Judging]] = registered(
    "inspect_cli.judges",
    {"half_cell": half_cell_judging},
    Callable,
)
"""By the instrument; takes the model of its sensor."""


def judges_of(platform: PlatformBase, instruments: Iterable[str]) -> dict[str, Judging]:
    """What judges the samples of a platform's instruments, by the instrument.

    Raises:
        EnvironmentFault: nothing judges samples of that kind.
        InputError: the platform has no such instrument.
    """
    judges = {}
    for name in instruments:
        if name not in JUDGES:
            raise EnvironmentFault(
                f"nothing judges the samples of {name}",
                hint=f"instruments that are judged: {', '.join(JUDGES)}",
            )
        judges[name] = JUDGES[name](platform.instrument(name))
    return judges
