"""The true structure: what is believed, replaced, moved, removed or added to by ``truth:``.

Surfaces that are bounded primitives come first, in the order of belief and then of the truth's
file; those that are reliefs follow. A surface's place in this order is its number everywhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from inspect_cli.assessment.electrodes import STANDARD_C
from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.schema.geometry import MeshShape, TrueShape
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.primitives import displaced, primitives_of
from inspect_cli.schema.specimens import SpecimenModel
from inspect_cli.schema.truth import ForceSensorModel, TrueSurface, TruthModel
from inspect_cli.truth.heights import MeshRelief, mesh_relief
from inspect_cli.truth.macro_cell.patch import patch_of
from inspect_cli.truth.solids import Solids, joined_reliefs
from inspect_cli.truth.specimens import load_specimen
from inspect_cli.truth.specimens.fields import SpecimenField


@dataclass(frozen=True)
class SurfaceTruth:
    """One surface as it is."""

    name: str
    shape: TrueShape
    friction: float
    specimen: SpecimenField | None
    relief: MeshRelief | None = None
    """The heights of a mesh."""
    force_sensor: ForceSensorModel | None = None


@dataclass(frozen=True)
class StructureTruth:
    """Every surface that is there, and the same for kernels, in the same order."""

    surfaces: tuple[SurfaceTruth, ...]
    solids: Solids

    @property
    def temperatures_c(self) -> list[float]:
        """Of the concrete of each surface; 22.2 °C where nothing is known of it."""
        specimens = (surface.specimen for surface in self.surfaces)
        return [STANDARD_C if one is None else one.temperature_c for one in specimens]


def true_structure(
    truth: TruthModel, believed: Sequence[PlannedSurface], root: Path
) -> StructureTruth:
    """The true surfaces; ``root`` is the folder that the files of the truth are relative to.

    Raises InputError for a specimen or a mesh that cannot be used.
    """
    surfaces = []
    for name, shape, entry in _there(truth, believed):
        relief = mesh_relief(shape, entry.moved, root) if isinstance(shape, MeshShape) else None
        if not isinstance(shape, MeshShape):
            shape = displaced(shape, entry.moved)
        specimen = _specimen(name, entry.specimen, shape, relief, root)
        sensor = entry.force_sensor
        surfaces.append(SurfaceTruth(name, shape, entry.friction, specimen, relief, sensor))
    return structure_of(surfaces)


def structure_of(surfaces: Sequence[SurfaceTruth]) -> StructureTruth:
    """The structure that consists of these surfaces."""
    primitives = [s for s in surfaces if not isinstance(s.shape, MeshShape)]
    reliefs = [(s, s.relief) for s in surfaces if s.relief is not None]
    shapes = [s.shape for s in primitives if not isinstance(s.shape, MeshShape)]
    rows, nodes = joined_reliefs([(relief.row, relief.nodes) for _, relief in reliefs])
    ordered = (*primitives, *(s for s, _ in reliefs))
    return StructureTruth(ordered, Solids(primitives_of(shapes), rows, nodes))


def _specimen(
    name: str, model: SpecimenModel | None, shape: TrueShape, relief: MeshRelief | None, root: Path
) -> SpecimenField | None:
    """The field under a surface.

    Raises InputError where it does not fit the surface or has no solution, at the path in the
    mission that ``specimen_path`` gives.
    """
    if model is None:
        return None
    extent = 2.0 * relief.row["half_size"][0] if relief is not None else (0.0, 0.0)
    patch = patch_of(shape, (float(extent[0]), float(extent[1])))
    here = Location("mission", path=specimen_path(name))
    try:
        model.refuse_unfit(shape, patch.size_m)
        return load_specimen(model, root, patch)
    except InputError as error:
        raise InputError([replace(p, where=p.where or here) for p in error.problems]) from error
    except ValueError as error:
        raise InputError(Problem(str(error), here)) from error


def specimen_path(surface: str) -> str:
    """Where a mission states what is beneath a surface."""
    return f"truth.structure.{surface}.specimen"


def _there(
    truth: TruthModel, believed: Sequence[PlannedSurface]
) -> Iterator[tuple[str, TrueShape, TrueSurface]]:
    """(name, shape before its displacement, truth) of what is there."""
    for belief in believed:
        entry = truth.structure.get(belief.name, TrueSurface())
        if not entry.absent:
            yield belief.name, entry.geometry or belief.shape, entry
    known = {belief.name for belief in believed}
    for name, entry in truth.structure.items():
        if name not in known and entry.geometry is not None and not entry.absent:
            yield name, entry.geometry, entry
