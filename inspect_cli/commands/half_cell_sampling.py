"""Half-cell readings that are simulated without a flight, for the study of the pitch."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inspect_cli.assessment.classes import astm_class, combined_verdict, resistivity
from inspect_cli.assessment.electrodes import as_evaluated
from inspect_cli.commands.pitch_sampling import GridWork
from inspect_cli.metrics.assessed import basis_on
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.scoring import UNREAD
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.sensing.half_cell import steady_readings
from inspect_cli.spatial.arrays import Vector


def half_cell_verdicts(
    loaded: Loaded,
    work: GridWork,
    potential_v: Vector,
    resistivity_ohm_m: Vector,
    rng: np.random.Generator,
) -> Iterator[tuple[str, str]]:
    """By the combined rule and by ASTM C876: see ``pitch_sampling.Verdicts``.

    The values are those of the probe's own model in firm contact, its noise included.
    """
    probe = loaded.platform.sensor(HalfCellModel)
    basis = basis_on(loaded.mission, work.on, probe.electrode)
    volts, ohms = steady_readings(
        probe,
        as_evaluated(potential_v, basis),
        resistivity_ohm_m,
        probe.rate_hz,
        work.dwell_s,
        rng,
    )
    for volt, ohm in zip(volts.tolist(), ohms.tolist(), strict=True):
        if not np.isfinite(volt):
            yield UNREAD, UNREAD
            continue
        rho = resistivity(ohm, probe.cell_constant_m)
        yield combined_verdict(volt, rho) or UNREAD, astm_class(volt) or UNREAD
