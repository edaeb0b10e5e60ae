"""What pydantic found wrong, said at the place in the file and with what to do about it."""

from __future__ import annotations

import difflib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from inspect_cli.errors import Location, Problem
from inspect_cli.schema.nodes import Node, Step, join
from inspect_cli.schema.registry import one_of
from inspect_cli.schema.units import Unit, converted, parse_quantity, split_key


def problems_of(error: ValidationError, model: type[BaseModel], root: Node) -> list[Problem]:
    """One problem per error, at file:line:column with its YAML path.

    What one number of the file was made into, such as a pair, is wrong once.

    Args:
        error: what validating ``root.plain`` against ``model`` raised.
        model: the model of the whole file.
        root: the file.
    """
    details = [
        (dict(detail), _find(model, root, detail["loc"]))
        for detail in error.errors(include_url=False)
    ]
    meant = {
        (spot.path[:-1], key)
        for detail, spot in details
        if detail["type"] == "extra_forbidden"
        for key in _meant(spot)
    }
    problems = [
        _problem(detail, spot)
        for detail, spot in details
        if not _follows_from_another(detail, spot, meant)
    ]
    return list(dict.fromkeys(problems))


def suggest(found: str, choices: Sequence[str]) -> str:
    """The nearest choice, and all of them."""
    near = difflib.get_close_matches(found, choices, n=1)
    listed = f"choices: {', '.join(choices)}" if choices else "there is none to choose from"
    return f"did you mean '{near[0]}'? {listed}" if near else listed


def shown(value: object) -> str:
    """A value of a file as it is quoted in a message: short and printable."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return "a list"
    if isinstance(value, dict):
        return "a mapping"
    text = str(value)
    text = text if text.isprintable() else repr(text)
    return text if len(text) <= 60 else text[:57] + "..."


@dataclass(frozen=True)
class _Spot:
    """Where an error stands: the deepest node there is, its path, and what the schema wants."""

    node: Node
    path: tuple[Step, ...]
    kind: Any
    """The type that the schema asks for here, None if the key is unknown to it."""
    within: Any = None
    """The type of the mapping or sequence around it."""
    absent: Step | None = None
    """The key or index that is not in ``node``."""

    @property
    def key(self) -> str:
        """The innermost key of the path, whose unit numbers in a list share."""
        return next((step for step in reversed(self.path) if isinstance(step, str)), "")


def _find(model: type[BaseModel], root: Node, loc: Sequence[Step]) -> _Spot:
    spot = _Spot(root, (), model)
    for step in loc:
        kind, consumed = _descend(spot.kind, step)
        if not consumed:
            spot = _Spot(spot.node, spot.path, kind, spot.within)
            continue
        child = spot.node.child(step)
        if child is None:
            return _Spot(spot.node, spot.path, kind, spot.kind, absent=step)
        spot = _Spot(child, (*spot.path, step), kind, spot.kind)
    return spot


def _descend(kind: Any, step: Step) -> tuple[Any, bool]:
    """The type below ``kind``, and whether ``step`` is a step in the file or a union's tag."""
    union = one_of(kind)
    if union is not None:
        return (union.models[str(step)], False) if step in union.models else (None, True)
    kind = _bare(kind)
    if step == "[key]":
        return kind, False
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        field = _fields(kind).get(str(step))
        return (field.annotation if field else None), True
    arguments = get_args(kind)
    if get_origin(kind) in (Union, UnionType):
        return next((m for m in arguments if step in _tags(m)), None), False
    if get_origin(kind) is dict:
        return arguments[1], True
    if get_origin(kind) is tuple and isinstance(step, int):
        if len(arguments) == 2 and arguments[1] is Ellipsis:
            return arguments[0], True
        return (arguments[step] if step < len(arguments) else None), True
    return None, True


def _bare(kind: Any) -> Any:
    """``kind`` without Annotated and without an optional None."""
    if get_origin(kind) is Annotated:
        return _bare(get_args(kind)[0])
    if get_origin(kind) in (Union, UnionType):
        members = [m for m in get_args(kind) if m is not NoneType]
        if len(members) == 1:
            return _bare(members[0])
    return kind


def _fields(model: type[BaseModel]) -> dict[str, Any]:
    """The fields of a model by the key that they have in a file."""
    return {field.alias or name: field for name, field in model.model_fields.items()}


def _keys(kind: Any) -> list[str]:
    kind = _bare(kind)
    is_model = isinstance(kind, type) and issubclass(kind, BaseModel)
    return list(_fields(kind)) if is_model else []


def _tags(kind: Any) -> tuple[Any, ...]:
    """What tells a union's member from the others: the values of its literals."""
    kind = _bare(kind)
    if not (isinstance(kind, type) and issubclass(kind, BaseModel)):
        return ()
    literals = (_bare(f.annotation) for f in kind.model_fields.values())
    return tuple(v for kind in literals if get_origin(kind) is Literal for v in get_args(kind))


def _follows_from_another(
    detail: dict[str, Any], spot: _Spot, meant: set[tuple[tuple[Step, ...], str]]
) -> bool:
    """Whether this error only repeats one that is reported elsewhere."""
    if detail["type"] == "missing" and isinstance(spot.absent, str):
        return (spot.path, spot.absent) in meant
    # pydantic counts a sequence's valid items, whose errors are already reported.
    value = spot.node.value
    short = detail["type"] == "too_short" and isinstance(value, tuple)
    return short and isinstance(value, tuple) and len(value) >= detail["ctx"]["min_length"]


def _meant(spot: _Spot) -> list[str]:
    """The keys that an unknown key may stand for: those that differ in the unit, or nearly."""
    unknown, keys = str(spot.path[-1]), _keys(spot.within)
    stem, _ = split_key(unknown)
    same = [key for key in keys if split_key(key)[0] == stem]
    return same or difflib.get_close_matches(unknown, keys, n=1)


def _problem(detail: dict[str, Any], spot: _Spot) -> Problem:
    path = join(spot.path)
    if detail["type"] == "extra_forbidden":
        return Problem(f"unknown key '{spot.path[-1]}'", spot.node.key_at(path), _key_hint(spot))
    if detail["type"] == "missing" and isinstance(spot.absent, str):
        return Problem(f"missing key '{spot.absent}'", spot.node.key_at(path))
    if detail["type"] in ("union_tag_invalid", "union_tag_not_found"):
        return _tag_problem(detail, spot)
    what, hint = _what(detail, spot)
    where: Location = spot.node.at(path)
    if detail["loc"] and detail["loc"][-1] == "[key]":
        where = spot.node.key_at(path)
    return Problem(what, where, hint)


def _key_hint(spot: _Spot) -> str:
    unknown, meant = str(spot.path[-1]), _meant(spot)
    if not meant:
        return f"valid keys: {', '.join(_keys(spot.within))}"
    (_, given), (_, wanted) = split_key(unknown), split_key(meant[0])
    if len(meant) > 1:
        return f"did you mean one of {', '.join(meant)}?"
    if not wanted or split_key(unknown)[0] != split_key(meant[0])[0]:
        return f"did you mean '{meant[0]}'? valid keys: {', '.join(_keys(spot.within))}"
    hint = f"the key is '{meant[0]}', in {wanted.name}"
    value = spot.node.value
    if given and isinstance(value, int | float) and math.isfinite(value):
        number = converted(value, given, wanted)
        hint += f": write {meant[0]}: {number:g}" if number is not None else ""
    return hint


def _tag_problem(detail: dict[str, Any], spot: _Spot) -> Problem:
    key = detail["ctx"]["discriminator"].strip("'")
    union = one_of(spot.kind)
    members = get_args(_bare(spot.kind)) if union is None else tuple(union.models.values())
    choices = [str(tag) for m in members for tag in _own_tags(m, key)]
    tag = spot.node.child(key)
    if tag is None:
        hint = f"choices: {', '.join(choices)}"
        return Problem(f"missing key '{key}'", spot.node.key_at(join(spot.path)), hint)
    what = f"no such {key}: {shown(tag.value)}"
    hint = suggest(str(tag.value), choices)
    return Problem(what, tag.at(join((*spot.path, key))), hint)


def _own_tags(kind: Any, key: str) -> tuple[Any, ...]:
    field = _fields(_bare(kind)).get(key)
    return get_args(_bare(field.annotation)) if field else ()


_EXPECTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "string_type": "text",
    "tuple_type": "a list",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "model_attributes_type": "a mapping",
    "finite_number": "a finite number",
    "string_pattern_mismatch": "a name of letters, digits and . _ - that starts with a letter",
}

_BOUNDS = {
    "greater_than": ("gt", "above"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "below"),
    "less_than_equal": ("le", "at most"),
}


def _what(detail: dict[str, Any], spot: _Spot) -> tuple[str, str]:
    """The message and the hint of an error about a value."""
    kind, found = detail["type"], shown(spot.node.value)
    if kind == "literal_error":
        choices = [shown(choice) for choice in get_args(_bare(spot.kind))]
        return f"no such choice: {found}", suggest(found, choices)
    if kind in _EXPECTED:
        return f"must be {_EXPECTED[kind]}; found {found}", _value_hint(kind, spot)
    if kind in _BOUNDS:
        name, words = _BOUNDS[kind]
        return f"must be {words} {detail['ctx'][name]:g}; found {found}", ""
    if kind in ("missing", "too_short", "too_long"):
        return _length(detail, spot), ""
    if kind == "value_error":
        return str(detail["ctx"]["error"]), ""
    return str(detail["msg"]), ""


def _length(detail: dict[str, Any], spot: _Spot) -> str:
    value = spot.node.value
    count = len(value) if isinstance(value, tuple | dict) else 0
    arguments = get_args(_bare(spot.within if spot.absent is not None else spot.kind))
    if arguments and Ellipsis not in arguments and get_origin(_bare(spot.kind)) is not dict:
        return f"must have {len(arguments)} items; found {count}"
    if count == 0:
        return "must not be empty"
    context = detail.get("ctx", {})
    if "min_length" in context:
        return f"has {_items(count)}, which is too few: at least {context['min_length']}"
    return f"has {_items(count)}, which is too many: at most {context['max_length']}"


def _items(count: int) -> str:
    return "1 item" if count == 1 else f"{count} items"


def _value_hint(kind: str, spot: _Spot) -> str:
    value = spot.node.value
    if kind == "bool_type" and isinstance(value, str):
        return "YAML 1.2 knows only true and false"
    _, unit = split_key(spot.key)
    if kind not in ("float_type", "int_type") or unit is None or not isinstance(value, str):
        return ""
    return _number_hint(spot.key, value, unit)


def _number_hint(key: str, text: str, unit: Unit) -> str:
    quantity = parse_quantity(text)
    number = converted(*quantity, unit) if quantity else None
    hint = f"'{key}' is a plain number in {unit.name}"
    return f"{hint}: write {number:g}" if number is not None else hint
