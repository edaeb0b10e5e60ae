"""Tables of modes and failsafes that do not fit together are refused when they are built."""

from __future__ import annotations

from dataclasses import replace

import pytest

from inspect_cli.autonomy.modes import by_name
from inspect_cli.errors import InputError
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR

PRESS, ROW = BEHAVIOUR.modes["press"], BEHAVIOUR.failsafes[0]


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"modes": by_name(PRESS, replace(PRESS, name="push"))}, "same number"),
        ({"first": "nope"}, "no mode 'nope'"),
        ({"failsafes": (replace(ROW, modes=frozenset({"flyinng"})),)}, "no mode 'flyinng'"),
        ({"failsafes": (replace(ROW, fallbacks=()),)}, "no fallback"),
    ],
)
def test_tables_that_do_not_fit_are_refused(wrong: dict[str, object], word: str) -> None:
    """A failsafe that watches no mode would never be heard of."""
    with pytest.raises(InputError, match=word):
        replace(BEHAVIOUR, **wrong)
