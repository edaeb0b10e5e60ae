"""Enumerations of point labels, shortened if there are many."""

from __future__ import annotations

import re
from collections.abc import Sequence

from inspect_cli.reporting.words.text import NOTHING, Listed, Text, count

ALL_NAMED = 12
"""All labels are shown up to this number."""
NAMED = 10
"""Labels shown if there are more than that."""
SORTED = 1000
"""Above this number the first ten labels are shown in the order of reading, unsorted."""


def named(labels: Sequence[str]) -> Text:
    """The labels as an enumeration, 2 before 10; of many the first, and how many more there are."""
    if not labels:
        return NOTHING
    if len(labels) <= SORTED:
        labels = sorted(labels, key=_counted)
    if len(labels) <= ALL_NAMED:
        return Listed(tuple(labels))
    more = count(len(labels) - NAMED, "{n} more", "{n} more")
    return Listed((*labels[:NAMED], more))


def _counted(label: str) -> list[tuple[int, str]]:
    """Sort key of a label: its digits compare as numbers."""
    parts = re.split(r"([0-9]+)", label)
    digits = [part.lstrip("0") for part in parts]
    return [(len(digits[k]), digits[k]) if k % 2 else (-1, parts[k]) for k in range(len(parts))]
