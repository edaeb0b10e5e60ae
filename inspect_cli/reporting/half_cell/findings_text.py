"""The findings of an evaluation in sentences: areas, gradients, populations; and its method."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from inspect_cli.assessment.conditions import SATURATED
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.content.blocks import Facts
from inspect_cli.reporting.half_cell.basis import temperature_caveats
from inspect_cli.reporting.half_cell.classes import area, percent
from inspect_cli.reporting.half_cell.minima import judged
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, count, number, say
from inspect_cli.schema.assessment import MixtureFindings, SurfaceAssessment

SPECIALIST = say(
    "ASTM C876 leaves the interpretation to a specialist who also knows the chloride content, "
    "the depth of carbonation, delamination, the rate of corrosion and the exposure of the "
    "structure. Potentials alone do not give the rate or the loss of steel."
)
CONCRETE = say(
    "The class boundaries hold for uncoated steel in concrete that is not saturated; very dry, "
    "carbonated or water-saturated concrete and coated bars shift the potentials."
)
COVER = say(
    "Under more than 75 mm of cover a reading averages neighbouring bars, and a small corroding "
    "place may not show; very dry concrete, coated bars and sealed surfaces may give no reading "
    "at all."
)
CONTINUITY = say(
    "A potential tells of the steel that the voltmeter is connected to: the bars have to be "
    "connected with each other. Stray currents, cathodic protection and zinc or prestressing steel "
    "change potentials without telling of corrosion."
)
CALIBRATION = say(
    "Fixed class boundaries alone decide nothing: populations and gradients stand beside them, and "
    "openings at some of the places show what is so."
)
RESISTIVITY = say(
    "Resistivities are as measured; their classes are for Portland cement concrete at 20 °C. Cold "
    "or dry concrete has a higher resistivity, warm or wet concrete a lower one."
)
VALIDITY = say(
    "A reading is valid only after sufficient force for sufficient time and a stable "
    "potential. Invalid points are shown as such, never as values, and enter no statistics."
)
AT_ITS_TIME = say(
    "The findings hold for the time of the measurement and for the places that were read; moisture "
    "and temperature change the potentials. What lies between the readings is interpolated."
)


def area_sentences(evaluated: Sequence[SurfaceFindings]) -> list[Text]:
    """How much of each surface is active."""
    return _by_surface(evaluated, _areas)


def gradient_and_population_sentences(evaluated: Sequence[SurfaceFindings]) -> list[Text]:
    """What gradients and populations of each surface tell."""
    return _by_surface(evaluated, _gradient_and_populations)


def _by_surface(
    evaluated: Sequence[SurfaceFindings], statements: Callable[[SurfaceAssessment], Iterable[Text]]
) -> list[Text]:
    """The sentences of each surface that has a valid reading, under its name if there are more."""
    found: list[Text] = []
    for e in evaluated:
        own = list(statements(e.assessed.summary)) if e.assessed.summary.valid else []
        if own and len(evaluated) > 1:
            found.append(say("Surface “{surface}”:", surface=e.surface))
        found += own
    return found


def _areas(summary: SurfaceAssessment) -> Iterator[Text]:
    if summary.area_m2:
        active = next(share for share in summary.astm if share.name == "active")
        potential = {
            "active": area(active.area_m2),
            "all": area(summary.area_m2),
            "share": percent((active.area_m2 or 0.0) / summary.area_m2),
        }
        if summary.resistivity_known == 0:
            yield say(
                "{active} m² of the {all} m² that were measured ({share}) are active by their "
                "potential (ASTM C876).",
                **potential,
            )
            return
        combined = next(share for share in summary.verdicts if share.name == "active")
        yield say(
            "{active} m² of the {all} m² that were measured ({share}) are active by their "
            "potential (ASTM C876), {combined} m² by the combined rule.",
            combined=area(combined.area_m2),
            **potential,
        )


def _gradient_and_populations(summary: SurfaceAssessment) -> Iterator[Text]:
    yield from _saturated(summary)
    yield judged(summary.gradient)
    yield _populations(summary.mixture)


def _saturated(summary: SurfaceAssessment) -> Iterator[Text]:
    """Potentials so negative that steel may be passive and only without oxygen."""
    n = next(c.count for c in summary.conditions if c.name == SATURATED)
    if n:
        yield count(
            n,
            "{n} potential is typical of water-saturated concrete without oxygen (RILEM TC "
            "154-EMC), in which steel is that negative without corroding.",
            "{n} potentials are typical of water-saturated concrete without oxygen (RILEM TC "
            "154-EMC), in which steel is that negative without corroding.",
        )


def _populations(mixture: MixtureFindings) -> Text:
    if mixture.verdict is None:
        return say("Populations were not separated: {why}.", why=recorded(mixture.why))
    if mixture.active is None or mixture.passive is None:
        return say("The potentials are of one population: {why}.", why=recorded(mixture.why))
    share, mean = percent(mixture.active.share), number(mixture.active.mean_mv, 0)
    if mixture.threshold_mv is None:
        return say(
            "The potentials are of two populations; the more negative one has {share} of them "
            "around {mean} mV.",
            share=share,
            mean=mean,
        )
    return say(
        "The potentials are of two populations; the more negative one has {share} of them around "
        "{mean} mV, and they part at {threshold} mV.",
        share=share,
        mean=mean,
        threshold=number(mixture.threshold_mv, 0),
    )


def reading_caveats(evaluated: Sequence[SurfaceFindings], *, probed: bool = True) -> list[Text]:
    """What the standard wants to be said beside its numbers.

    Args:
        evaluated: the surfaces; what is said of electrode and temperature follows from them.
        probed: whether a probe's rule decided which readings are valid, as in a flight.
    """
    known = any(e.assessed.summary.resistivity_known for e in evaluated)
    return [
        *(SPECIALIST, CALIBRATION, CONCRETE, COVER, CONTINUITY),
        *temperature_caveats(evaluated),
        *([RESISTIVITY] if known else []),
        *([VALIDITY] if probed else []),
        AT_ITS_TIME,
    ]


def evaluation_method() -> Facts:
    """How the readings were evaluated, step by step with its source."""
    return Facts(
        [
            (
                say("Classes"),
                say("numeric magnitude technique of ASTM C876; −200 and −350 mV belong to between"),
            ),
            (
                say("Areas"),
                say(
                    "a point stands for what is nearer to it than to any other, on a grid for one "
                    "field of it, so the area reaches half a spacing beyond the outer points; an "
                    "invalid point keeps its area"
                ),
            ),
            (
                say("Map"),
                say("ordinary kriging with a fitted variogram; the standard error is mapped too"),
            ),
            (
                say("Gradient criterion"),
                say(
                    "RILEM TC 154-EMC: a minimum is active where the potential rises by 100 mV "
                    "within 1 m; that a minimum is at least 20 mV deep, and deeper than scatter "
                    "makes one, is the project's own choice"
                ),
            ),
            (
                say("Populations"),
                say(
                    "two normal ones by maximum likelihood where they lower the BIC by more than "
                    "10 against a single one; at least 20 readings, 5 in the smaller one"
                ),
            ),
            (
                say("Uncertainty"),
                say(
                    "reading, repeatability and temperature by their squares (GUM); the class of a "
                    "point is in doubt below 95 %"
                ),
            ),
        ]
    )


def few_readings(read: int) -> list[Text]:
    """What has to be said of a small number of valid readings."""
    if not 0 < read < 20:
        return []
    return [say("With fewer than 20 valid readings, shares and cumulative frequencies are coarse.")]
