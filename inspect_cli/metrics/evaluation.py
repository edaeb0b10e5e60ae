"""What evaluating a flight or a survey gives: the result, and the arrays it was computed from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from inspect_cli.schema.result import Result

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed


@dataclass(frozen=True)
class Evaluation:
    """A result beside the assessed readings of each surface, which reports draw."""

    result: Result
    """The scalars, as ``metrics.json`` holds them."""
    assessed: tuple[Assessed, ...]
    """By surface: readings, merged readings, areas and uncertainties as arrays, so that a report
    need not assess them a second time."""
