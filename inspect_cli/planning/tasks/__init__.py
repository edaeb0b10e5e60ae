"""Planners of tasks: from what a mission asks for to the segments of its flight.

Each kind of task has a module with ``planners_of``, which gives a planner for each of its places,
and a row here under its name in ``schema.tasks.TASK_KINDS``. A planner is given where the vehicle
comes from, and answers with a segment, or with the reasons why there is none. The planner of a kind
from another package is an entry point of the group ``inspect_cli.task_planners``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from inspect_cli.interfaces import TOOL, Capabilities, Posture
from inspect_cli.planning.tasks import contact_grid, contact_points, hold, servo, trace
from inspect_cli.planning.tasks.situation import Asked, Planner, Planners
from inspect_cli.plugins import registered
from inspect_cli.schema.mission import Mission
from inspect_cli.spatial.arrays import Structured
from inspect_cli.structure.drawings import Stroke

TASK_PLANNERS: dict[str, Callable[[Asked], Planners]] = registered(
    "inspect_cli.task_planners",
    {
        "contact_grid": contact_grid.planners_of,
        "contact_points": contact_points.planners_of,
        "hold": hold.planners_of,
        "trace": trace.planners_of,
        "servo": servo.planners_of,
    },
    Callable,
)
"""By the kind of task. A coverage has none: it is split into sorties by ``planning.coverage``."""


def planners_of(
    mission: Mission,
    capabilities: Capabilities,
    prims: Mapping[str, Structured],
    drawings: Mapping[int, Sequence[Stroke]],
    hover: Posture,
) -> Iterator[Planner]:
    """The planners of all tasks in the order of the flight.

    ``prims`` are the believed surfaces by name, ``drawings`` the strokes by the task's place.
    """
    number, tip_W = 1, capabilities.frame_pose(hover, TOOL)[0]
    for place, task in enumerate(mission.tasks):
        asked = Asked(mission, place, prims, drawings, number, tip_W)
        each, tip_W = TASK_PLANNERS[task.kind](asked)
        yield from each
        number += len(each)
