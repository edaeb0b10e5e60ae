"""How the readings of a flight were taken: instrument, rule of validity, force, cable."""

from __future__ import annotations

from collections.abc import Iterable

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.content.blocks import Facts
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.words.text import (
    NOTHING,
    Listed,
    Text,
    number,
    say,
    significant,
    together,
)
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.vehicle import HalfCellModel


def reading_method(log: RunLog, plan: Plan, points: Iterable[ReadPoint]) -> Facts:
    """How the readings at these points were taken, in the order of an inspection report."""
    probe = log.platform().sensor(HalfCellModel)
    pressed = [p.target for p in points if p.target is not None]
    force = number(max((t.expected_force_n for t in pressed), default=None), 2)
    counts = say(
        "the load cell shows ≥ {force} N for ≥ {time} s and the potential stays within {band} mV "
        "over {stable} s",
        force=significant(probe.min_force_n, 6),
        time=significant(probe.min_contact_s, 6),
        band=significant(1e3 * probe.stable_v, 6),
        stable=significant(probe.stable_s, 6),
    )
    return Facts(
        [
            (
                say("Method"),
                say("half-cell potential (ASTM C876) and resistance at each point of contact"),
            ),
            (say("Reference electrode"), say("copper/copper sulphate (CSE)")),
            (say("A reading counts when"), counts),
            (
                say("Cell constant"),
                say(
                    "{constant} m (resistivity = resistance × constant)",
                    constant=significant(probe.cell_constant_m, 6),
                ),
            ),
            (say("Set-point behind the surface"), _each([t.press_m for t in pressed], "m")),
            (say("Dwell"), _each([t.dwell_s for t in pressed], "s")),
            (say("Expected contact force"), together(force, " N") if pressed else NOTHING),
            (
                say("Cable"),
                say(
                    "{length} m; the farthest point needs {needed} m",
                    length=significant(probe.cable_m, 6),
                    needed=number(plan.cable_m, 2),
                ),
            ),
        ]
    )


def _each(values: Iterable[float], unit: str) -> Text:
    different = tuple(significant(value, 6) for value in sorted(set(values)))
    return together(Listed(different), f" {unit}") if different else NOTHING
