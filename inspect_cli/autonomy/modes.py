"""What a mode, an order and a vehicle's behaviour are; the vehicles fill in the tables.

A mode is a state of the mission executive: what it begins with, when it is done. An order asks for
a mode, with where it leads. Orders wait in one queue, whether they come from a plan or from
somebody who watches the flight.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from inspect_cli.errors import InputError
from inspect_cli.interfaces import Posture
from inspect_cli.schema.modes import ModeRow, ModeTable, Phase

if TYPE_CHECKING:
    from inspect_cli.autonomy.context import Context
    from inspect_cli.autonomy.failsafe import Failsafe


@dataclass(frozen=True)
class Order:
    """A mode that shall be entered, and where it leads."""

    mode: str
    target: int | None = None
    """Index of the plan's target that it works on."""
    postures: tuple[Posture, ...] = ()
    """Way-points, passed at rest; the last is the end."""
    speed_mps: float = 0.0
    leaving: int | None = None
    """Index of the target whose surface a safe mode backs off from first."""


def begin_nothing(context: Any, order: Order) -> None:
    """Begin a mode that only waits."""


def end_nothing(context: Any) -> None:
    """End a mode that leaves nothing behind."""


def always(context: Any) -> str:
    """A guard that lets every order pass."""
    return ""


@dataclass(frozen=True)
class Mode:
    """One state of the executive. Its functions take the vehicle's own ``Context``."""

    name: str
    number: int
    """Stands for the mode in a log, and nowhere else."""
    phase: Phase
    done: Callable[[Any], bool]
    """Whether it has come to its end; asked at the mission rate."""
    begin: Callable[[Any, Order], None] = begin_nothing
    end: Callable[[Any], None] = end_nothing
    """Called when it is done and another order follows; not when a failsafe cuts it short."""
    guard: Callable[[Any], str] = always
    """Why it must not be entered now; empty when it may. The order before goes on until then."""
    needs: frozenset[str] = frozenset()
    """What has to be fresh while it runs (``Context.is_fresh``)."""
    slides: bool = False
    """Whether a tool moves along the surface while it touches."""


@dataclass(frozen=True)
class Behaviour:
    """How a vehicle goes about a plan: its modes, its failsafes, and the orders of a plan."""

    modes: Mapping[str, Mode]
    failsafes: Sequence[Failsafe]
    first: str
    """The mode at the start."""
    orders: Callable[[Any], Sequence[Order]]
    """The orders of a Plan."""
    stop: Callable[[Any], Sequence[Order]]
    """Orders that end a flight from any mode, given the Context."""
    context: Callable[..., Context]
    """Makes the Context of one flight: (plan, stack, judges)."""

    def __post_init__(self) -> None:
        """Refuse tables that do not fit together.

        Raises:
            InputError: a mode that is named is not there, two modes have one number, or a failsafe
                leads to nothing.
        """
        numbers = [mode.number for mode in self.modes.values()]
        if len({*numbers}) < len(numbers):
            raise InputError("two modes of the vehicle have the same number")
        self.mode(self.first)
        for row in self.failsafes:
            for name in row.modes:
                self.mode(name)
            if not row.fallbacks:
                raise InputError(f"the failsafe {row.name!r} has no fallback")

    def mode(self, name: str) -> Mode:
        """The mode of a name.

        Raises:
            InputError: the vehicle has none.
        """
        if name not in self.modes:
            known = ", ".join(self.modes)
            raise InputError(f"the vehicle has no mode {name!r}", hint=f"it has: {known}")
        return self.modes[name]

    @property
    def table(self) -> ModeTable:
        """The modes as a log carries them."""
        rows = tuple(
            ModeRow(name=mode.name, number=mode.number, phase=mode.phase, slides=mode.slides)
            for mode in self.modes.values()
        )
        return ModeTable(modes=rows)


def by_name(*modes: Mode) -> dict[str, Mode]:
    """A table of modes."""
    return {mode.name: mode for mode in modes}
