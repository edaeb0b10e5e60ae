"""How a tool is turned towards a surface: one rule for planning and for flight.

z_T = −n always. About z_T there is freedom; the body's y axis, which is y_T, is kept level.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import cross

VERTICAL_COSINE = float(np.cos(np.radians(1.0)))
"""A tool within 1° of the vertical has no level direction to speak of: it keeps its heading."""


def contact_orientation(n_W: Vector, heading_hint: Vector) -> Matrix:
    """R_WT (3, 3) of a tool that presses on a surface with outward unit normal ``n_W`` (3,).

    z_T = −n. y_T = ±unit(z_W × z_T) is level, with the sign that points along ``heading_hint``
    (3,), a y axis in W, so the tool does not turn over. Within 1° of the vertical the hint is
    followed instead. Raises ValueError when a hint that has to be followed runs along n.
    """
    if abs(n_W[2]) > VERTICAL_COSINE:
        return heading_orientation(n_W, heading_hint)
    z_T = -np.asarray(n_W)
    y_T = np.array([-z_T[1], z_T[0], 0.0]) / np.hypot(z_T[0], z_T[1])
    return _frame(y_T if y_T @ heading_hint >= 0.0 else -y_T, z_T)


def heading_orientation(n_W: Vector, heading_hint: Vector) -> Matrix:
    """R_WT (3, 3) with z_T = −n and y_T as close to ``heading_hint`` (3,) as that allows.

    Unlike the level y axis this depends smoothly on a normal near the vertical. Raises
    ValueError when the hint runs along n.
    """
    z_T = -np.asarray(n_W)
    across = heading_hint - (heading_hint @ z_T) * z_T
    length = float(np.linalg.norm(across))
    if length < 1e-6:
        raise ValueError("the hint for the tool's y axis runs along the surface's normal")
    return _frame(across / length, z_T)


def _frame(y_T: Vector, z_T: Vector) -> Matrix:
    return np.column_stack([cross(y_T, z_T), y_T, z_T])
