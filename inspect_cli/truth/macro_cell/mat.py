"""A mat of bars as a sheet: how much steel it has, and how narrow the way to the steel is.

Bars of diameter D, a distance s apart, in m directions, have the surface

    a = m π D / s      per area of the mat.

Far from parallel bars their field is that of a sheet with the same current; at the bars it differs
by the constriction of the current. An array of line sources of I (A/m) at z = 0 has the potential

    φ(x, z) = −(ρ I / 4π) ln[2 cosh(2πz/s) − 2 cos(2πx/s)]

(Maxwell, A Treatise on Electricity and Magnetism, §203, for a grating of parallel wires). Far away
it tends to the sheet's, −(ρ I / 2s) |z|; at a bar, x² + z² = D²/4, it is (ρ I / 2π) ln(s / πD). The
sheet carries j = m I / s, so that bars are reached through

    r = ρ s ln(s / πD) / (2π m)      Ω·m² of the mat

(crossing layers are taken to lie apart, each with its share of the current). What the sheet leaves
out is the ripple from bar to bar. At the surface, a cover c above, it is about ρ I / π · e^(−2πc/s)
(twice the leading term of φ, for the insulated surface reflects it), below 1 mV over passive steel
(1 mA/m², 200 Ω·m) at c = 40 mm and s = 150 mm, some mV over a site that corrodes fast.
"""

from __future__ import annotations

import math

from inspect_cli.schema.specimens.macro_cell import Bars


def steel_share(bars: Bars) -> float:
    """Surface of the steel per area of the mat."""
    return bars.directions * math.pi * bars.diameter_m / bars.spacing_m


def constriction_m(bars: Bars) -> float:
    """r / ρ, in m: resistance from the mat as a sheet to its bars, per ρ, for 1 m² of the mat."""
    ratio = bars.spacing_m / (math.pi * bars.diameter_m)
    return bars.spacing_m * math.log(ratio) / (2.0 * math.pi * bars.directions)
