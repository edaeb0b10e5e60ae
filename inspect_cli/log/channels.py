"""The table of a log's numeric channels, from the declarations of the records."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from inspect_cli.records import CORE_RECORDS, Record


class ChannelRow(NamedTuple):
    """One field of one channel, in words."""

    topic: str
    field: str
    shape: str
    """``scalar``, or its lengths; a name stands for a number that the platform decides."""
    unit: str
    frame: str
    meaning: str


def channel_table(records: Sequence[type[Record]] = CORE_RECORDS) -> list[ChannelRow]:
    """One row per field of every record, in order of declaration."""
    return [
        ChannelRow(
            topic=record.topic,
            field=field.name,
            shape=" × ".join(map(str, field.shape)) or "scalar",
            unit=field.unit,
            frame=field.frame,
            meaning=field.meaning,
        )
        for record in records
        for field in record.fields()
    ]


def channel_markdown(records: Sequence[type[Record]] = CORE_RECORDS) -> str:
    """The table as CONTRIBUTING shows it: one line per topic."""
    lines = ["| topic | fields (shape, unit, frame) |", "|---|---|"]
    for record in records:
        rows = [row for row in channel_table([record]) if row.field != "t_s"]
        lines.append(f"| `{record.topic}` | {'; '.join(map(_in_brief, rows))} |")
    return "\n".join(lines) + "\n"


def _in_brief(row: ChannelRow) -> str:
    shape = "" if row.shape == "scalar" else row.shape
    traits = ", ".join(trait for trait in (shape, row.unit, row.frame) if trait)
    return f"`{row.field}` ({traits})"
