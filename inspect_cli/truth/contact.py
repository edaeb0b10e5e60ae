"""What is so at the tool's tip: the nearest true surface and the specimen behind it."""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import State, TrueContact
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.solids import Solids, count_of, distance_from, foot_on, normal_on


@kernel
def nearest_surface(solids: Solids, p_W: Vector, contact: Structured) -> int:
    """Write surface, distance, normal and (u, v) of the nearest patch; return its index or −1."""
    row = contact[0]
    nearest, index = np.inf, -1
    for i in range(count_of(solids)):
        distance = distance_from(solids, i, p_W)
        if abs(distance) < abs(nearest):
            nearest, index = distance, i
    row["surface"] = index
    if index < 0:
        row["distance"] = np.nan
        row["n_W"][:] = np.nan
        row["uv"][:] = np.nan
        return index
    u, v, _, _ = foot_on(solids, index, p_W)
    row["distance"] = nearest
    normal = normal_on(solids, index, u, v)
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

    def update(self, state: State) -> TrueContact:
        """The truth at the tip now."""
        contact = self.contact
        index = nearest_surface(self._structure.solids, state.views["p_WT"], contact.array)
        contact.t_s = state.t_s
        specimen = self._structure.surfaces[index].specimen if index >= 0 else None
        if specimen is None:
            contact.potential = contact.resistivity = float("nan")
        else:
            uv = contact.views["uv"]
            contact.potential, contact.resistivity = specimen.at(float(uv[0]), float(uv[1]))
        return contact
