"""Newton's method for concrete that is joined to steel with a nonlinear current.

Unknown are E in the concrete and E_b at the bars. Each node of the sheet has bars of one or several
kinds k (active and passive), each with its part A_k of the node's area A. With a the steel's share,
r the constriction and S a source per node (none in a mission; tests manufacture solutions with it),

    outflow(E) + [at the steel: Σ_k (A_k / r)(E − E_bk)] = S
    A_k a i_k(E_bk) + (A_k / r)(E_bk − E) = 0

The E_bk are eliminated from each linear step. The left-hand sides are the gradient of a convex
energy, so that there is one solution; it lies between the lowest and the highest rest potential of
the steel (maximum principle), and every iterate is cut to these bounds, which keeps the
exponentials tame. Steps are halved until the residual falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from inspect_cli.errors import InputError
from inspect_cli.spatial.arrays import Matrix
from inspect_cli.truth.macro_cell.concrete import Concrete, outflow, solve_linear

MOST_STEPS: Final = 100
MOST_HALVINGS: Final = 12
POTENTIAL_TOLERANCE_V: Final = 1e-8
CHARGE_TOLERANCE: Final = 1e-9
"""Unbalanced current, summed over the nodes, against the current of the anodes."""
EPSILON: Final = float(np.finfo(np.float64).eps)
ROUNDINGS: Final = 16
"""Of each node's largest currents, in its balance."""
LINEAR_TOLERANCE: Final = 1e-2
"""Of each linear step: it sets how many steps there are, not how good the solution is."""


class Polarisation(Protocol):
    """What Newton's method needs to know of the steel."""

    def current(self, E: Matrix) -> tuple[Matrix, Matrix]:
        """(net anodic current density, its slope) of each kind of steel at potentials E."""
        ...

    def rest(self) -> Matrix:
        """Where the steel of each kind and node rests on its own, V."""
        ...


@dataclass(frozen=True)
class Joint:
    """How the sheet's nodes are joined to the steel; both (n_k, n_v, n_u) and above zero."""

    steel_area: Matrix
    """A_k a, m²."""
    conductance: Matrix
    """A_k / r, S."""


@dataclass(frozen=True)
class Potentials:
    """The solution, V: in the concrete (n_d, n_v, n_u) and at the bars (n_k, n_v, n_u)."""

    concrete: Matrix
    bars: Matrix
    steps: int


def solve_potentials(
    concrete: Concrete,
    joint: Joint,
    steel: Polarisation,
    source: Matrix | None = None,
    bounds_v: tuple[float, float] | None = None,
) -> Potentials:
    """The potentials at which every node's currents balance.

    Args:
        concrete: the network of the concrete.
        joint: how its sheet is joined to the steel.
        steel: the polarisation of the steel.
        source: S per node, A.
        bounds_v: where the solution is known to lie, if a source makes it leave the steel's.

    Raises InputError where it does not converge.
    """
    rest = steel.rest()
    low, high = bounds_v or (float(rest.min()), float(rest.max()))
    bars = np.clip(rest, low, high)
    weight = joint.steel_area * steel.current(bars)[1]
    E = np.full(concrete.diagonal.shape, float(np.sum(weight * bars) / np.sum(weight)))
    load = np.zeros_like(E) if source is None else source
    balance = _balance(concrete, joint, steel, load, E, bars)
    for step in range(1, MOST_STEPS + 1):
        dE, dbars = _step(concrete, joint, steel, balance, bars)
        before = E
        E, bars, balance = _damped(
            (low, high), concrete, joint, steel, load, (E, bars), (dE, dbars), balance
        )
        moved = float(np.abs(E - before).max())
        wanted = CHARGE_TOLERANCE * _through(joint, steel, bars) + _rounding(concrete, E)
        if moved < POTENTIAL_TOLERANCE_V and _unbalanced(balance) <= wanted:
            return Potentials(E, bars, step)
    raise InputError(
        f"the potentials of the macro cell did not settle in {MOST_STEPS} steps",
        hint="look for a resistivity, a current density or a Tafel slope that is far from steel's",
    )


Balance = tuple[Matrix, Matrix]
"""What the nodes of the concrete and the bars lack, A."""


def _balance(
    concrete: Concrete, joint: Joint, steel: Polarisation, load: Matrix, E: Matrix, bars: Matrix
) -> Balance:
    exchanged = joint.conductance * (E[concrete.steel] - bars)
    nodes = outflow(concrete, E) - load
    nodes[concrete.steel] += exchanged.sum(axis=0)
    return nodes, joint.steel_area * steel.current(bars)[0] - exchanged


def _unbalanced(balance: Balance) -> float:
    return float(np.sum(np.abs(balance[0])) + np.sum(np.abs(balance[1])))


def _through(joint: Joint, steel: Polarisation, bars: Matrix) -> float:
    """The current that leaves the steel and comes back, A."""
    return 0.5 * float(np.sum(np.abs(joint.steel_area * steel.current(bars)[0])))


def _rounding(concrete: Concrete, E: Matrix) -> float:
    """What sums of currents cannot be told from zero, A: uniform steel sends no current at all."""
    return ROUNDINGS * EPSILON * float(np.sum(concrete.diagonal * np.abs(E)))


def _step(
    concrete: Concrete, joint: Joint, steel: Polarisation, balance: Balance, bars: Matrix
) -> tuple[Matrix, Matrix]:
    """Newton's step; the bars' unknowns are eliminated."""
    slope = joint.steel_area * steel.current(bars)[1]
    share = joint.conductance / (joint.conductance + slope)
    load = -balance[0]
    load[concrete.steel] -= (share * balance[1]).sum(axis=0)
    dE = solve_linear(concrete, (share * slope).sum(axis=0), load, LINEAR_TOLERANCE)
    dbars = (joint.conductance * dE[concrete.steel] - balance[1]) / (joint.conductance + slope)
    return dE, dbars


def _damped(
    bounds: tuple[float, float],
    concrete: Concrete,
    joint: Joint,
    steel: Polarisation,
    load: Matrix,
    at: tuple[Matrix, Matrix],
    step: tuple[Matrix, Matrix],
    balance: Balance,
) -> tuple[Matrix, Matrix, Balance]:
    """The step, halved until less is unbalanced, within the bounds."""
    least = _unbalanced(balance)
    size = 1.0
    for _ in range(MOST_HALVINGS):
        E = np.clip(at[0] + size * step[0], *bounds)
        bars = np.clip(at[1] + size * step[1], *bounds)
        found = _balance(concrete, joint, steel, load, E, bars)
        if _unbalanced(found) < least:
            break
        size *= 0.5
    return E, bars, found
