"""The modes of a pitching crawler, none of which a tilt-rotor vehicle has."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CrawlerMode:
    """One row: what is held by position and what by force.

    ``presses`` names the frame that is pressed on a surface. Along that frame's axis z the
    position is then free, but for damping, and the stated force is fed forward.
    """

    name: str
    number: int
    phase: str
    flies: bool = True
    presses: str | None = None
    rolls: bool = False


ROWS = (
    CrawlerMode("standing", 0, "ground", flies=False),
    CrawlerMode("climbing_out", 1, "near_ground"),
    CrawlerMode("hovering", 2, "free"),
    CrawlerMode("nearing", 3, "near"),
    CrawlerMode("leaning", 4, "touching", presses="tool"),
    CrawlerMode("crawling", 5, "touching", presses="tool", rolls=True),
    CrawlerMode("propping", 6, "touching", presses="foot"),
)
MODES = {row.name: row for row in ROWS}
