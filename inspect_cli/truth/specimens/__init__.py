"""The field of each kind of specimen: one file and one row each.

A package outside this one adds a kind as an entry point of the group
``inspect_cli.specimen_fields``, under the name that its model has in ``inspect_cli.specimens``.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from inspect_cli.errors import EnvironmentFault
from inspect_cli.plugins import registered
from inspect_cli.schema.specimens import SpecimenModel
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.specimens.analytic import SpotField
from inspect_cli.truth.specimens.fields import SpecimenField
from inspect_cli.truth.specimens.grid import grid_field
from inspect_cli.truth.specimens.macro_cell import macro_cell_field

FIELDS: dict[str, Callable[[Any, Path, Patch | None], SpecimenField]] = registered(
    "inspect_cli.specimen_fields",
    {
        "analytic": lambda model, root, patch: SpotField(model),
        "grid": lambda model, root, patch: grid_field(model, root),
        "macro_cell": lambda model, root, patch: macro_cell_field(model, patch),
    },
    Callable,
)


def load_specimen(model: SpecimenModel, root: Path, patch: Patch | None = None) -> SpecimenField:
    """The field that a truth file describes; its files are relative to ``root``.

    ``patch`` is the surface that the specimen lies under, if it is known.

    Raises:
        InputError: the field cannot be made; names file, line and cell where a table is at fault.
        EnvironmentFault: nothing simulates specimens of that kind.
    """
    if model.model not in FIELDS:
        raise EnvironmentFault(
            f"nothing simulates a specimen of the model {model.model}",
            hint=f"models that are simulated: {', '.join(FIELDS)}",
        )
    return FIELDS[model.model](model, root, patch)
