"""What every kind of disturbance states."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Self

from inspect_cli.schema.base import Strict


class DisturbanceModel(Strict):
    """Something that pushes or pulls the vehicle. A kind adds its numbers."""

    depends_on_flight: ClassVar[bool] = True
    """Whether its force follows from the motion of the vehicle, or from chance: then it is worth a
    channel of the log."""

    kind: str

    @classmethod
    def refuse_together(cls, entries: Sequence[Self]) -> None:
        """Raise ValueError where a mission's entries of this kind cannot be at the same time."""
