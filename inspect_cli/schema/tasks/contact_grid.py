"""Task ``contact_grid``: touch a grid of points on a surface."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from inspect_cli.schema.base import Name, Positive
from inspect_cli.schema.tasks.base import CONTACT_MODES, MAX_POINTS, ContactOptions, TaskKind


class ContactGrid(ContactOptions):
    """A grid of points along the surface's level direction u and along v."""

    on: Name
    rows: Annotated[int, Field(ge=1, le=1000)]
    columns: Annotated[int, Field(ge=1, le=1000)]
    pitch_m: Positive
    offset_m: tuple[float, float] = (0.0, 0.0)
    """(u, v) of the grid's middle from the middle of the surface."""
    order: Literal["boustrophedon", "rows", "shortest"] = "boustrophedon"

    @model_validator(mode="after")
    def _not_too_many(self) -> ContactGrid:
        count = self.rows * self.columns
        if count > MAX_POINTS:
            raise ValueError(
                f"{self.rows} rows of {self.columns} columns are {count} points; "
                f"at most {MAX_POINTS} in one task: split it into several missions"
            )
        return self


KIND = TaskKind(ContactGrid, modes=CONTACT_MODES, surface_key="on", reads=True)
