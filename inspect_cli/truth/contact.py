"""What is so at the tool's tip: the nearest true surface and the specimen behind it."""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.records import State, TrueContact
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.spatial.primitives import normal_at, patch_distance, project
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.relief import relief_foot, relief_normal
from inspect_cli.truth.solids import Solids


@kernel
def nearest_surface(prims: Structured, p_W: Vector, contact: Structured) -> int:
    """Write surface, distance, normal and (u, v) of the nearest patch; return its index or −1."""
    row = contact[0]
    nearest, index = np.inf, -1
    for i in range(prims.shape[0]):
        distance = patch_distance(prims, i, p_W)
        if abs(distance) < abs(nearest):
            nearest, index = distance, i
    row["surface"] = index
    if index < 0:
        row["distance"] = np.nan
        row["n_W"][:] = np.nan
        row["uv"][:] = np.nan
        return index
    foot = project(prims, index, p_W)
    row["distance"] = nearest
    normal = normal_at(prims, index, foot[0], foot[1])
    for k in range(2):
        row["uv"][k] = foot[k]
    for k in range(3):
        row["n_W"][k] = normal[k]
    return index


@kernel
def nearer_relief(solids: Solids, p_W: Vector, contact: Structured, index: int) -> int:
    """Write over the ``index``-th surface where a relief is nearer; return the nearest's index."""
    row = contact[0]
    nearest = abs(row["distance"]) if index >= 0 else np.inf
    for i in range(solids.reliefs.shape[0]):
        u, v, w, _ = relief_foot(solids.reliefs, solids.nodes, i, p_W)
        if abs(w) >= nearest:
            continue
        nearest, index = abs(w), solids.primitives.shape[0] + i
        row["surface"] = index
        row["distance"] = w
        normal = relief_normal(solids.reliefs, solids.nodes, i, u, v)
        row["uv"][0] = u
        row["uv"][1] = v
        for k in range(3):
            row["n_W"][k] = normal[k]
    return index


class ContactTruth:
    """Keeps a TrueContact up to date."""

    def __init__(self, structure: StructureTruth) -> None:
        self._structure = structure
        self.contact = TrueContact.create()
        self._state: State | None = None
        self._p_WT = b""
        """The tip's position for which ``contact`` holds, as bytes."""

    def update(self, state: State) -> TrueContact:
        """The truth at the tip now."""
        contact = self.contact
        if state is not self._state:
            self._bind(state)
        contact.t_s = state.t_s
        p_WT = state.views["p_WT"].tobytes()
        if p_WT == self._p_WT:
            return contact
        self._p_WT = p_WT
        index = self._nearest()
        if self._nearer is not None:
            index = self._nearer(index)
        specimen = self._structure.surfaces[index].specimen if index >= 0 else None
        if specimen is None:
            contact.potential = contact.resistivity = float("nan")
        else:
            uv = contact.views["uv"]
            contact.potential, contact.resistivity = specimen.at(float(uv[0]), float(uv[1]))
        return contact

    def _bind(self, state: State) -> None:
        self._state = state
        solids, p_WT, contact = self._structure.solids, state.p_WT, self.contact.array
        self._nearest = bound(nearest_surface, solids.primitives, p_WT, contact)
        self._nearer = None
        if len(solids.reliefs):
            self._nearer = bound(nearer_relief, solids, p_WT, contact, then=(0,))
