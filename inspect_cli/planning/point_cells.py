"""The part of a surface that a point stands for: widths along u and v, written into the plan.

A point of a grid or of a coverage stands for the square of one pitch around it; a point that is
added between others stands for what they do, up to the middle between them. Points given one by
one stand for the typical spacing of all points that are read on their surface in the same way,
grids among them. One that stands alone does not say what it stands for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from inspect_cli.assessment.spacing import PLACE_DECIMALS, spacing_of
from inspect_cli.planning.points import places_of_task
from inspect_cli.schema.tasks import Task
from inspect_cli.schema.tasks.contact_grid import ContactGrid
from inspect_cli.schema.tasks.contact_points import ContactPoints
from inspect_cli.spatial.arrays import Structured

Cell = tuple[float, float]
"""Widths along u and v, m."""


def cells_of_tasks(
    tasks: Sequence[Task], prims: Mapping[str, Structured]
) -> dict[int, Cell | None]:
    """The cell of the points of each task of contacts, by the task's place.

    ``prims`` are the believed surfaces by name.
    """
    cells: dict[int, Cell | None] = {}
    for place, task in enumerate(tasks):
        work = task.work
        if isinstance(work, ContactGrid):
            cells[place] = (work.pitch_m, work.pitch_m)
        elif isinstance(work, ContactPoints):
            cells[place] = _typical(task, tasks, prims[work.on])
    return cells


def _typical(task: Task, tasks: Sequence[Task], prim: Structured) -> Cell | None:
    """The typical spacing of what is read on a task's surface in the same way."""
    alike = [other for other in tasks if (other.on, other.instrument) == (task.on, task.instrument)]
    places = [
        (u, v)
        for other in alike
        if isinstance(other.work, ContactGrid | ContactPoints)
        for u, v, _ in places_of_task(other.work, prim)
    ]
    spacing = spacing_of(np.unique(np.round(np.array(places), PLACE_DECIMALS), axis=0))
    return None if spacing is None else (spacing.u_m, spacing.v_m)
