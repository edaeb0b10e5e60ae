"""The central body of a multirotor."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator

from inspect_cli.schema.base import Positive, PositiveTriple, Strict, Triple


def _of_a_body(inertia: tuple[float, float, float]) -> tuple[float, float, float]:
    for i, axis in enumerate("xyz"):
        own, others = inertia[i], inertia[i - 1] + inertia[i - 2]
        if own > others:
            raise ValueError(
                f"no body has these moments of inertia: {own:g} about {axis} "
                f"is more than the sum of the other two, {others:g}"
            )
    return inertia


class Core(Strict):
    """The body without groups and arm."""

    mass_kg: Positive
    inertia_kgm2: Annotated[PositiveTriple, AfterValidator(_of_a_body)]
    com_m: Triple
    radius_m: Positive
    height_m: Positive
    gear_height_m: Positive
    """From O_b down to the feet."""
