"""Points by their labels, as many as a reader takes in."""

from __future__ import annotations

import re
from collections.abc import Sequence

from inspect_cli.reporting.words.text import NOTHING, Listed, Text, count

ALL_NAMED = 12
"""Up to so many, all are named."""
NAMED = 10
"""Of more, so many."""
SORTED = 1000
"""Of more than so many, ten at the beginning are examples; they stand as they were read."""


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
    """What sorts a label by its numbers, however long, rather than by their first digits."""
    parts = re.split(r"([0-9]+)", label)
    digits = [part.lstrip("0") for part in parts]
    return [(len(digits[k]), digits[k]) if k % 2 else (-1, parts[k]) for k in range(len(parts))]
