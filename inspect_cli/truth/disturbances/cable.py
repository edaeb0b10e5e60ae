"""The instrument's cable from a clamp on the ground to the vehicle, at rest at every moment.

A perfectly flexible cable of length L and weight w per metre, its upper end at the height Z and
the horizontal distance X from the clamp, d = √(X² + Z²). Forces on the upper end: H towards the
clamp, V downwards. The ground carries without friction. Three regimes:

slack     L ≥ X + Z: it hangs plumb and the rest lies loose: H = 0, V = w Z.
lying     a length s hangs as a catenary c (cosh(x/c) − 1) that leaves the ground at its lowest
          point, the rest lies straight: s² = Z² + 2 c Z, x_h = c arcosh(1 + Z/c),
          L_e − s + x_h = X: H = w c, V = w s.
lifted    all of it hangs: with u = X/2c, X² (sinh u/u)² + Z² = L_e²:
          H = w X/2u, V = ½ w (L_e + Z coth u).

An inextensible cable pulls without bound as d → L. This one gives a little: its length is

    L_e = L + T/k,        T = H d/X  (= w d/2u)

so that stretched out it pulls with k (d − L) along the chord, finite everywhere and continuous
through all regimes, and so gently that a vehicle stays stable against a force that is held for a
control tick. Where it hangs, T/k is millimetres.

Formulas: Irvine, "Cable Structures" (MIT Press, 1981), chapter 1 (the catenary). Left out are
inertia, drag and bending of the cable, friction on the ground, and structure in its way.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.schema.disturbances import Cable
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.truth.disturbances.load import Circumstances, Load, Motion

BISECTIONS = 60
"""Of an unknown that spans some thirty powers of e: to a part in 10¹⁴."""


@kernel
def _excess_lifted(u: float, x: float, z: float, length: float, w: float, k: float) -> float:
    """Squared length of the catenary less that of the cable; rises with u."""
    stretched = length + w * np.sqrt(x * x + z * z) / (2.0 * u * k)
    return float((x * np.sinh(u) / u) ** 2 + z * z - stretched**2)


@kernel
def _excess_lying(c: float, x: float, z: float, length: float, w: float, k: float) -> float:
    """Horizontal reach of hanging and lying cable less the distance; rises with c."""
    stretched = length + w * c * np.sqrt(x * x + z * z) / (x * k)
    return float(stretched - np.sqrt(z * z + 2.0 * c * z) + c * np.arccosh(1.0 + z / c) - x)


@kernel
def end_force(x: float, z: float, length: float, w: float, k: float) -> tuple[float, float]:
    """(H, V) in N on the upper end, ``x`` m away from the clamp and ``z`` m over the ground.

    ``length`` m, ``w`` N/m, ``k`` N/m. (0, 0) with the end on the ground or below it.
    """
    if z <= 0.0:
        return 0.0, 0.0
    if length >= x + z:
        return 0.0, w * z
    low, high = np.log(1e-12), np.log(50.0)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if _excess_lifted(np.exp(middle), x, z, length, w, k) > 0.0:
            high = middle
        else:
            low = middle
    u = np.exp(0.5 * (low + high))
    chord = np.sqrt(x * x + z * z)
    stretched = length + w * chord / (2.0 * u * k)
    if z / np.tanh(u) >= stretched:
        return w * x / (2.0 * u), 0.5 * w * (stretched + z / np.tanh(u))
    low, high = np.log(1e-12), np.log(k * chord / w + chord)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if _excess_lying(np.exp(middle), x, z, length, w, k) > 0.0:
            high = middle
        else:
            low = middle
    c = np.exp(0.5 * (low + high))
    return w * c, w * np.sqrt(z * z + 2.0 * c * z)


@kernel
def cable_force(clamp_m: Vector, end_W: Vector, length: float, w: float, k: float) -> Vector:
    """The cable's force (3,) N in W on its end; ``clamp_m`` (2,) is on the ground."""
    dx, dy = clamp_m[0] - end_W[0], clamp_m[1] - end_W[1]
    distance = np.sqrt(dx * dx + dy * dy)
    towards, down = end_force(distance, end_W[2], length, w, k)
    scale = towards / distance if distance > 0.0 else 0.0
    return np.array([scale * dx, scale * dy, -down])


class CableLoad:
    """One cable; without a stated clamp it is fixed under the vehicle's first place."""

    def __init__(self, model: Cable) -> None:
        self._model = model
        self._weight_npm = model.mass_kgpm * GRAVITY_MPS2
        self._clamp_m: Vector | None = None
        if model.clamp_m is not None:
            self._clamp_m = np.array(model.clamp_m)

    def act(self, t_s: float, motion: Motion, load: Load) -> None:
        """Add the force on the end that the vehicle carries."""
        model = self._model
        if self._clamp_m is None:
            self._clamp_m = motion.p_WB[:2].copy()
        at_tool = model.attached == "tool"
        end_W = motion.p_WT if at_tool else motion.p_WB
        force_W = cable_force(
            self._clamp_m, end_W, model.length_m, self._weight_npm, model.stiffness_npm
        )
        carried = load.force_tip_W if at_tool else load.force_W
        carried += force_W
        load.record.f_cable_W += force_W


def cable_load(entry: Cable, _: Circumstances) -> CableLoad:
    """The load of one entry."""
    return CableLoad(entry)
