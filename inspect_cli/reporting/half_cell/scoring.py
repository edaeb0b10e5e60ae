"""Confusion of the verdicts with the truth of a simulated survey; nothing for a real one."""

from __future__ import annotations

from inspect_cli.assessment.classes import SUSTAINS_CORROSION_OHM_M
from inspect_cli.reporting.content.blocks import Block, Column, Heading, Paragraph, Table
from inspect_cli.reporting.half_cell.class_chips import class_word
from inspect_cli.reporting.half_cell.classes import area, percent
from inspect_cli.reporting.words.text import NOTHING, Text, count, number, say, sentences
from inspect_cli.schema.scoring import Confusion, ConfusionRow, Rule, Scoring

CAPTIONS: dict[Rule, Text] = {
    "combined": say("The combined verdict against the truth of the simulation."),
    "astm": say("The class of the potential alone (ASTM C876) against the truth."),
}


def scoring_blocks(scoring: Scoring | None) -> list[Block]:
    """Both confusion matrices and what they mean, of all surfaces together."""
    if scoring is None:
        return []
    combined, astm = scoring.confusion("combined"), scoring.confusion("astm")
    return [
        Heading(say("Against the truth of the simulation")),
        Paragraph(
            sentences(
                [
                    _missed(combined),
                    _too_resistive(scoring),
                    _false(combined),
                    _sites(scoring),
                ]
            )
        ),
        _matrix(combined),
        _matrix(astm),
        Paragraph(
            say(
                "By the potential alone {missed} m² of the truly active area would be missed and "
                "{false} m² called active without need. A point stands for the square of one "
                "pitch around it.",
                missed=area(astm.missed_m2),
                false=area(astm.false_m2),
            )
        ),
    ]


def _matrix(confusion: Confusion) -> Table:
    columns = [
        Column(say("Verdict")),
        Column(say("truly active"), "m²", numeric=True),
        Column(say("truly sound"), "m²", numeric=True),
        Column(say("truly active"), say("points"), numeric=True),
        Column(say("truly sound"), say("points"), numeric=True),
    ]
    rows = [[class_word(row.verdict), *_cells(row)] for row in confusion.rows]
    total: list[Text] = [
        say("all"),
        area(confusion.active_m2),
        area(sum(row.sound_m2 for row in confusion.rows)),
        number(sum(row.active_points for row in confusion.rows), 0),
        number(sum(row.sound_points for row in confusion.rows), 0),
    ]
    return Table(CAPTIONS[confusion.rule], columns, [*rows, total])


def _cells(row: ConfusionRow) -> list[Text]:
    return [
        area(row.active_m2),
        area(row.sound_m2),
        number(row.active_points, 0),
        number(row.sound_points, 0),
    ]


def _missed(confusion: Confusion) -> Text:
    if confusion.active_m2 == 0.0:
        return say(
            "Nothing of the {region} m² that were measured corrodes in truth.",
            region=area(confusion.region_m2),
        )
    return say(
        "Of {active} m² over steel that truly corrodes, {missed} m² ({share}) were not called "
        "active by the combined rule.",
        active=area(confusion.active_m2),
        missed=area(confusion.missed_m2),
        share=percent(confusion.missed_m2 / confusion.active_m2),
    )


def _too_resistive(scoring: Scoring) -> Text:
    if scoring.too_resistive_m2 == 0.0:
        return ""
    return say(
        "Over {resistive} m² ({share}) of the truly active area the concrete truly has more than "
        "{limit} Ω·m: there the rule itself says possible at the most, whatever the potential. "
        "Such a place is found only if the point that stands for it lies beside it.",
        resistive=area(scoring.too_resistive_m2),
        share=percent(scoring.too_resistive_m2 / scoring.confusion().active_m2),
        limit=number(SUSTAINS_CORROSION_OHM_M, 0),
    )


def _false(confusion: Confusion) -> Text:
    sound_m2 = confusion.region_m2 - confusion.active_m2
    share = percent(confusion.false_m2 / sound_m2) if sound_m2 > 0.0 else NOTHING
    return say(
        "{false} m² ({share}) of the {sound} m² over sound steel were called active without need.",
        false=area(confusion.false_m2),
        share=share,
        sound=area(sound_m2),
    )


def _sites(scoring: Scoring) -> Text:
    if scoring.sites_total == 0:
        return ""
    return count(
        scoring.sites_total,
        "Of {n} corroding site {found} was found: at least one point within was called active.",
        "Of {n} corroding sites {found} were found: at least one point within was called active.",
        found=number(scoring.sites_found, 0),
    )
