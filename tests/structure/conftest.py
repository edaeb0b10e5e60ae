"""A mission whose structure is one surface, or several."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from inspect_cli.schema.mission import (
    Mission,
    Start,
    StructureSurface,
    SurfaceSource,
)
from inspect_cli.schema.tasks import Task
from inspect_cli.schema.tasks.contact_grid import ContactGrid

MissionOn = Callable[..., Mission]


@pytest.fixture
def mission_on() -> MissionOn:
    """``mission_on(wall=SurfaceSource(...), start=(0, 0))``."""

    def build(start: tuple[float, float] = (0.0, 0.0), **surfaces: SurfaceSource) -> Mission:
        first = next(iter(surfaces))
        return Mission(
            name="a-test",
            platform="none",
            start=Start(position_m=start),
            structure=tuple(StructureSurface(name=n, surface=s) for n, s in surfaces.items()),
            tasks=(Task(contact_grid=ContactGrid(on=first, rows=1, columns=1, pitch_m=0.1)),),
        )

    return build
