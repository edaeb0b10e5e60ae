"""What a record is: named float64 fields with shape, unit and frame, declared once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Self, overload

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.spatial.arrays import Structured, Vector

Lengths = Mapping[str, int]
NO_LENGTHS: Lengths = {}


class Field:
    """The declaration of one field of a record."""

    def __init__(self, shape: tuple[int | str, ...], unit: str, frame: str, meaning: str) -> None:
        self.shape = shape
        self.unit = unit
        self.frame = frame
        self.meaning = meaning
        self.name = ""

    def __set_name__(self, owner: type[Record], name: str) -> None:
        self.name = name

    def resolved_shape(self, lengths: Lengths) -> tuple[int, ...]:
        """The shape in numbers."""
        return tuple(lengths.get(n, 0) if isinstance(n, str) else n for n in self.shape)


class ArrayField(Field):
    """A field that holds float64 numbers; reading it gives a view, so write to ``[...]``."""

    @overload
    def __get__(self, record: None, owner: type[Record]) -> Self: ...
    @overload
    def __get__(self, record: Record, owner: type[Record]) -> Vector: ...
    def __get__(self, record: Record | None, owner: type[Record]) -> Self | Vector:
        """The view on the record's numbers, or the declaration when asked of the class."""
        if record is None:
            return self
        return record.views[self.name]

    def __set__(self, record: Record, value: ArrayLike) -> None:
        record.views[self.name][...] = np.asarray(value)


class ScalarField(Field):
    """A field that holds one float64."""

    def __init__(self, unit: str, meaning: str) -> None:
        super().__init__((), unit, "", meaning)

    @overload
    def __get__(self, record: None, owner: type[Record]) -> Self: ...
    @overload
    def __get__(self, record: Record, owner: type[Record]) -> float: ...
    def __get__(self, record: Record | None, owner: type[Record]) -> Self | float:
        """The number, or the declaration when asked of the class."""
        if record is None:
            return self
        return float(record.views[self.name][0])

    def __set__(self, record: Record, value: float) -> None:
        record.views[self.name][0] = value


def scalar(unit: str, meaning: str) -> ScalarField:
    """Declare one number."""
    return ScalarField(unit, meaning)


def vector(length: int | str, unit: str, frame: str, meaning: str) -> ArrayField:
    """Declare a vector; ``length`` may name a number that the platform decides."""
    return ArrayField((length,), unit, frame, meaning)


class Record:
    """A row of named float64 fields. Subclass it and declare the fields.

    Every record begins with its time. ``topic`` is where the log keeps it.
    """

    topic: ClassVar[str] = ""

    t_s = scalar("s", "time since the start of the run")

    __slots__ = ("array", "views")

    def __init__(self, array: Structured) -> None:
        self.array = array
        self.views: dict[str, Vector] = {}
        for field in self.fields():
            view = array[field.name]
            self.views[field.name] = view if isinstance(field, ScalarField) else view[0]

    @classmethod
    def fields(cls) -> Iterator[Field]:
        """The declared fields, base classes first, in order of declaration."""
        for base in reversed(cls.__mro__):
            for value in vars(base).values():
                if isinstance(value, Field):
                    yield value

    @classmethod
    def dtype(cls, lengths: Lengths = NO_LENGTHS) -> np.dtype[Any]:
        """The packed little-endian layout of one record."""
        return np.dtype([(f.name, "<f8", f.resolved_shape(lengths)) for f in cls.fields()])

    @classmethod
    def create(cls, lengths: Lengths = NO_LENGTHS) -> Self:
        """A record of zeros."""
        return cls(np.zeros(1, cls.dtype(lengths)))
