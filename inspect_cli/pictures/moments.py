"""Which moment of a flight the still picture shows."""

from __future__ import annotations

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Reference
from inspect_cli.scene.motion import Motion
from inspect_cli.schema.modes import ModeTable, Phase
from inspect_cli.spatial.arrays import Structured


def still_moment(log: RunLog, motion: Motion) -> tuple[float, bool]:
    """(t, s; whether the tool touches then).

    It is within the contact at two thirds of all contacts; without any, halfway through the flight.
    """
    touching = _stretches(log.rows(Reference), log.modes(), motion)
    if not touching:
        return float(0.5 * (motion.t_s[0] + motion.t_s[-1])), False
    begin, end = touching[(2 * len(touching)) // 3 if len(touching) > 1 else 0]
    return begin + 0.7 * (end - begin), True


def _stretches(
    rows: Structured | None, modes: ModeTable, motion: Motion
) -> list[tuple[float, float]]:
    """(begin, end), s, of each press with the stroke that follows it."""
    if rows is None:
        return []
    rows = rows[rows["t_s"] <= motion.t_s[-1]]
    inside = modes.within(rows["mode"], {Phase.CONTACT}).astype(np.int8)
    edges = np.diff(inside, prepend=0, append=0)
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    t_s = rows["t_s"]
    return [(float(t_s[a]), float(t_s[b])) for a, b in zip(begins, ends, strict=True)]
