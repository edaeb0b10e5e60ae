"""The YAML reader: scalars of the 1.2 core schema, and everything that it refuses."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from inspect_cli.errors import SchemaError
from inspect_cli.schema.nodes import merged
from inspect_cli.schema.strict_yaml import MAX_BYTES, core_scalar, parse_yaml, read_yaml


def refusal(text: str | bytes) -> str:
    data = text.encode() if isinstance(text, str) else text
    with pytest.raises(SchemaError) as caught:
        parse_yaml(data, "f.yaml")
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        # the examples of the YAML 1.2.2 specification, chapter 10.3
        *[(word, None) for word in ("null", "Null", "NULL", "~", "")],
        *[(word, True) for word in ("true", "True", "TRUE")],
        *[(word, False) for word in ("false", "False", "FALSE")],
        ("0", 0),
        ("-19", -19),
        ("0o7", 7),
        ("0x3A", 58),
        ("0.", 0.0),
        ("-0.0", -0.0),
        (".5", 0.5),
        ("+12e03", 12000.0),
        ("-2E+05", -200000.0),
        ("1e3", 1000.0),
        (".inf", math.inf),
        ("-.Inf", -math.inf),
        ("+.INF", math.inf),
        # what YAML 1.1 reads as something else
        ("on", "on"),
        ("No", "No"),
        ("010", 10),
        ("1_000", "1_000"),
        ("12:30:45", "12:30:45"),
        ("2024-01-01", "2024-01-01"),
        ("0b1", "0b1"),
        ("=", "="),
    ],
)
def test_core_scalars(text: str, value: object) -> None:
    read = core_scalar(text)
    assert read == value
    assert type(read) is type(value)


def test_not_a_number_is_read_as_such() -> None:
    assert all(math.isnan(float(str(core_scalar(text)))) for text in (".nan", ".NaN", ".NAN"))


def test_quoted_scalars_are_text() -> None:
    node = parse_yaml(b"a: '1'\nb: \"true\"\nc: |\n  2\nd: null\n", "f.yaml")
    assert node.plain == {"a": "1", "b": "true", "c": "2\n", "d": None}


def test_places_count_from_one_and_after_a_byte_order_mark() -> None:
    node = parse_yaml("\ufeffä: {b: [1, ü]}\n".encode(), "f.yaml")
    inner = node.child("ä")
    assert inner is not None
    items = inner.child("b")
    assert items is not None
    last = items.child(1)
    assert last is not None
    assert (inner.key and (inner.key.line, inner.key.column)) == (1, 1)
    assert (items.line, items.column, last.line, last.column) == (1, 8, 1, 12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: 1\nb: 2\na: 3\n", "f.yaml:3:1: a: the key 'a' a second time (first in line 1)"),
        ("a: {b: 1, b: 2}", "f.yaml:1:11: a.b: the key 'b' a second time"),
        ("x: &b {c: 1}\na:\n  <<: *b\n", "f.yaml:3:3: a: the merge key '<<' is refused"),
        ("a: !!python/object:os.system ls", "f.yaml:1:4: a: the tag !!python/object:os.system"),
        ("a: !!int '3'", "f.yaml:1:4: a: the tag !!int is refused"),
        ("a: !mine {b: 1}", "f.yaml:1:4: a: the tag !mine is refused"),
        ("1: a", "f.yaml:1:1: a key that is not text: '1' is refused"),
        ("? [a]\n: b", "f.yaml:1:3: a key that is not text is refused"),
        ("a: 1\n---\nb: 2\n", "f.yaml:2:1: but found another document"),
        ("a: &x [1, *x]", "f.yaml:1:4: an alias refers to what it stands in"),
        ("a: *x", "f.yaml:1:4: found undefined alias 'x'"),
        ("a:\n\tb: 1", "f.yaml:2:1: found character '\\t' that cannot start any token"),
        ("a: b: c", "f.yaml:1:5: mapping values are not allowed here"),
        ("a: [1, 2\nb: 3", "f.yaml:2:2: expected ',' or ']'"),
        ("", "f.yaml:1:1: the file is empty"),
        ("# only a comment\n", "f.yaml:1:1: the file is empty"),
        ("- a\n- b\n", "f.yaml:1:1: the file must be a mapping"),
        ("a: " + "9" * 5000, "f.yaml:1:4: a: a number of 5000 digits is refused"),
        (b"a: 1\nb: \xff", "f.yaml:2:4: byte 0xff is not UTF-8"),
        ("a: 1\nb: \x07", "f.yaml:2:4: the character U+0007 is refused"),
        ('a: "\\uD800"', "f.yaml:1:4: a: half of a surrogate pair is refused"),
        ('a: "\\UFFFFFFFF"', "f.yaml:1:7: this is not YAML"),
        ("a: " + "[" * 10_000, "f.yaml:1:33: the file is deeper than 30 levels"),
        ("a:\n" + "- 1\n" * 30_000, "the file is too long"),
        ("#" * (MAX_BYTES + 1), f"f.yaml: larger than {MAX_BYTES} bytes"),
    ],
)
def test_refusals_name_the_place(text: str | bytes, message: str) -> None:
    assert message in refusal(text)


def test_all_refusals_of_a_file_are_reported_together() -> None:
    text = "a: !x 1\nb: 1\nb: 2\n3: 4\n"
    assert [line.split(" ")[0] for line in refusal(text).splitlines() if "f.yaml" in line] == [
        "f.yaml:1:4:",
        "f.yaml:3:1:",
        "f.yaml:4:1:",
    ]


def test_an_alias_bomb_is_refused_before_it_expands() -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 20)]
    assert "more than 10000 values, with those that aliases repeat" in refusal("\n".join(lines))


def test_an_alias_repeats_its_value_with_the_place_of_the_anchor() -> None:
    node = parse_yaml(b"a: &x [1, 2]\nb: *x\n", "f.yaml")
    assert node.plain == {"a": (1, 2), "b": (1, 2)}
    assert [child.line for _, child in node.children()] == [1, 1]


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    for name in ("nine_point_half_cell.yaml", "soffit.yaml", "nine_point_half_cell.ply"):
        (tmp_path / name).write_text("")
    for name, hint in (
        ("nine_point_halfcell.yaml", f"did you mean {tmp_path}/nine_point_half_cell.yaml?"),
        ("qqqq.yaml", f"nothing in {tmp_path} has a name like it"),
        ("qqqq/soffit.yaml", f"there is no folder {tmp_path}/qqqq"),
    ):
        with pytest.raises(SchemaError) as caught:
            read_yaml(tmp_path / name)
        assert str(caught.value) == f"{tmp_path}/{name}: there is no such file\n    {hint}"
    with pytest.raises(SchemaError, match="cannot be read: Is a directory"):
        read_yaml(tmp_path)


def test_merging_replaces_values_merges_mappings_and_removes_with_null() -> None:
    base = parse_yaml(b"a: 1\nb: {c: 2, d: [1, 2], e: 3}\nf: 4\n", "base.yaml")
    over = parse_yaml(b"b: {d: [3], e: ~, g: ~}\nf: ~\nh: 5\n", "over.yaml")
    both = merged(base, over)
    assert both.plain == {"a": 1, "b": {"c": 2, "d": (3,), "g": None}, "h": 5}
    files = {key: child.file for key, child in both.children()}
    assert files == {"a": "base.yaml", "b": "over.yaml", "h": "over.yaml"}


yaml_like = st.text(
    alphabet=st.sampled_from(
        list("ab01 \n\t:-?[]{},&*#!|>'\"%@`~.<=\\xuUéeE+_\ufeff\x00\x85\u2028")
    ),
    max_size=60,
)


@settings(deadline=None)
@given(st.one_of(yaml_like, st.text(max_size=40)))
def test_any_text_is_read_or_refused(text: str) -> None:
    _read_or_refuse(text.encode("utf-8", "surrogatepass"))


@settings(deadline=None)
@given(st.binary(max_size=60))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    _read_or_refuse(data)


def _read_or_refuse(data: bytes) -> None:
    try:
        parse_yaml(data, "f.yaml")
    except SchemaError as error:
        for problem in error.problems:
            where = problem.where
            assert where is not None
            assert where.line is not None
            assert where.column is not None
            assert where.line >= 1
            assert where.column >= 1
