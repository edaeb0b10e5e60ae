"""Points by their labels, as many as a reader takes in."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.text import NOTHING, Listed, Text, count

ALL_NAMED = 12
"""Up to so many, all are named."""
NAMED = 10
"""Of more, so many."""


def named(labels: Sequence[str]) -> Text:
    """The labels as an enumeration; of many the first, and how many more there are."""
    if not labels:
        return NOTHING
    if len(labels) <= ALL_NAMED:
        return Listed(tuple(labels))
    more = count(len(labels) - NAMED, "{n} more", "{n} more")
    return Listed((*labels[:NAMED], more))
