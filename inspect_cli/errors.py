"""What can go wrong, and what the shell is told of it.

    InspectError                 exit 3 unless a subclass says otherwise
    ├── InputError               exit 2: the input was refused, nothing was written
    │   ├── SchemaError          a mission, platform or campaign file breaks the schema
    │   ├── GeometryError        a cloud or mesh cannot be read or fitted
    │   ├── InfeasibleError      the plan cannot be flown; carries one reason per point
    │   └── LogError             a file is not a log, or its bytes are damaged
    └── EnvironmentFault         exit 3: this installation cannot do what was asked

A flight that was aborted or diverged is a result with a status, not an error.
Exit codes: 0 all good; 1 it ran and a check failed; 2 input refused; 3 a fault of ours;
130 interrupted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

EXIT_GOOD = 0
EXIT_CHECK_FAILED = 1
EXIT_INPUT_REFUSED = 2
EXIT_FAULT = 3
EXIT_INTERRUPTED = 130


@dataclass(frozen=True)
class Location:
    """Where in the user's files something stands; lines and columns count from 1."""

    file: str
    line: int | None = None
    column: int | None = None
    path: str = ""

    def __str__(self) -> str:
        place = self.file
        if self.line is not None:
            place += f":{self.line}"
            if self.column is not None:
                place += f":{self.column}"
        return f"{place}: {self.path}" if self.path else place


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: where, what, and what to do about it."""

    what: str
    where: Location | None = None
    hint: str = ""

    def __str__(self) -> str:
        text = f"{self.where}: {self.what}" if self.where else self.what
        return f"{text}\n    {self.hint}" if self.hint else text


class InspectError(Exception):
    """The root of every error that is meant for the user's eyes."""

    exit_code = EXIT_FAULT

    def __init__(self, problems: str | Problem | Sequence[Problem], *, hint: str = "") -> None:
        if isinstance(problems, str):
            problems = Problem(problems, hint=hint)
        if isinstance(problems, Problem):
            problems = [problems]
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[InspectError], tuple[tuple[Problem, ...]]]:
        # The regression hands errors between processes; the default would lose the problems.
        return type(self), (self.problems,)


class InputError(InspectError):
    """The input was refused; nothing was written."""

    exit_code = EXIT_INPUT_REFUSED


class SchemaError(InputError):
    """A mission, platform or campaign file breaks the schema."""


class GeometryError(InputError):
    """A cloud or mesh cannot be read, cropped or fitted."""


class InfeasibleError(InputError):
    """The plan cannot be flown as asked; one problem per point."""


class LogError(InputError):
    """A file is not a log of ours, or its bytes are damaged."""


class EnvironmentFault(InspectError):
    """This installation cannot do what was asked of it."""
