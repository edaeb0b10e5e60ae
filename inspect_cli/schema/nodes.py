"""What a YAML file says, every value with the place where it stands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from inspect_cli.errors import Location

Step = str | int
Scalar = None | bool | int | float | str


@dataclass(frozen=True)
class Node:
    """A value: a scalar, a tuple of nodes, or a mapping from keys to nodes."""

    value: Scalar | tuple[Node, ...] | dict[str, Node]
    file: str
    line: int
    column: int
    key: Location | None = None
    """Where the key stands that leads to this value, if it is an entry of a mapping."""

    @property
    def plain(self) -> object:
        """The value without places: dict, tuple and scalars."""
        if isinstance(self.value, dict):
            return {key: node.plain for key, node in self.value.items()}
        if isinstance(self.value, tuple):
            return tuple(node.plain for node in self.value)
        return self.value

    def child(self, step: Step) -> Node | None:
        """The entry of a mapping or the item of a sequence, None if there is none."""
        if isinstance(self.value, dict) and isinstance(step, str):
            return self.value.get(step)
        if isinstance(self.value, tuple) and isinstance(step, int) and step < len(self.value):
            return self.value[step]
        return None

    def children(self) -> Iterator[tuple[Step, Node]]:
        """The entries or items, in the order of the file."""
        if isinstance(self.value, dict):
            yield from self.value.items()
        elif isinstance(self.value, tuple):
            yield from enumerate(self.value)

    def at(self, path: str) -> Location:
        """The place of the value."""
        return Location(self.file, self.line, self.column, path)

    def key_at(self, path: str) -> Location:
        """The place of the key that leads here; of the value itself where there is no key."""
        return replace(self.key, path=path) if self.key else self.at(path)


def join(steps: Sequence[Step]) -> str:
    """``("tasks", 0, "pitch_m")`` as ``tasks[0].pitch_m``."""
    text = ""
    for step in steps:
        text += f"[{step}]" if isinstance(step, int) else f".{step}" if text else step
    return text


def merged(base: Node, over: Node) -> Node:
    """``over`` laid upon ``base``: mappings merge key by key, everything else is replaced.

    A null in ``over`` removes the key that ``base`` has. A specimen of another ``model``, and a
    sensor or shape of another ``kind``, replaces the one that ``base`` has: their keys have
    nothing to do with each other.
    """
    if not (isinstance(base.value, dict) and isinstance(over.value, dict)):
        return over
    for key in ("model", "kind"):
        first, second = base.child(key), over.child(key)
        if first and second and first.value != second.value:
            return over
    entries = dict(base.value)
    for key, node in over.value.items():
        inherited = entries.get(key)
        if inherited is None:
            entries[key] = node
        elif node.value is None:
            del entries[key]
        else:
            entries[key] = merged(inherited, node)
    return replace(over, value=entries)


def matches(root: Node, pattern: str) -> Iterator[tuple[tuple[Step, ...], Node]]:
    """Every value under ``root`` whose path fits ``pattern``: keys, or ``*`` for any, with dots."""
    found: list[tuple[tuple[Step, ...], Node]] = [((), root)]
    for part in pattern.split("."):
        found = [
            ((*steps, step), child)
            for steps, node in found
            for step, child in node.children()
            if part in ("*", step)
        ]
    yield from found


def replaced(root: Node, steps: Sequence[Step], value: Scalar) -> Node:
    """``root`` with the scalar at ``steps`` replaced; places stay."""
    if not steps:
        return replace(root, value=value)
    first, rest = steps[0], steps[1:]
    if isinstance(root.value, dict):
        entries = {k: replaced(n, rest, value) if k == first else n for k, n in root.value.items()}
        return replace(root, value=entries)
    assert isinstance(root.value, tuple)
    items = (replaced(n, rest, value) if i == first else n for i, n in enumerate(root.value))
    return replace(root, value=tuple(items))


def without(root: Node, keys: Sequence[str]) -> Node:
    """The mapping ``root`` without some of its keys."""
    assert isinstance(root.value, dict)
    return replace(root, value={k: v for k, v in root.value.items() if k not in keys})
