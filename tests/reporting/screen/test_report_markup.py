"""Text stays text, numbers read well."""

from __future__ import annotations

import json

import numpy as np
import pytest
from report_pages import decoded

from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.documents.checks_table import bounds
from inspect_cli.reporting.figures.figure import merged, numbers
from inspect_cli.reporting.screen.html import blocks
from inspect_cli.reporting.screen.markup import Markup, data_script, element, joined
from inspect_cli.reporting.words.language import language
from inspect_cli.reporting.words.text import number, significant


def test_elements_escape_text_and_attributes() -> None:
    assert element("td", "<b>&") == "<td>&lt;b&gt;&amp;</td>"
    assert element("p", element("b", "x"), "<") == "<p><b>x</b>&lt;</p>"
    assert element("a", "x", class_='"><script>', aria_label="y").startswith(
        '<a class="&quot;&gt;&lt;script&gt;" aria-label="y">'
    )
    assert joined("<", Markup("<br>")) == "&lt;<br>"


def test_data_cannot_leave_its_script() -> None:
    value = {"text": "</script><!-- <script> & \u2028 °"}
    html = data_script(value, id="x")
    inside = html[html.index(">") + 1 : html.rindex("</script>")]
    assert "<" not in inside
    assert json.loads(inside) == value
    with pytest.raises(ValueError, match="JSON"):
        data_script([float("nan")])


def test_columns_of_numbers_survive_anything() -> None:
    values = np.array([0.0, -1.5, np.nan, np.inf, 1e200, 3.25])
    read = decoded(numbers(values))
    assert read == pytest.approx([0.0, -1.5, np.nan, np.nan, np.nan, 3.25], nan_ok=True)


def test_numbers_for_readers() -> None:
    plain = language("en").plain
    assert plain(number(-410.126, 0)) == "−410"
    assert plain(number(2750.0, 0)) == "2\u202f750"
    assert plain(number(None, 2)) == "–"
    assert plain(significant(-0.0042271)) == "−0.004227"
    assert plain(bounds(1.44, 2.16)) == "1.44 … 2.16"
    assert plain(bounds(None, 20.0)) == "≤ 20"
    assert plain(bounds(9.0, None)) == "≥ 9"
    assert plain(bounds(6.0, 6.0)) == "= 6"


def test_tables_are_labelled() -> None:
    columns = [Column("Name"), Column("u", "m", numeric=True)]
    html = blocks([Table("A <caption>", columns, [["a", "1"]])], language("en"))
    assert "<caption>A &lt;caption&gt;</caption>" in html
    assert 'aria-label="A &lt;caption&gt;"' in html
    assert '<th scope="row">a</th><td class="number">1</td>' in html


def test_merged_is_deep_and_leaves_its_arguments() -> None:
    base = {"a": {"b": 1, "c": 2}, "d": 3}
    assert merged(base, {"a": {"c": 9}, "e": 4}) == {"a": {"b": 1, "c": 9}, "d": 3, "e": 4}
    assert base == {"a": {"b": 1, "c": 2}, "d": 3}
