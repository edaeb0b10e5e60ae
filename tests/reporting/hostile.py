"""Texts that would break out of a page, and models with them in every field that takes text."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from pydantic import BaseModel, ValidationError

M = TypeVar("M", bound=BaseModel)

RUN = "document.documentElement.dataset.pwned='1';alert(1)"
START = "⟪"
REST = (
    f"<script>{RUN}</script></script><!--\"'`"
    f'<img class=evil src=x onerror="{RUN}"><svg class=evil onload="{RUN}"></svg>'
    f'<a class=evil href="javascript:{RUN}">x</a><b class=evil>x</b>'
    f"</title></style></textarea>{{{{7*7}}}}${{7*7}}%{{x}}{{x}}&lt;i&gt;&amp;"
    "\U0001f6a8\u202eabc e\u0301\u0336 \u2028\x00⟫"
)
"""Markup, ends of elements, quotes, attributes that run, templates, entities, an emoji, an
override of the direction that nothing ends, combining characters, a separator of lines, NUL."""
EVIL = START + REST


@dataclass
class Poisoned(Generic[M]):
    """A model with hostile text in each field that takes it."""

    model: M
    taken: set[str] = field(default_factory=set)
    """Fields that take any text, as paths without indices."""
    refused: set[str] = field(default_factory=set)
    """Fields of text that the schema narrows to names, numbers of words or choices."""


def poisoned(model: M, ours: frozenset[str] = frozenset()) -> Poisoned[M]:
    """Tries every text of the model, every absent value and every list; keeps what is valid.

    The fields are found in the model as it is written, so that a new one is tried by itself.
    ``ours`` are fields that hold sentences of the source, which nobody else writes.
    """
    data = json.loads(model.model_dump_json(by_alias=True))
    result = Poisoned(model)
    for holder in list(_dicts(data)):
        holder[EVIL] = next(iter(holder.values()))
        try:
            result.model = type(model).model_validate_json(json.dumps(data))
        except ValidationError:
            del holder[EVIL]
    for path in list(_paths(data)):
        before, holder = _at(data, path), _at(data, path[:-1])
        name = ".".join("*" if isinstance(step, int) else step for step in path)
        if name in ours:
            continue
        candidates = [f"{before}{EVIL}"] if isinstance(before, str) else [EVIL, [EVIL]]
        for candidate in candidates:
            holder[path[-1]] = candidate
            try:
                result.model = type(model).model_validate_json(json.dumps(data))
            except ValidationError:
                holder[path[-1]] = before
            else:
                result.taken.add(name)
                break
        else:
            result.refused |= {name} if isinstance(before, str) else set()
    result.refused -= result.taken
    return result


def _paths(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _paths(item, (*path, key))
    elif isinstance(value, list) and value:
        for k, item in enumerate(value):
            yield from _paths(item, (*path, k))
    elif value is None or isinstance(value, str | list):
        yield path


def _dicts(value: Any) -> Iterator[dict[str, Any]]:
    """Every object that is not empty: where names are free, one more may be anything."""
    if isinstance(value, dict | list):
        for item in value.values() if isinstance(value, dict) else value:
            yield from _dicts(item)
    if isinstance(value, dict) and value:
        yield value


def _at(data: Any, path: tuple[str | int, ...]) -> Any:
    for step in path:
        data = data[step]
    return data
