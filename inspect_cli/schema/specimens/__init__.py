"""The kinds of ``specimen:`` that a surface's truth may state: one file and one row each.

A package outside this one adds a kind as an entry point of the group ``inspect_cli.specimens``.
What a probe reads on each stands in ``inspect_cli.truth.specimens``.
"""

from __future__ import annotations

from typing import Annotated

from inspect_cli.plugins import registered
from inspect_cli.schema.registry import OneOf
from inspect_cli.schema.specimens.analytic import AnalyticSpecimen, AnalyticSpot
from inspect_cli.schema.specimens.base import SpecimenModel
from inspect_cli.schema.specimens.grid import GridSpecimen
from inspect_cli.schema.specimens.macro_cell import MacroCellSpecimen

__all__ = [
    "SPECIMENS",
    "AnalyticSpecimen",
    "AnalyticSpot",
    "GridSpecimen",
    "MacroCellSpecimen",
    "Specimen",
    "SpecimenModel",
]

SPECIMENS: dict[str, type[SpecimenModel]] = registered(
    "inspect_cli.specimens",
    {"analytic": AnalyticSpecimen, "grid": GridSpecimen, "macro_cell": MacroCellSpecimen},
    SpecimenModel,
)

Specimen = Annotated[SpecimenModel, OneOf(SPECIMENS, key="model")]
