"""A stiff crawler: a pitching crawler with a table of modes of its own."""

from __future__ import annotations

from dataclasses import replace

from pitching_crawler.modes import FAR_OFF, MODES, behaviour_of, go, rested
from pitching_crawler.vehicle import PitchingCrawler

from inspect_cli.autonomy.modes import Mode, by_name
from inspect_cli.schema.modes import Phase

GOING = {"takeoff": "rising", "transit": "cruising", "land": "sinking"}
KEPT = ("standing", "nearing", "leaning", "crawling", "leaving", "sinking", "resting", "giving_up")
"""What it has in common with the other: all of ``lean``, nothing of ``prop``."""
STIFF_MODES = by_name(
    *(replace(MODES[name], number=20 + k) for k, name in enumerate(KEPT)),
    Mode("rising", 40, Phase.NEAR_GROUND, rested, go),
    Mode("cruising", 41, Phase.FREE, rested, go),
)
LOST = replace(FAR_OFF, modes=frozenset(STIFF_MODES) - {"standing", "resting", "giving_up"})


class StiffCrawler(PitchingCrawler):
    """One vehicle."""

    behaviour = behaviour_of(STIFF_MODES, (LOST,), GOING)
