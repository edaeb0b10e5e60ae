"""The true structure: what the planner believes, replaced, moved or removed by ``truth:``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.schema.geometry import Shape
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.primitives import displaced, primitives_of
from inspect_cli.schema.truth import ForceSensorModel, TrueSurface, TruthModel
from inspect_cli.spatial.arrays import Structured
from inspect_cli.truth.specimen import SpecimenField, load_specimen


@dataclass(frozen=True)
class SurfaceTruth:
    """One surface as it is."""

    name: str
    shape: Shape
    friction: float
    specimen: SpecimenField | None
    force_sensor: ForceSensorModel | None = None


@dataclass(frozen=True)
class StructureTruth:
    """Every surface that is there, and the same as primitives (n,) for kernels."""

    surfaces: tuple[SurfaceTruth, ...]
    primitives: Structured


def true_structure(
    truth: TruthModel, believed: Sequence[PlannedSurface], root: Path
) -> StructureTruth:
    """The true surfaces; ``root`` is the folder that specimen files are relative to."""
    surfaces = []
    for belief in believed:
        entry = truth.structure.get(belief.name, TrueSurface())
        if entry.absent:
            continue
        shape = displaced(entry.geometry or belief.shape, entry.moved)
        specimen = load_specimen(entry.specimen, root) if entry.specimen else None
        surfaces.append(
            SurfaceTruth(belief.name, shape, entry.friction, specimen, entry.force_sensor)
        )
    return StructureTruth(tuple(surfaces), primitives_of([s.shape for s in surfaces]))
