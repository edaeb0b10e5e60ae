"""Words that several chapters share: small numbers, millimetres, whether contact was kept."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from inspect_cli.metrics.flight import NotMeasured
from inspect_cli.reporting.content.blocks import Block, Box, Paragraph
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Amount, Text, count, number, say, significant
from inspect_cli.schema.result import Result

SMALL_NUMBERS = {
    2: (say("Two"), say("two")),
    3: (say("Three"), say("three")),
    4: (say("Four"), say("four")),
    5: (say("Five"), say("five")),
    6: (say("Six"), say("six")),
    7: (say("Seven"), say("seven")),
    8: (say("Eight"), say("eight")),
    9: (say("Nine"), say("nine")),
}
"""As a sentence begins with them, and as they stand within it; one has a sentence of its own."""

NOT_FLOWN = Paragraph(say("There is nothing to draw: the flight never got there."))


def amount_in_words(n: int, place: int = 0) -> Text:
    """A small number in words; at the beginning of a sentence, or (1) within it."""
    return SMALL_NUMBERS[n][place] if n in SMALL_NUMBERS else number(n, 0)


def millimetres(result: Result, metric: str) -> Amount | None:
    """The metric in mm; None where it was not measured."""
    value = result.value(metric)
    return None if value is None else number(1e3 * value, 1 if 1e3 * value < 9.95 else 0)


def contact_kept(result: Result, metric: str) -> Iterator[Text]:
    """Whether contact was kept."""
    gaps = result.value(metric)
    if gaps == 0.0:
        yield say("Contact was kept from touch to release.")
    elif gaps == 2.0:
        yield say("Contact was lost twice for more than 50 ms.")
    elif gaps is not None:
        yield count(
            int(gaps),
            "Contact was lost once for more than 50 ms.",
            "Contact was lost {n} times for more than 50 ms.",
        )


def metric_box(
    result: Result, name: Text, metric: str, unit: str, scale: float = 1.0, digits: int = 3
) -> list[Box]:
    """The metric times ``scale`` as a key figure; none where it was not measured."""
    value = result.value(metric)
    return [] if value is None else [Box(name, significant(scale * value, digits), unit)]


def drawn_or_reason(build: Callable[[], Iterable[Block]]) -> list[Block]:
    """What is shown, or why there is nothing to see."""
    try:
        # The states of a diverged flight overflow; what is not finite leaves gaps.
        with np.errstate(all="ignore"):
            shown = list(build())
    except NotMeasured as reason:
        why = recorded(str(reason))
        return [Paragraph(say("There is nothing to draw: {reason}.", reason=why))]
    return shown or [NOT_FLOWN]
