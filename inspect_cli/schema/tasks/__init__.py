"""``tasks:`` of a mission: what the vehicle shall touch, trace, follow or hold, in order.

A task is one of the kinds in ``TASK_KINDS``, with the instrument and the impedance profile it is
done with. A kind that touches a surface of the structure names it by ``on``.

A further kind is a module with its model (a subclass of ``base.Work``) and its row; the row of one
from another package is an entry point of the group ``inspect_cli.tasks``.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from pydantic import Field, create_model, model_validator

from inspect_cli.plugins import registered
from inspect_cli.schema.base import Name, Strict
from inspect_cli.schema.registry import choice_of
from inspect_cli.schema.tasks import (
    contact_grid,
    contact_points,
    coverage,
    hold,
    servo,
    trace,
)
from inspect_cli.schema.tasks.base import TaskKind, Work
from inspect_cli.schema.vehicle.sensors import INSTRUMENTS

TASK_KINDS: dict[str, TaskKind] = registered(
    "inspect_cli.tasks",
    {
        "contact_grid": contact_grid.KIND,
        "contact_points": contact_points.KIND,
        "coverage": coverage.KIND,
        "hold": hold.KIND,
        "trace": trace.KIND,
        "servo": servo.KIND,
    },
    TaskKind,
)
"""Every kind of task by its key in the mission, in the order in which messages list them."""


NO_SENSOR = "none"
"""What a task states that touches and does not read."""


def tasks_with(modes: Collection[str]) -> frozenset[str]:
    """The kinds of tasks that a vehicle with these modes can do."""
    return frozenset(name for name, kind in TASK_KINDS.items() if kind.modes <= set(modes))


class TaskBase(Strict):
    """Something to do, and the instrument and the impedance profile to do it with."""

    if TYPE_CHECKING:  # pydantic makes these fields of the registry, below
        sensor: str | None
        impedance: Name | None

    @model_validator(mode="after")
    def _one_kind(self) -> TaskBase:
        given = [name for name in TASK_KINDS if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"give exactly one of {', '.join(TASK_KINDS)}")
        if self.sensor not in (None, NO_SENSOR) and not TASK_KINDS[given[0]].reads:
            reader = f"the {self.sensor}".replace("_", "-")
            raise ValueError(f"{reader} reads at contacts; a {given[0]} has none to read at")
        self.work.check_instrument(self.instrument)
        return self

    @property
    def kind(self) -> str:
        """The name of its kind."""
        return next(name for name in TASK_KINDS if getattr(self, name) is not None)

    @property
    def work(self) -> Work:
        """What it asks for."""
        work: Work = getattr(self, self.kind)
        return work

    @property
    def on(self) -> str | None:
        """The surface of the structure that it is done on."""
        key = TASK_KINDS[self.kind].surface_key
        return None if key is None else getattr(self.work, key)

    @property
    def instrument(self) -> str | None:
        """What reads at its points."""
        if self.sensor is None:
            return next(iter(INSTRUMENTS)) if TASK_KINDS[self.kind].reads else None
        return None if self.sensor == NO_SENSOR else self.sensor


def _fields() -> dict[str, Any]:
    """A field for each kind, of which one is given, and those that all kinds share."""
    fields: dict[str, Any] = {name: (kind.model | None, None) for name, kind in TASK_KINDS.items()}
    default = next(iter(INSTRUMENTS)).replace("_", "-")
    reads = f"What is read at each point; by default the {default} at contacts, nothing elsewhere."
    profile = "One of the platform's profiles; without it, the mission's."
    fields["sensor"] = (choice_of((*INSTRUMENTS, NO_SENSOR)) | None, Field(None, description=reads))
    fields["impedance"] = (Name | None, Field(None, description=profile))
    return fields


if TYPE_CHECKING:

    class Task(TaskBase):
        """Something to do; its fields are the kinds of the registry."""

else:
    Task = create_model(
        "Task", __base__=TaskBase, __doc__=TaskBase.__doc__, __module__=__name__, **_fields()
    )
