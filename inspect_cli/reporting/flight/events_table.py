"""The table of the events that the vehicle reported during the flight."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.log.foxglove import Event
from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.content.blocks import Block, Column, Folded, Table
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, number, say

QUIET_LEVELS = ("debug", "info")
MANY_EVENTS = 12
MOST_EVENTS = 1000


def events_table(log: RunLog) -> list[Block]:
    """The events of the flight; of a long list only the warnings are unfolded."""
    if not log.events:
        return []
    if len(log.events) <= MANY_EVENTS:
        return [_events(say("Events."), log.events)]
    warnings = [event for event in log.events if event.level not in QUIET_LEVELS]
    everything = _events(say("Events."), log.events[:MOST_EVENTS])
    folded = Folded(say("All {n} events", n=number(len(log.events), 0)), [everything])
    if not warnings:
        return [folded]
    return [_events(say("Warnings."), warnings[:MOST_EVENTS]), folded]


def _events(caption: Text, events: Sequence[Event]) -> Table:
    rows = [[number(event.t_s, 2), recorded(event.level), event.text] for event in events]
    columns = [
        Column(say("Time"), "s", numeric=True),
        Column(say("Level")),
        Column(say("Event"), prose=True),
    ]
    return Table(caption, columns, rows)
