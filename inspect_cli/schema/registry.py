"""A field of a file model whose kinds stand in a registry.

    Disturbance = Annotated[DisturbanceModel, OneOf(DISTURBANCES)]

is the union of the registry's models, told apart by a key of the entry. Installed packages may add
rows (``inspect_cli.plugins``), so that the union cannot be written out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from inspect_cli.errors import EnvironmentFault


def choice_of(names: Iterable[str]) -> Any:
    """The type of a text that is one of these names.

    A Literal whose names are the keys of a registry, and so cannot be written out.
    """
    literal: Any = Literal
    return literal[tuple(names)]


class OneOf:
    """The registry's models, told apart by the key ``key``; ``default`` names that of no key.

    A model states its own name in a field ``key`` of type Literal. The rows of the moment at which
    a class with such a field is defined are those that the class accepts.
    """

    def __init__(
        self, models: Mapping[str, type[BaseModel]], key: str = "kind", default: str | None = None
    ) -> None:
        for name, model in models.items():
            field = model.model_fields.get(key)
            if field is None or name not in _names(field.annotation):
                raise EnvironmentFault(
                    f"{model.__module__}.{model.__qualname__} is registered as {name!r}, "
                    f"which its field {key!r} does not take",
                    hint=f"give it {key}: Literal[{name!r}], or register it by its own name",
                )
        self.models = models
        self.key = key
        self.default = default

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """The tagged union of the models."""
        choices = {name: handler.generate_schema(model) for name, model in self.models.items()}
        if self.default is None:
            return core_schema.tagged_union_schema(choices, self.key)
        return core_schema.tagged_union_schema(
            choices,
            self._tagger(self.default),
            custom_error_type="union_tag_invalid",
            # pydantic would name the function in place of the key.
            custom_error_context={"discriminator": f"'{self.key}'", "tag": "", "expected_tags": ""},
        )

    def _tagger(self, default: str) -> Callable[[Any], Any]:
        def tag(entry: Any) -> Any:
            if isinstance(entry, dict):
                return entry.get(self.key, default)
            return getattr(entry, self.key, default)

        return tag


def _names(kind: Any) -> tuple[object, ...]:
    """The texts of a Literal, which may be optional."""
    return tuple(name for part in get_args(kind) for name in (_names(part) or (part,)))


def one_of(kind: Any) -> OneOf | None:
    """The registry behind a field's type, which may be optional; None if there is none."""
    if get_origin(kind) is Annotated:
        inner, *metadata = get_args(kind)
        return next((entry for entry in metadata if isinstance(entry, OneOf)), one_of(inner))
    if get_origin(kind) in (Union, UnionType):
        members = [member for member in get_args(kind) if member is not NoneType]
        return one_of(members[0]) if len(members) == 1 else None
    return None
