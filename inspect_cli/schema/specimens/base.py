"""What every kind of specimen states."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from inspect_cli.schema.base import Strict
from inspect_cli.schema.geometry import TrueShape


class SpecimenModel(Strict):
    """Potential and resistivity under a surface. A kind adds what they follow from."""

    files: ClassVar[tuple[str, ...]] = ()
    """The keys that name files of the campaign."""

    model: str
    temperature_c: Annotated[float, Field(ge=0, le=49)] = 22.2
    """Of the concrete, in which a copper sulphate electrode reads these potentials; within the
    range that ASTM C876 corrects."""

    def refuse_unfit(self, shape: TrueShape, extent_m: tuple[float, float] | None = None) -> None:
        """Raise ValueError where the specimen cannot lie under a surface of this shape.

        ``extent_m`` is the surface's extent along u and v, for a mesh, which does not state its
        own.
        """
