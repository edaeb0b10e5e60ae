"""The base of every file model: strict, closed, without NaN, with its unit in each key."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

SCHEMA_VERSION = 1


class Strict(BaseModel):
    """A model that refuses unknown keys, silent conversions, infinities and NaN."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        frozen=True,
        allow_inf_nan=False,
        validate_default=True,
        use_attribute_docstrings=True,
    )


UNIT_TOLERANCE = 1e-12


def _unit_length(value: tuple[float, float, float]) -> tuple[float, float, float]:
    norm = math.hypot(*value)
    if norm < 1e-9:
        raise ValueError("a direction must not be zero")
    if math.isinf(norm):
        raise ValueError("a direction must be of finite length")
    if abs(norm - 1.0) < UNIT_TOLERANCE:
        return value  # what was written out comes back to the last digit
    return (value[0] / norm, value[1] / norm, value[2] / norm)


Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Triple = tuple[float, float, float]
PositiveTriple = tuple[Positive, Positive, Positive]
Direction = Annotated[Triple, AfterValidator(_unit_length)]
Six = tuple[float, float, float, float, float, float]
Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_.-]*$", max_length=80)]
Count = Annotated[int, Field(ge=1)]
