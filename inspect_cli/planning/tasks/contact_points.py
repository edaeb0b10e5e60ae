"""Planner of the task ``contact_points``."""

from __future__ import annotations

from inspect_cli.planning.tasks.situation import Asked, Planners
from inspect_cli.planning.tasks.touch import touching_points
from inspect_cli.schema.tasks.contact_points import ContactPoints


def planners_of(asked: Asked) -> Planners:
    """A planner for each point, in the order of the flight."""
    work = asked.task.work
    assert isinstance(work, ContactPoints)  # the registry has looked it up by its kind
    return touching_points(asked, work)
