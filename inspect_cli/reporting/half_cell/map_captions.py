"""Captions of the maps of a surface."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inspect_cli.assessment.hull import LARGEST_GAP
from inspect_cli.assessment.kriging import NEIGHBOURS, KrigedMap
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.assessment.variogram import Variogram
from inspect_cli.reporting.half_cell.isolines import step_of
from inspect_cli.reporting.half_cell.potential_scale import ACTIVE_BELOW_MV, PASSIVE_ABOVE_MV
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, number, say, sentences, significant


def map_caption(evaluated: SurfaceFindings, drawn: int, crosses: int, most_signs: int) -> Text:
    """Caption of the map: what it shows, how it was made, and what it leaves out.

    Args:
        evaluated: the surface.
        drawn: how many valid readings are drawn one by one.
        crosses: the same of invalid ones.
        most_signs: of minima and of proposals.
    """
    first = say(
        "Half-cell potential on surface “{surface}” in mV against copper/copper sulphate, seen "
        "from outside (on a wall u runs to the right, v up).",
        surface=evaluated.surface,
    )
    return sentences(
        [
            first,
            *_of_the_map(evaluated),
            *_of_the_readings(evaluated, drawn, crosses),
            *_of_the_signs(evaluated, most_signs),
        ]
    )


def _of_the_map(evaluated: SurfaceFindings) -> Iterator[Text]:
    kriged = evaluated.map
    if not isinstance(kriged, KrigedMap):
        yield say("No contours are drawn: {why}.", why=recorded(kriged.why))
        return
    yield say(
        "Lines of equal potential every {step} mV; the heavy ones are the class boundaries, "
        "{active} and {passive} mV.",
        step=significant(step_of(kriged)),
        active=number(ACTIVE_BELOW_MV, 0),
        passive=number(PASSIVE_ABOVE_MV, 0),
    )
    yield interpolation(kriged)


def interpolation(kriged: KrigedMap) -> Text:
    """How the map was interpolated."""
    return say(
        "Interpolated by ordinary kriging from the nearest {most} of {n} readings at most, "
        "{variogram}; nothing is drawn outside the measured area or across gaps wider than "
        "{gap} spacings of the readings.",
        most=number(NEIGHBOURS, 0),
        n=number(kriged.readings, 0),
        variogram=_variogram(kriged.variogram),
        gap=significant(LARGEST_GAP),
    )


def _variogram(variogram: Variogram) -> Text:
    values = {
        "nugget": _plain(1e6 * variogram.nugget_v2),
        "sill": _plain(1e6 * variogram.scale_v2),
        "length": _plain(variogram.length_m),
    }
    if variogram.model == "power":
        return say(
            "power variogram (nugget {nugget} mV², {sill} mV² at {length} m, exponent {exponent})",
            **values,
            exponent=number(variogram.exponent, 2),
        )
    if variogram.model == "exponential":
        return say(
            "exponential variogram (nugget {nugget} mV², partial sill {sill} mV², range {length} "
            "m)",
            **values,
        )
    return say(
        "spherical variogram (nugget {nugget} mV², partial sill {sill} mV², range {length} m)",
        **values,
    )


def _plain(value: float) -> Text:
    """At least three significant digits, without a power of ten for numbers of 1 or more."""
    return number(value, 0) if abs(value) >= 100.0 else significant(value, 3)


def _of_the_readings(evaluated: SurfaceFindings, drawn: int, crosses: int) -> Iterator[Text]:
    summary = evaluated.assessed.summary
    if drawn < summary.valid and drawn:
        yield say(
            "Of {n} readings {drawn} are drawn, evenly spread and with both extremes.",
            n=number(summary.valid, 0),
            drawn=number(drawn, 0),
        )
    elif drawn < summary.valid:
        yield say(
            "The {n} readings themselves are too many to be drawn one by one; all are in "
            "readings.csv.",
            n=number(summary.valid, 0),
        )
    if crosses:
        yield say("Crosses are invalid readings; they carry no value.")
    if crosses < summary.invalid:
        yield say(
            "Of {n} invalid readings {drawn} are drawn.",
            n=number(summary.invalid, 0),
            drawn=number(crosses, 0),
        )


def _of_the_signs(evaluated: SurfaceFindings, most: int) -> Iterator[Text]:
    active = int(np.count_nonzero(evaluated.assessed.minima.is_active))
    proposals = len(evaluated.assessed.steps.pairs)
    if active:
        yield say("Open triangles: minima that the gradient criterion calls active.")
    if proposals:
        yield say(
            "Open plus signs: neighbours differ there by more than 150 mV, and ASTM C876 asks for "
            "a closer spacing."
        )
    if max(active, proposals) > most:
        yield say("Of each, the {n} steepest are drawn.", n=number(most, 0))


def error_caption(evaluated: SurfaceFindings, kriged: KrigedMap) -> Text:
    """Caption of the map of standard errors."""
    error_mv = 1e3 * kriged.standard_error_v
    return say(
        "Standard error of the interpolated potential on surface “{surface}”, {least} to {most} "
        "mV: between the readings and at the edge the map is less sure than at them. A further "
        "reading would differ from the map by this and by its own measurement error.",
        surface=evaluated.surface,
        least=number(float(np.nanmin(error_mv)), 1),
        most=number(float(np.nanmax(error_mv)), 1),
    )
