"""Simulated half-cell probe with its load cell.

In contact (true normal force above 0.05 N), with the specimen's potential E and resistivity ρ
under the tip, t the wetted time, τ the wetting time and k the cell constant:

    potential  = E + s + dry_offset e^(−t/τ) + σ_E n₁
    resistance = ρ/k (1 + e^(−t/τ) + max(0, 1 − F/F_min)) (1 + σ_R n₂)

with s = 0 for a copper sulphate electrode, against which E is; else s is the other electrode's
difference from it at the concrete's temperature (``assessment.electrodes``).

Both excesses of the resistance are a stated choice: a contact that is not wetted yet, or that is
pressed with less than F_min, has a smaller effective area. Wetted time counts the contact and is
lost with the time constant ``DRYING_S`` while the probe is lifted, so each point starts dry and a
bounce does not.

Out of contact, or where there is no specimen, the circuit is open: the input of at least 10 MΩ
(ASTM C876, section 6) floats and the ohmmeter is over range. The load cell always measures.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, TypeVar

import numpy as np

from inspect_cli.assessment.electrodes import electrode_shift_v
from inspect_cli.records import Probe
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.sensing.instrument import Noise, Surroundings
from inspect_cli.spatial.arrays import Vector
from inspect_cli.truth.snapshot import Truth

TOUCH_N: Final = 0.05
"""True normal force from which the electrode touches."""
DRYING_S: Final = 0.5
"""Time constant with which a lifted contact loses its wetted time."""
OVER_RANGE_OHM: Final = 1e9
"""What the ohmmeter shows over range; a number, so that it can be logged."""
FLOATING_V: Final = 0.2
"""Standard deviation of an open input's potential around zero."""
FLOATING_S: Final = 0.3
"""Time constant of its wandering."""


Number = TypeVar("Number", float, Vector)


def shown_potential(
    model: HalfCellModel, potential: Number, dryness: Number, noise: Number
) -> Number:
    """The voltmeter's value, V, in contact; ``dryness`` is e^(−t/τ)."""
    return potential + (model.dry_offset_v * dryness + model.potential_noise_v * noise)


def shown_resistance(
    model: HalfCellModel, resistivity: Number, dryness: Number, lightness: float, noise: Number
) -> Number:
    """The ohmmeter's value, Ω, in contact; ``lightness`` is max(0, 1 − F/F_min)."""
    resistance = resistivity / model.cell_constant_m * (1.0 + dryness + lightness)
    return resistance * (1.0 + model.resistance_noise * noise)


def steady_readings(
    model: HalfCellModel,
    potential: Vector,
    resistivity: Vector,
    rate_hz: float,
    dwell_s: float,
    rng: np.random.Generator,
) -> tuple[Vector, Vector]:
    """What readings of a firm contact come to, without a flight: (n,) V and (n,) Ω.

    The medians over the last ``stable_s`` of the dwell, as the judge of readings takes them.
    NaN where the specimen has no values. Potentials stay against what they are given against.
    """
    count = max(1, round(model.stable_s * rate_hz))
    wetted_s = max(dwell_s, model.min_contact_s) - np.arange(count)[:, None] / rate_hz
    dryness = np.exp(-np.maximum(wetted_s, 0.0) / model.wetting_s)
    noise = rng.standard_normal((2, count, len(potential)))
    volts = shown_potential(model, potential, dryness, noise[0])
    ohms = shown_resistance(model, resistivity, dryness, 0.0, noise[1])
    return np.median(volts, axis=0), np.median(ohms, axis=0)


class HalfCellProbe:
    """Potential, resistance and force at the tool's tip."""

    def __init__(
        self,
        model: HalfCellModel,
        rng: np.random.Generator,
        temperatures_c: Sequence[float] = (),
    ) -> None:
        """``temperatures_c`` is that of the concrete of each surface by its index; else 22.2."""
        self.measurement = Probe.create()
        self._model = model
        self._shift_v = electrode_shift_v(model.electrode)
        self._shifts_v = [electrode_shift_v(model.electrode, t) for t in temperatures_c]
        self._noise = Noise(rng, 4)
        self._t = 0.0
        self._wetted_s = 0.0
        self._floating_v = 0.0

    def sample(self, truth: Truth) -> Probe:
        """Measure now."""
        t, force = truth.state.t_s, truth.state.f_normal
        dt, self._t = t - self._t, t
        noise = self._noise.draw().tolist()
        self._float(dt, noise[3])
        measurement = self.measurement
        measurement.t_s = t
        measurement.force = force + self._model.force_noise_n * noise[2]
        measurement.potential = self._floating_v
        measurement.resistance = OVER_RANGE_OHM
        if not force > TOUCH_N:
            self._wetted_s *= math.exp(-dt / DRYING_S)
            return measurement
        self._wetted_s += dt
        contact = truth.contact()
        potential, resistivity = contact.potential, contact.resistivity
        if math.isnan(potential) or math.isnan(resistivity):
            return measurement
        dryness = math.exp(-self._wetted_s / self._model.wetting_s)
        lightness = max(0.0, 1.0 - force / self._model.min_force_n)
        potential += self._shift_on(int(contact.surface))
        measurement.potential = shown_potential(self._model, potential, dryness, noise[0])
        resistance = shown_resistance(self._model, resistivity, dryness, lightness, noise[1])
        measurement.resistance = min(max(0.0, resistance), OVER_RANGE_OHM)
        return measurement

    def _shift_on(self, surface: int) -> float:
        """From CSE to the probe's electrode on a surface, V."""
        return self._shifts_v[surface] if 0 <= surface < len(self._shifts_v) else self._shift_v

    def _float(self, dt: float, noise: float) -> None:
        """Let the open input wander: an Ornstein–Uhlenbeck process."""
        keep = math.exp(-dt / FLOATING_S)
        spread = FLOATING_V * math.sqrt(1.0 - keep * keep)
        self._floating_v = keep * self._floating_v + spread * noise


def half_cell_probe(model: HalfCellModel, around: Surroundings) -> HalfCellProbe:
    """The probe of a flight."""
    return HalfCellProbe(model, around.rng, around.structure.temperatures_c)
