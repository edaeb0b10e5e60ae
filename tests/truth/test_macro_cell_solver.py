"""The finite volumes against manufactured solutions, a Fourier series and finite elements."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from skfem import (
    Basis,
    BilinearForm,
    ElementHex1,
    ElementQuad2,
    FacetBasis,
    LinearForm,
    MeshHex,
    MeshQuad,
    asm,
    condense,
    solve,
)
from skfem.helpers import dot, grad

from inspect_cli.schema.specimens.macro_cell import Bars, Kinetics
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.truth.macro_cell.concrete import Concrete, concrete_of, outflow, solve_linear
from inspect_cli.truth.macro_cell.mat import constriction_m, steel_share
from inspect_cli.truth.macro_cell.newton import Joint, solve_potentials
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.macro_cell.steel import Steel, branches

FLAT = Patch((1.0, 1.0))
PIER = Patch((1.0, 1.0), "cylinder", 1.0 / 0.8)
VAULT = Patch((1.0, 1.0), "cylinder", -1.0 / 0.8)
BALL = Patch((1.0, 1.0), "sphere", 1.0 / 0.8)
COVER, THICKNESS = 0.08, 0.24
SHARE, REACH = 0.5, 0.02
PASSIVE = Kinetics(
    rest_v=-0.12, current_apm2=2e-3, anodic_slope_vpdec=0.3, cathodic_slope_vpdec=0.16
)


@dataclass(frozen=True)
class Linear:
    """Steel of the polarisation resistance ``ohm_m2`` around the rest potentials."""

    rests: Matrix
    ohm_m2: float

    def current(self, E: Matrix) -> tuple[Matrix, Matrix]:
        return (E - self.rests) / self.ohm_m2, np.full_like(E, 1.0 / self.ohm_m2)

    def rest(self) -> Matrix:
        return self.rests


def nodes(cells: int) -> tuple[Vector, Vector, Vector, int]:
    """(u, v, d, index of the steel) on a metre square; cells must be a multiple of 8."""
    u = np.linspace(-0.5, 0.5, cells + 1)
    above, below = cells // 4, cells // 2
    upper = np.linspace(0.0, COVER, above + 1)
    return u, u, np.append(upper, np.linspace(COVER, THICKNESS, below + 1)[1:]), above


def rho(u: Vector, v: Vector) -> Matrix:
    """A smooth resistivity that varies by a factor of three."""
    return 200.0 * np.exp(0.5 * np.sin(3.0 * u + 1.0) * np.cos(2.0 * v))


def exact(u: Vector, v: Vector, d: Vector) -> Matrix:
    """No current through the outer faces."""
    along = np.sin(np.pi * u) + 0.5 * np.cos(2.0 * np.pi * u) * np.sin(np.pi * v)
    return -0.3 + 0.1 * along * (1.0 + 0.5 * np.cos(np.pi * d / THICKNESS))


def divergence(patch: Patch, u: Vector, v: Vector, d: Vector, step: float = 1e-4) -> Matrix:
    """h_u h_v ∇·(∇E/ρ) of the exact solution, by central differences of the continuous field."""

    def flux(axis: int, *at: Vector) -> Matrix:
        h_u, h_v = patch.scales(at[1], at[2])
        factor = (h_v / h_u, h_u / h_v, h_u * h_v)[axis]
        ahead, behind = list(at), list(at)
        ahead[axis], behind[axis] = at[axis] + 0.5 * step, at[axis] - 0.5 * step
        return factor / rho(at[0], at[1]) * (exact(*ahead) - exact(*behind)) / step

    total = 0.0
    for axis in range(3):
        ahead, behind = [u, v, d], [u, v, d]
        ahead[axis], behind[axis] = ahead[axis] + 0.5 * step, behind[axis] - 0.5 * step
        total = total + (flux(axis, *ahead) - flux(axis, *behind)) / step
    return np.asarray(total)


def at_the_bars(sheet: Matrix, reach: Matrix) -> Matrix:
    """E_b with a i(E_b) + (E_b − E)/r = 0 at given E, by bisection."""
    low, high = np.full_like(sheet, -2.0), np.full_like(sheet, 1.0)
    for _ in range(80):
        middle = 0.5 * (low + high)
        anodic, cathodic, _ = branches(PASSIVE, middle, np.ones_like(sheet))
        above = SHARE * (anodic - cathodic) + (middle - sheet) / reach > 0.0
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return 0.5 * (low + high)


def manufactured_error(patch: Patch, cells: int) -> float:
    u, v, d, steel = nodes(cells)
    grid = u[None, None, :], v[None, :, None], d[:, None, None]
    resistivity = rho(u[None, :], v[:, None])
    concrete = concrete_of(patch, u, v, d, steel, resistivity)
    h_u, h_v = patch.scales(grid[1], grid[2])
    wanted = exact(*grid)
    source = -concrete.volume / (h_u * h_v) * divergence(patch, *grid)
    bars = at_the_bars(wanted[steel], REACH * resistivity)
    source[steel] += concrete.area * (wanted[steel] - bars) / (REACH * resistivity)
    joint = Joint(SHARE * concrete.area[None], concrete.area[None] / (REACH * resistivity))
    found = solve_potentials(
        concrete, joint, Steel((PASSIVE,), np.ones_like(resistivity)), source, (-1.0, 0.5)
    )
    return float(np.abs(found.concrete - wanted).max())


@pytest.mark.parametrize("patch", [FLAT, PIER, VAULT, BALL], ids=["flat", "pier", "vault", "ball"])
def test_manufactured_solutions_are_met_with_second_order(patch: Patch) -> None:
    errors = [manufactured_error(patch, cells) for cells in (8, 16, 32)]
    orders = [math.log2(coarse / fine) for coarse, fine in pairwise(errors)]
    assert errors[-1] < 1e-3
    assert all(1.8 < order < 2.3 for order in orders), (errors, orders)


def test_a_plate_of_linear_steel_follows_its_fourier_mode() -> None:
    """E = Ê sin(πu) cosh(k d)/cosh(k c) above the steel, with the rest Ê₀ sin(πu) and k = π:

    outflow k/ρ (tanh kc + tanh k(H − c)) Ê = (Ê₀ − Ê) / (R_p/a + r).
    """
    resistivity, ohm_m2, k = 300.0, 20.0, np.pi
    u, v, d, steel = nodes(40)
    concrete = concrete_of(FLAT, u, v, d, steel, np.full((len(v), len(u)), resistivity))
    rests = -0.3 + 0.2 * np.sin(np.pi * u) * np.ones((len(v), 1))
    reach = REACH * resistivity
    joint = Joint(SHARE * concrete.area[None], concrete.area[None] / reach)
    found = solve_potentials(concrete, joint, Linear(rests[None], ohm_m2))
    spread = k / resistivity * (math.tanh(k * COVER) + math.tanh(k * (THICKNESS - COVER)))
    sheet = 0.2 / (1.0 + (ohm_m2 / SHARE + reach) * spread)
    expected = -0.3 + sheet / math.cosh(k * COVER) * np.sin(np.pi * u)
    assert np.abs(found.concrete[0] - expected).max() < 2e-3 * sheet
    assert 0.1 < sheet / 0.2 < 0.9, "neither the concrete nor the steel is all of the resistance"


def test_the_linear_solver_solves() -> None:
    u, v, d, steel = nodes(16)
    concrete = concrete_of(PIER, u, v, d, steel, rho(u[None, :], v[:, None]))
    rng = np.random.default_rng(3)
    grounding = rng.uniform(1e-6, 1e-2, concrete.area.shape)
    wanted = rng.standard_normal(concrete.diagonal.shape)
    load = outflow(concrete, wanted)
    load[steel] += grounding * wanted[steel]
    assert np.abs(solve_linear(concrete, grounding, load, 1e-12) - wanted).max() < 1e-8


def test_the_volumes_add_up_to_the_shell() -> None:
    u, v, d, steel = nodes(64)
    assert volume(PIER, u, v, d, steel).sum() == pytest.approx(
        0.5 * (0.8**2 - (0.8 - THICKNESS) ** 2) * (1.0 / 0.8), rel=1e-4
    )
    ball = (0.8**3 - (0.8 - THICKNESS) ** 3) / 3.0 * (1.0 / 0.8) * 2.0 * math.sin(0.5 / 0.8)
    assert volume(BALL, u, v, d, steel).sum() == pytest.approx(ball, rel=1e-3)


def volume(patch: Patch, u: Vector, v: Vector, d: Vector, steel: int) -> Matrix:
    return concrete_of(patch, u, v, d, steel, np.ones((len(v), len(u)))).volume


CURVED: dict[str, tuple[Patch, Callable[[Vector], Vector]]] = {
    "pier": (
        PIER,
        lambda q: np.array(
            [(0.8 - q[2]) * np.sin(q[0] / 0.8), q[1], (0.8 - q[2]) * np.cos(q[0] / 0.8)]
        ),
    ),
    "ball": (
        BALL,
        lambda q: (
            (0.8 - q[2])
            * np.array(
                [
                    np.cos(q[1] / 0.8) * np.sin(q[0] / 0.8),
                    np.sin(q[1] / 0.8),
                    np.cos(q[1] / 0.8) * np.cos(q[0] / 0.8),
                ]
            )
        ),
    ),
}


def rests_of(u: Vector, v: Vector) -> Matrix:
    return -0.15 - 0.4 * np.exp(-((u - 0.1) ** 2 + (v + 0.05) ** 2) / (2.0 * 0.15**2))


@pytest.mark.parametrize("name", CURVED)
def test_curved_concrete_agrees_with_finite_elements_in_space(name: str) -> None:
    """Linear steel in a curved shell: trilinear elements in x, y, z know nothing of our metric."""
    patch, into_space = CURVED[name]
    ohm_m2, resistivity, cells = 10.0, 250.0, 24
    u, v, d, steel = nodes(cells)
    concrete = concrete_of(patch, u, v, d, steel, np.full((len(v), len(u)), resistivity))
    rests = rests_of(u[None, :], v[:, None])
    joint = Joint(concrete.area[None], 1e4 * concrete.area[None])  # 1e-4 Ω·m² against 10
    ours = solve_potentials(concrete, joint, Linear(rests[None], ohm_m2)).concrete[0]

    flat = MeshHex.init_tensor(u, v, d)
    mesh = MeshHex(into_space(flat.p), flat.t)
    middles = flat.p[:, flat.facets].mean(axis=1)
    sheet = np.flatnonzero(np.abs(middles[2] - COVER) < 1e-9)
    basis = Basis(mesh, ElementHex1())
    faces = FacetBasis(mesh, ElementHex1(), facets=sheet)
    rest = basis.zeros()
    rest[basis.nodal_dofs[0]] = rests_of(flat.p[0], flat.p[1])
    stiffness = BilinearForm(lambda a, b, _: dot(grad(a), grad(b)) / resistivity)
    polarised = BilinearForm(lambda a, b, _: a * b / ohm_m2)
    driven = LinearForm(lambda b, w: w["rest"] * b / ohm_m2)
    load = asm(driven, faces, rest=faces.interpolate(rest))
    theirs = solve(asm(stiffness, basis) + asm(polarised, faces), load)
    surface = np.flatnonzero(flat.p[2] < 1e-9)
    i = np.rint((flat.p[1, surface] + 0.5) * cells).astype(int)
    j = np.rint((flat.p[0, surface] + 0.5) * cells).astype(int)
    difference = np.abs(ours[i, j] - theirs[basis.nodal_dofs[0][surface]])
    assert np.ptp(ours) > 0.1
    assert difference.max() < 0.01 * np.ptp(ours)


def test_the_constriction_is_that_of_a_round_bar() -> None:
    """The resistance from a bar to a plane half a spacing away, by finite elements in its section.

    A quarter of the section around the bar: circle to square, mapped. By symmetry no current passes
    the sides; the plane takes it all. The array's ripple at the plane is e^−π, 4 %.
    """
    bars = Bars(spacing_m=0.15, diameter_m=0.012, directions=1)
    s, radius = bars.spacing_m, 0.5 * bars.diameter_m
    mesh = MeshQuad.init_tensor(np.linspace(0.0, 1.0, 41), np.linspace(0.0, 1.0, 41))
    angle = 0.5 * np.pi * mesh.p[0]
    direction = np.array([np.cos(angle), np.sin(angle)])
    rim = 0.5 * s * direction / np.abs(direction).max(axis=0)
    out = radius * (np.hypot(*rim) / radius) ** mesh.p[1]
    curved = MeshQuad(out * direction, mesh.t)
    basis = Basis(curved, ElementQuad2())
    laplace = asm(BilinearForm(lambda a, b, _: dot(grad(a), grad(b))), basis)
    inner = basis.get_dofs(lambda x: np.hypot(*x) < radius * 1.01).all()
    top = basis.get_dofs(lambda x: x[1] > 0.5 * s - 1e-9).all()
    x = basis.zeros()
    x[inner] = 1.0
    x = solve(*condense(laplace, x=x, D=np.concatenate([inner, top])))
    current = float(x @ laplace @ x)  # A/m per V and S/m, through a quarter
    # Four quarters carry the bar's current; a sheet would send half of it to either plane, ρ I/4.
    found = 1.0 / (4.0 * current) - 0.25
    assert found == pytest.approx(constriction_m(bars) / s, rel=0.02)
    assert steel_share(bars) == pytest.approx(math.pi * 0.012 / 0.15)
    crossed = Bars(spacing_m=0.15, diameter_m=0.012, directions=2)
    assert steel_share(crossed) == 2.0 * steel_share(bars)
    assert constriction_m(crossed) == 0.5 * constriction_m(bars)


def test_a_network_has_no_loss() -> None:
    u, v, d, steel = nodes(8)
    concrete: Concrete = concrete_of(BALL, u, v, d, steel, rho(u[None, :], v[:, None]))
    flow = outflow(concrete, np.random.default_rng(1).standard_normal(concrete.diagonal.shape))
    assert abs(flow.sum()) < 1e-13 * np.abs(flow).sum()
