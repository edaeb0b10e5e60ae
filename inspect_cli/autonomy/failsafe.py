"""When to give up, and what follows: a table of conditions with the modes that each watches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from inspect_cli.autonomy.modes import Order

Fallback = Callable[[Any], Sequence[Order]]
"""Makes the orders that follow a violation from the vehicle's ``Context``."""


def never(inputs: Any) -> bool:
    """A condition that is never clear again."""
    return False


@dataclass(frozen=True)
class Failsafe:
    """One row: what is watched, in which modes, for how long it may be so, what follows.

    ``violated`` and ``clear`` take the vehicle's inputs; write them so that NaN violates.
    """

    name: str
    modes: frozenset[str]
    violated: Callable[[Any], bool]
    patience_s: float
    severity: int
    """Of several violated rows the one with the largest severity is acted on."""
    fallbacks: tuple[Fallback, ...]
    """What follows, mildest first: the first one whose modes have what they need."""
    retries: int = 0
    """How often the interrupted target is begun again once the row is clear."""
    clear: Callable[[Any], bool] = never
    """Whether the mission may go on; asked when the orders of the fallback are done."""
    wait_s: float = 0.0
    """How long to wait for that."""


@dataclass
class Watch:
    """Keeps how long each condition has been violated."""

    table: Sequence[Failsafe]
    _since: dict[str, float] = field(default_factory=dict)
    _mode: str = ""
    _rows: Sequence[Failsafe] = ()

    def check(self, mode: str, t_s: float, inputs: Any) -> Failsafe | None:
        """The severest row whose patience is over, the first of equals; None if all is well."""
        if mode != self._mode:
            self._mode, self._rows = mode, [row for row in self.table if mode in row.modes]
            watched = {row.name for row in self._rows}
            self._since = {name: t for name, t in self._since.items() if name in watched}
        worst: Failsafe | None = None
        for row in self._rows:
            if not row.violated(inputs):
                self._since.pop(row.name, None)
                continue
            since = self._since.setdefault(row.name, t_s)
            due = t_s - since >= row.patience_s
            if due and (worst is None or row.severity > worst.severity):
                worst = row
        return worst
