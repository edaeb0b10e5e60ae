"""The half-cell: its samples and its readings."""

from __future__ import annotations

from inspect_cli.records.reading import PointReading
from inspect_cli.records.record import Record, scalar


class Probe(Record):
    """One raw sample of the half-cell probe and its load cell."""

    topic = "/sensor/probe"

    potential = scalar("V", "potential of the reinforcement against the probe's electrode")
    resistance = scalar("Ω", "resistance between probe and reinforcement")
    force = scalar("N", "force on the probe by its load cell, pressing is positive")


class Reading(PointReading):
    """The half-cell's verdict on one point."""

    topic = "/reading"

    potential = scalar("V", "accepted potential; NaN when invalid")
    resistance = scalar("Ω", "accepted resistance; NaN when invalid")
