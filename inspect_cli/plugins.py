"""Registries that installed packages can add to through entry points.

A registry is a mapping from a name to the thing of that name: a chapter, a sensor, a kind of
platform. A package outside this one adds a row in its ``pyproject.toml``::

    [project.entry-points."inspect_cli.chapters"]
    corrosion_rate = "its_package.chapter:CHAPTER"

Entry points belong to the installation, so that worker processes find the same rows.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.metadata import EntryPoint, entry_points
from typing import Any, TypeVar

from inspect_cli.errors import EnvironmentFault

T = TypeVar("T")


def registered(group: str, builtin: Mapping[str, T], kind: Any = None) -> dict[str, T]:
    """The built-in rows of a registry in their order, then those of installed packages by name.

    Rows of packages are ordered by name and not by how the packages were found, so that two
    machines with the same packages report the same.

    Args:
        group: the group of entry points, such as ``"inspect_cli.chapters"``
        builtin: name -> thing, as this package brings it
        kind: the class of which every row is an instance or a subclass; Callable: what is called

    Raises:
        EnvironmentFault: an entry point cannot be imported, is no ``kind``, or its name is taken.
    """
    rows = dict(builtin)
    for point in sorted(entry_points(group=group), key=lambda point: (point.name, point.value)):
        if point.name in rows:
            raise EnvironmentFault(
                f"{_origin(point)} registers {point.name!r} in {group}, but that name is taken",
                hint=f"remove one of the packages; names taken: {', '.join(rows)}",
            )
        try:
            rows[point.name] = point.load()
        except (Exception, SystemExit) as error:  # it is other people's code that runs here
            raise _broken(point, f"which cannot be imported: {error!r}") from error
        if kind is not None and not _is_a(rows[point.name], kind):
            raise _broken(point, f"which is no {kind.__name__}")
    return rows


def _is_a(row: object, kind: Any) -> bool:
    """Whether a row is an instance of ``kind`` or, where it is a class, a subclass."""
    if kind is Callable:
        return callable(row)
    return issubclass(row, kind) if isinstance(row, type) else isinstance(row, kind)


def _broken(point: EntryPoint, why: str) -> EnvironmentFault:
    return EnvironmentFault(
        f"{_origin(point)} registers {point.name!r} in {point.group} as {point.value}, {why}",
        hint="repair that package or uninstall it",
    )


def _origin(point: EntryPoint) -> str:
    """The installed package that an entry point belongs to."""
    return f"package {point.dist.name}" if point.dist else f"entry point {point.value}"
