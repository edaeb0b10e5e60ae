"""Short missions in a temporary campaign, and what is left of their flights."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from modes import Mode

from inspect_cli.commands.fly import FlyOutcome, fly
from inspect_cli.log.reader import RunLog, read_log

Array = np.ndarray

ONE_POINT = """
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.05}
    sensor: half_cell
"""
TWO_POINTS = """
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 2, pitch_m: 0.05}
    sensor: half_cell
"""


@dataclass(frozen=True)
class Scenario:
    """The nine-point mission with entries of its own; two points unless ``tasks`` says more."""

    name: str
    truth: str = ""
    tasks: str = TWO_POINTS
    seed: int = 1

    def write(self, campaign: Path) -> Path:
        """The mission's file."""
        path = campaign / "missions" / f"{self.name}.yaml"
        text = f"schema: 1\nextends: nine_point_half_cell.yaml\nname: {self.name}\nacceptance: []\n"
        text += self.tasks
        if self.truth:
            text += "truth:\n" + textwrap.indent(textwrap.dedent(self.truth), "  ")
        path.write_text(text)
        return path

    def fly(self, campaign: Path, folder: str = "") -> Flown:
        """Fly it."""
        out = campaign / "reports" / (folder or f"{self.name}-{self.seed}")
        outcome = fly(self.write(campaign), seed=self.seed, out=out)
        return Flown(outcome, read_log(outcome.folder / "flight.mcap"))


@dataclass(frozen=True)
class Flown:
    """A flight's result and log."""

    outcome: FlyOutcome
    log: RunLog

    @property
    def state(self) -> Array:
        return self.log.channels["/truth/state"]

    @property
    def mode(self) -> Array:
        """The mode of the executive in every row."""
        return self.log.channels["/reference"]["mode"]

    @property
    def reasons(self) -> list[str]:
        """Why each point is invalid; empty for a valid one."""
        return [point.reason for point in self.outcome.result.points]

    def during(self, mode: Mode) -> Array:
        """The true states of a mode."""
        return self.state[self.mode == float(mode)]

    def abort_s(self) -> float:
        """When the executive gave up."""
        (event,) = [event for event in self.log.events if event.text.startswith("aborted")]
        return event.t_s
