"""YAML 1.2 read strictly: plain data, every value with the place in the file where it stands.

The scalars are those of the YAML 1.2 core schema (https://yaml.org/spec/1.2.2, section 10.3.2):
``1e3`` is a number, ``on`` and ``no`` are text. Refused are duplicate keys, merge keys, tags,
keys that are not text, several documents, bytes that are not UTF-8, and files that are large,
deep or grow by aliases.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import yaml

from inspect_cli.errors import Location, Problem, SchemaError
from inspect_cli.schema.campaign import advice_for_absent
from inspect_cli.schema.nodes import Node, Scalar, Step, join

MAX_BYTES = 1_000_000
MAX_NODES = 10_000
"""After the expansion of aliases, each of which counts with everything below it."""
MAX_DEPTH = 30
MAX_DIGITS = 100


def read_yaml(path: Path) -> Node:
    """Read a file; the root is a mapping.

    Raises:
        SchemaError: it is not there, not readable or not YAML as described above; every
            problem carries its file:line:column.
    """
    file = str(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError as error:
        hint = advice_for_absent(path)
        raise SchemaError(Problem("there is no such file", Location(file), hint)) from error
    except OSError as error:
        reason = error.strerror or str(error)
        raise SchemaError(Problem(f"cannot be read: {reason}", Location(file))) from error
    except ValueError as error:
        raise SchemaError(Problem(f"is no file name: {error}", Location(repr(file)))) from error
    return parse_yaml(data, file)


def parse_yaml(data: bytes, file: str) -> Node:
    """Parse the bytes of ``file`` as ``read_yaml`` does."""
    if len(data) > MAX_BYTES:
        raise SchemaError(Problem(f"larger than {MAX_BYTES} bytes", Location(file)))
    root = _compose(_decode(data, file), file)
    if root is None:
        raise SchemaError(Problem("the file is empty", Location(file, 1, 1)))
    if not isinstance(root, yaml.MappingNode):
        where = _location(file, root.start_mark)
        raise SchemaError(Problem("the file must be a mapping of keys to values", where))
    reader = _Reader(file)
    node = reader.read(root, ())
    if reader.problems:
        raise SchemaError(reader.problems)
    return node


def _decode(data: bytes, file: str) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8")
        raise SchemaError(
            Problem(
                f"byte {data[error.start]:#04x} is not UTF-8",
                _location_of(before, file),
                hint="save the file as UTF-8",
            )
        ) from error


def _location_of(before: str, file: str) -> Location:
    return Location(file, before.count("\n") + 1, len(before) - before.rfind("\n"))


def _location(file: str, mark: yaml.Mark) -> Location:
    return Location(file, mark.line + 1, mark.column + 1)


class _Composer(yaml.SafeLoader):
    """PyYAML's composer, which says of an untagged node only whether it is quoted.

    The scanner in Python is used on purpose: it is asked for one event at a time, so that
    depth and size are refused before they are built.
    """

    def __init__(self, text: str, file: str) -> None:
        super().__init__(text)
        self.file = file
        self.depth = 0
        self.count = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        self.count += 1
        self.depth += 1
        if self.depth > MAX_DEPTH or self.count > 2 * MAX_NODES:  # a key is a node here, too
            too = f"deeper than {MAX_DEPTH} levels" if self.depth > MAX_DEPTH else "too long"
            raise SchemaError(Problem(f"the file is {too}", self._place()))
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def _place(self) -> Location:
        # The stubs leave this method untyped.
        event: yaml.Event = self.peek_event()  # type: ignore[no-untyped-call]
        mark = event.start_mark or self.get_mark()
        return Location(self.file, mark.line + 1, mark.column + 1)

    def resolve(self, kind: type[yaml.Node], value: str | None, implicit: object) -> str:
        if kind is not yaml.ScalarNode:
            return "untagged"
        return "plain" if isinstance(implicit, tuple) and implicit[0] else "quoted"


def _compose(text: str, file: str) -> yaml.Node | None:
    loader: _Composer | None = None
    try:
        loader = _Composer(text, file)
        node: yaml.Node | None = loader.get_single_node()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        what = error.problem or error.context or "this is not YAML"
        raise SchemaError(
            Problem(what, _location(file, mark) if mark else Location(file), _advice(what))
        ) from error
    except yaml.reader.ReaderError as error:
        where = _location_of(text[: error.position], file)
        code = f"U+{error.character:04X}"
        raise SchemaError(Problem(f"the character {code} is refused", where)) from error
    except (ValueError, OverflowError) as error:  # an escape that names no character
        where = _location(file, loader.get_mark()) if loader else Location(file)
        raise SchemaError(Problem("this is not YAML", where, str(error))) from error
    return node


def _advice(what: str) -> str:
    if "\\t" in what:
        return "indent with spaces, not tabs"
    if "another document" in what:
        return "one file holds one document; remove the line ---"
    if "mapping values are not allowed" in what:
        return "quote a text that has a colon in it; check the indentation"
    return ""


class _Reader:
    """Turns composed nodes into ``Node``s and collects what is wrong on the way."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.problems: list[Problem] = []
        self.count = 0
        self.above: set[int] = set()

    def read(self, node: yaml.Node, path: tuple[Step, ...], key: Location | None = None) -> Node:
        self.count += 1
        self._check_size(node, path)
        if node.tag not in ("untagged", "plain", "quoted"):
            self._refuse(node.start_mark, path, f"the tag {_tag_name(node.tag)}", "remove it")
        self.above.add(id(node))
        value: Scalar | tuple[Node, ...] | dict[str, Node]
        if isinstance(node, yaml.MappingNode):
            value = self._mapping(node, path)
        elif isinstance(node, yaml.ScalarNode):
            value = self._scalar(node, path)
        else:
            value = tuple(self.read(item, (*path, i)) for i, item in enumerate(node.value))
        self.above.discard(id(node))
        mark = node.start_mark
        return Node(value, self.file, mark.line + 1, mark.column + 1, key)

    def _check_size(self, node: yaml.Node, path: tuple[Step, ...]) -> None:
        what = ""
        if id(node) in self.above:
            what = "an alias refers to what it stands in"
        elif self.count > MAX_NODES:
            what = f"more than {MAX_NODES} values, with those that aliases repeat"
        elif len(path) > MAX_DEPTH:
            what = f"deeper than {MAX_DEPTH} levels"
        if what:
            where = _location(self.file, node.start_mark)
            raise SchemaError(Problem(what, where, hint="write the values out, without aliases"))

    def _mapping(self, node: yaml.MappingNode, path: tuple[Step, ...]) -> dict[str, Node]:
        entries: dict[str, Node] = {}
        for key_node, value_node in node.value:
            key = self._key(key_node, path)
            if key is None:
                continue
            place = _location(self.file, key_node.start_mark)
            if key in entries:
                first = entries[key].key
                line = first.line if first else "?"
                what = f"the key '{key}' a second time (first in line {line})"
                self._refuse(key_node.start_mark, (*path, key), what, "keep one of the two")
                continue
            entries[key] = self.read(value_node, (*path, key), place)
        return entries

    def _key(self, node: yaml.Node, path: tuple[Step, ...]) -> str | None:
        if not isinstance(node, yaml.ScalarNode):
            self._refuse(node.start_mark, path, "a key that is not text", "")
            return None
        if node.tag == "plain" and node.value == "<<":
            self._refuse(node.start_mark, path, "the merge key '<<'", "write the entries out")
            return None
        key = self._scalar(node, path)
        if not isinstance(key, str):
            hint = f'if it is meant as text, quote it: "{node.value}"'
            self._refuse(node.start_mark, path, f"a key that is not text: {node.value!r}", hint)
            return None
        return key

    def _scalar(self, node: yaml.ScalarNode, path: tuple[Step, ...]) -> Scalar:
        text: str = node.value
        if not _encodable(text):
            self._refuse(node.start_mark, path, "half of a surrogate pair", "")
            return None
        if node.tag != "plain":
            return text
        value = core_scalar(text)
        if isinstance(value, int) and len(text) > MAX_DIGITS:
            self._refuse(node.start_mark, path, f"a number of {len(text)} digits", "")
        return value

    def _refuse(self, mark: yaml.Mark, path: tuple[Step, ...], what: str, hint: str) -> None:
        place = _location(self.file, mark)
        self.problems.append(Problem(f"{what} is refused", replace(place, path=join(path)), hint))


def _tag_name(tag: str) -> str:
    return tag.replace("tag:yaml.org,2002:", "!!")


def _encodable(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


_NULL = frozenset({"", "~", "null", "Null", "NULL"})
_TRUE = frozenset({"true", "True", "TRUE"})
_FALSE = frozenset({"false", "False", "FALSE"})
_INT = re.compile(r"[-+]?[0-9]+")
_BASED_INT = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INFINITY = re.compile(r"[-+]?\.(inf|Inf|INF)")
_NAN = frozenset({".nan", ".NaN", ".NAN"})


def core_scalar(text: str) -> Scalar:
    """What an unquoted scalar means by the YAML 1.2 core schema."""
    if text in _NULL:
        return None
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INT.fullmatch(text):
        # Python refuses to convert thousands of digits; the reader refuses far fewer.
        return int(text[: MAX_DIGITS + 1])
    if _BASED_INT.fullmatch(text):
        return int(text[2:], 8 if text[1] == "o" else 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _INFINITY.fullmatch(text):
        return float("-inf") if text.startswith("-") else float("inf")
    if text in _NAN:
        return float("nan")
    return text
