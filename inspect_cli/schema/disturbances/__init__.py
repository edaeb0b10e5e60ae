"""``truth: disturbances:`` of a mission: what pushes and pulls the vehicle without its knowledge.

One file and one row per kind. A package outside this one adds a kind as an entry point of the group
``inspect_cli.disturbances``. An entry without ``kind`` is a ``constant`` one. What each does stands
in ``inspect_cli.truth.disturbances``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from inspect_cli.plugins import registered
from inspect_cli.schema.disturbances.base import DisturbanceModel
from inspect_cli.schema.disturbances.cable import Cable
from inspect_cli.schema.disturbances.constant import ConstantWrench
from inspect_cli.schema.disturbances.rope import Pull, Rope
from inspect_cli.schema.disturbances.wind import Gust, Wind
from inspect_cli.schema.registry import OneOf

__all__ = [
    "DISTURBANCES",
    "Cable",
    "ConstantWrench",
    "Disturbance",
    "DisturbanceModel",
    "Gust",
    "Pull",
    "Rope",
    "Wind",
    "refuse_impossible",
]

DISTURBANCES: dict[str, type[DisturbanceModel]] = registered(
    "inspect_cli.disturbances",
    {"constant": ConstantWrench, "rope": Rope, "wind": Wind, "cable": Cable},
    DisturbanceModel,
)

Disturbance = Annotated[DisturbanceModel, OneOf(DISTURBANCES, default="constant")]


def refuse_impossible(disturbances: Sequence[DisturbanceModel]) -> None:
    """Raise ValueError for what cannot be at the same time: two winds, two pulling hands."""
    for model in dict.fromkeys(type(entry) for entry in disturbances):
        model.refuse_together([entry for entry in disturbances if type(entry) is model])
