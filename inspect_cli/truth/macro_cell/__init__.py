"""The potential field of corroding reinforcement, solved in the concrete under a surface.

In the concrete, with the resistivity ρ and the potential φ against the grounded steel,

    ∇·(ρ⁻¹ ∇φ) = 0,      insulated outer faces,      reading E = −φ at the surface

so that E obeys the same equation. At the steel, E is its potential against the concrete before it,
and the net anodic current density i(E) leaves it into the concrete (``steel``). The mat of bars is
a sheet at the depth of the cover, joined to the concrete through the constriction of the current
around its bars (``mat``). Surface coordinates and their metric: ``patch``; finite volumes:
``concrete``; Newton's method: ``newton``; from the mission's words to the field: ``solution``.

What to expect of it (2 m × 2 m, the defaults of the schema): deeper cover flattens the minimum. The
higher the resistivity, the more negative are the anode's bars and the narrower is the dip. At the
surface a site that is wide against its cover gets more negative with it (radius 15 cm under 3 cm:
−542 mV at 20 Ω·m, −592 mV at 3000 Ω·m), a narrow one does not (5 cm: −415 and −398 mV), because
less of its potential reaches the surface.

What it cannot show: a passive place that looks active because it lacks oxygen. All passive steel
has one polarisation curve, whose anodic branch changes with the potential, and is joined by the
mat. Where a spot of it is starved, the rest of the mat feeds it with a current of less than 0.2
mA/m² and holds it up: in a wall of 0.8 m × 0.8 m with 200 Ω·m a spot without oxygen, of a
standard deviation of 0.3 m, reads 1 mV below the rest (2 mV with 2000 Ω·m). Only a wall that is
starved all over falls to its starved rest (``steel``). So false alarms of saturated concrete at
single places, which practice knows, do not come from this model, and its false areas are those of
fields that reach beyond their sites.

Source of the formulation: Kranc & Sagüés, "Detailed modeling of corrosion macrocells on steel
reinforcing in concrete", Corrosion Science 43 (2001) 1355–1372.
"""
