"""Electrode, temperature and uncertainty of the potentials."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.assessment.findings import disagreement
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.content.blocks import Block, Column, Facts, Paragraph, Table
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Text,
    count,
    number,
    say,
    sentences,
    significant,
)
from inspect_cli.schema.assessment import (
    Basis,
    RepeatabilityFindings,
    SurfaceAssessment,
    UncertaintyFindings,
)


def basis_facts(summary: SurfaceAssessment) -> Facts:
    """How readings of the voltmeter became potentials against CSE at the standard's temperature."""
    basis = summary.basis
    correction: Text = say("{mv} mV added", mv=number(basis.temperature_correction_mv, 1))
    if basis.temperature_correction_mv == 0.0:
        correction = say("none: {why}", why=recorded(basis.temperature_why))
    temperature: Text = say("not known")
    if basis.temperature_c is not None:
        temperature = say("{celsius} °C", celsius=significant(basis.temperature_c, 4))
    if basis.own_temperatures_c and basis.own_corrections_mv:
        temperature = _span(basis.own_temperatures_c, "°C", 1)
        correction = say(
            "each reading by its own: {span}", span=_span(basis.own_corrections_mv, "mV", 1)
        )
    conversion: Text = say("none: it is the standard's own electrode")
    if basis.conversion_mv != 0.0:
        conversion = say("{mv} mV added", mv=number(basis.conversion_mv, 1))
    repeated = count(
        basis.merged_readings,
        "{n} reading was made one with another at its place",
        "{n} readings were made one with others at their places",
    )
    return Facts(
        [
            (say("Reference electrode, as read"), basis.electrode),
            (say("Conversion to CSE"), conversion),
            (say("Temperature"), temperature),
            (say("Correction to 22.2 °C"), correction),
            (say("Repeated readings"), repeated if basis.merged_readings else say("none")),
        ]
    )


def temperature_caveats(evaluated: Sequence[SurfaceFindings]) -> list[Text]:
    """What potentials are against and what was done about temperature, once for each basis."""
    bases: list[Basis] = []
    for e in evaluated:
        basis = e.assessed.summary.basis.model_copy(update={"merged_readings": 0})
        if basis not in bases:
            bases.append(basis)
    return [_caveat(basis) for basis in bases]


def _caveat(basis: Basis) -> Text:
    statements: list[Text] = []
    if basis.conversion_mv != 0.0:
        statements.append(
            say(
                "Potentials were read against {electrode} and are given against copper/copper "
                "sulphate (CSE): {mv} mV were added.",
                electrode=basis.electrode,
                mv=number(basis.conversion_mv, 1),
            )
        )
    else:
        statements.append(say("Potentials are against copper/copper sulphate (CSE)."))
    if basis.own_temperatures_c and basis.own_corrections_mv:
        statements.append(
            say(
                "Each was corrected by its own temperature ({temperatures}), which added "
                "{corrections}; readings whose temperature is not known: {n}, not corrected.",
                temperatures=_span(basis.own_temperatures_c, "°C", 1),
                corrections=_span(basis.own_corrections_mv, "mV", 1),
                n=number(basis.without_temperature, 0),
            )
        )
    elif basis.temperature_correction_mv != 0.0:
        statements.append(
            say(
                "They were corrected by {mv} mV from {celsius} °C to 22.2 °C (ASTM C876).",
                mv=number(basis.temperature_correction_mv, 1),
                celsius=significant(basis.temperature_c, 4),
            )
        )
    else:
        why = recorded(basis.temperature_why)
        statements.append(say("They are not corrected for temperature: {why}.", why=why))
    return sentences(statements)


def _span(ends: tuple[float, float], unit: str, digits: int) -> Text:
    low, high = (number(end, digits) for end in ends)
    return say("{low} to {high} {unit}", low=low, high=high, unit=unit)


def uncertainty_blocks(summary: SurfaceAssessment) -> list[Block]:
    """The budget of the standard uncertainty, and how many classes are in doubt."""
    found = summary.uncertainty
    if found.why:
        why = say("No uncertainty is stated: {why}.", why=recorded(found.why))
        return [Paragraph(why, "note")]
    columns = [Column(say("Contribution"), prose=True), Column("u", "mV", numeric=True)]
    rows: list[list[Text]] = [
        [say("reading itself (noise, drift, wetting, load of the meter)"), _mv(found.reading_mv)],
        [say("repeatability of a place's mean"), _mv(found.repeatability_mv)],
        *([[say("conversion to CSE"), _mv(found.conversion_mv)]] if found.conversion_mv else []),
        [say("temperature"), _mv(found.temperature_mv)],
        [say("together, median of the points"), _mv(found.median_mv)],
        [say("together, least certain point"), _mv(found.max_mv)],
    ]
    caption = say(
        "Standard uncertainty of a point's potential, medians over the valid points; independent "
        "contributions are added by their squares (GUM)."
    )
    paragraph = sentences([_repeatability(found, summary.repeatability), _doubtful(found)])
    return [Table(caption, columns, rows), Paragraph(paragraph)]


def _mv(value: float | None) -> Text:
    return NOTHING if value is None else number(value, 1)


def _repeatability(found: UncertaintyFindings, repeated: RepeatabilityFindings) -> Text:
    single = say(
        "A single reading scatters by {sd} mV (standard deviation; {source}).",
        sd=number(found.single_reading_mv, 1),
        source=recorded(found.single_reading_from),
    )
    if repeated.sd_mv is None:
        return sentences(
            [single, say("Of the survey's own repeatability: {why}.", why=recorded(repeated.why))]
        )
    own = count(
        repeated.places,
        "{n} place was read more than once: standard deviation {sd} mV with {freedom}.",
        "{n} places were read more than once: pooled standard deviation {sd} mV with {freedom}, "
        "{greatest} mV at the worst place.",
        sd=number(repeated.sd_mv, 1),
        freedom=count(
            repeated.degrees_of_freedom, "{n} degree of freedom", "{n} degrees of freedom"
        ),
        greatest=number(repeated.greatest_sd_mv, 1),
    )
    apart = [recorded(warning) for warning in disagreement(repeated)]
    return sentences([single, own, *apart])


def _doubtful(found: UncertaintyFindings) -> Text:
    return count(
        found.doubtful,
        "The class of {n} point by ASTM C876 is less than 95 % certain.",
        "The classes of {n} points by ASTM C876 are less than 95 % certain.",
    )
