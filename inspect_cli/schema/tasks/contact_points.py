"""Task ``contact_points``: touch points that are given one by one."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Name, Positive, Triple
from inspect_cli.schema.tasks.base import CONTACT_MODES, MAX_POINTS, ContactOptions, TaskKind


class ContactPoints(ContactOptions):
    """Points given one by one."""

    on: Name
    at_m: Annotated[tuple[Triple, ...], Field(min_length=1, max_length=MAX_POINTS)]
    """World positions on the surface, within ``tolerance_m`` of it."""
    tolerance_m: Positive = 0.05
    order: Literal["given", "shortest"] = "given"


KIND = TaskKind(ContactPoints, modes=CONTACT_MODES, surface_key="on", reads=True)
