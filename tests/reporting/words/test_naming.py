"""Labels of points as a reader expects them."""

from __future__ import annotations

import pytest

from inspect_cli.reporting.words.language import language
from inspect_cli.reporting.words.naming import named

ENGLISH = language("en")


@pytest.mark.parametrize(
    ("labels", "told"),
    [
        ([], "–"),
        (["3"], "3"),
        (["10", "9", "1"], "1, 9 and 10"),
        (["10/B", "2/D", "2/B"], "2/B, 2/D and 10/B"),
        (["P10", "P9", "7", "Q"], "7, P9, P10 and Q"),
        (["9" * 5000, "007"], f"007 and {'9' * 5000}"),
        ([str(n) for n in range(13, 0, -1)], "1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 3 more"),
    ],
)
def test_labels_stand_in_the_order_of_their_numbers(labels: list[str], told: str) -> None:
    assert ENGLISH.plain(named(labels)) == told
