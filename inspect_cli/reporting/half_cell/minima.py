"""Tables of minima by the gradient criterion, and of places to read more closely."""

from __future__ import annotations

from inspect_cli.assessment.gradient import MOST_SCATTER_MV
from inspect_cli.reporting.content.blocks import Block, Column, Paragraph, Table
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, count, number, say, sentences, together
from inspect_cli.schema.assessment import GradientFindings, Minimum, RefinementFindings

PLACE = (
    Column("u", "m", numeric=True),
    Column("v", "m", numeric=True),
)


def gradient_blocks(found: GradientFindings) -> list[Block]:
    """The minima, how they rise, and which are judged active; or why there are none."""
    paragraph = sentences([judged(found), _not_judged(found), _depth(found)])
    if not found.steepest:
        return [Paragraph(paragraph, "note")]
    columns = [
        Column(say("Point")),
        *PLACE,
        Column(say("Potential"), "mV CSE", numeric=True),
        Column(say("Rise within 1 m"), "mV", numeric=True),
        Column(say("100 mV higher at"), "m", numeric=True),
        Column(say("Gradient criterion")),
    ]
    caption = sentences(
        [
            say(
                "Negative minima of the potential and how it rises around them (RILEM TC 154-EMC: "
                "100 mV within 1 m of a minimum indicates active corrosion)."
            ),
            _listed(len(found.steepest), found.minima),
        ]
    )
    return [Paragraph(paragraph), Table(caption, columns, [_minimum(m) for m in found.steepest])]


def judged(found: GradientFindings) -> Text:
    """The gradient criterion in one sentence."""
    if found.minima == 0:
        return say("The gradient criterion finds nothing to judge: {why}.", why=recorded(found.why))
    if found.minima == 1 and found.active:
        return say(
            "The one negative minimum rises by at least 100 mV within 1 m and indicates active "
            "corrosion by the gradient criterion (RILEM TC 154-EMC)."
        )
    if found.active == 0:
        return count(
            found.minima,
            "The gradient criterion (RILEM TC 154-EMC) does not call the one negative minimum "
            "active.",
            "The gradient criterion (RILEM TC 154-EMC) calls none of {n} negative minima active.",
        )
    return count(
        found.active,
        "One of {minima} negative minima rises by at least 100 mV within 1 m and indicates active "
        "corrosion by the gradient criterion (RILEM TC 154-EMC).",
        "Of {minima} negative minima {n} rise by at least 100 mV within 1 m and indicate active "
        "corrosion by the gradient criterion (RILEM TC 154-EMC).",
        minima=number(found.minima, 0),
    )


def _not_judged(found: GradientFindings) -> Text:
    if found.not_judged == 0:
        return say("{why}.", why=recorded(found.why)) if found.why and found.minima else ""
    return count(
        found.not_judged,
        "{n} has no other reading within 1 m and is not judged.",
        "{n} have no other reading within 1 m and are not judged.",
    )


def _depth(found: GradientFindings) -> Text:
    if found.scatter_mv is None and not found.minima:
        return ""  # why there is none was said
    if found.scatter_mv is None:
        return say(
            "A minimum counts if it is at least {depth} mV deep; how much a single reading "
            "scatters is not known of so few neighbours.",
            depth=number(found.least_depth_mv, 0),
        )
    if found.scatter_mv > MOST_SCATTER_MV:
        return say(
            "A minimum counts if it is at least {depth} mV deep: neighbours differ by more than "
            "readings scatter (standard deviation {sd} mV), so that the spacing is too coarse to "
            "tell scatter from corrosion.",
            depth=number(found.least_depth_mv, 0),
            sd=number(found.scatter_mv, 1),
        )
    return say(
        "A minimum counts if it is at least {depth} mV deep: a single reading scatters by {sd} mV "
        "around its neighbours (standard deviation), and scatter alone seldom makes a hollow "
        "deeper than that.",
        depth=number(found.least_depth_mv, 0),
        sd=number(found.scatter_mv, 1),
    )


def _minimum(found: Minimum) -> list[Text]:
    verdict: Text = say("active") if found.active else say("not active")
    if found.rise_mv is None:
        verdict = say("not judged")
    return [
        found.label,
        *(number(x, 3) for x in found.uv_m),
        number(found.potential_mv, 0),
        number(found.rise_mv, 0),
        number(found.rise_within_m, 2),
        verdict,
    ]


def _listed(shown: int, total: int) -> Text:
    if shown >= total:
        return ""
    return say("The {shown} steepest of {n}.", shown=number(shown, 0), n=number(total, 0))


def refinement_blocks(found: RefinementFindings) -> list[Block]:
    """Pairs of neighbours that differ too much for the spacing of the readings, or that none do."""
    if found.why:
        why = say("No closer spacing can be proposed: {why}.", why=recorded(found.why))
        return [Paragraph(why, "note")]
    if found.total == 0:
        nowhere = say(
            "No two neighbours differ by more than 150 mV: ASTM C876 asks for no closer spacing."
        )
        return [Paragraph(nowhere)]
    columns = [
        Column(say("Between")),
        *PLACE,
        Column(say("Difference"), "mV", numeric=True),
    ]
    rows: list[list[Text]] = [
        [
            together(p.between[0], " – ", p.between[1]),
            *(number(x, 3) for x in p.uv_m),
            number(p.difference_mv, 0),
        ]
        for p in found.greatest
    ]
    caption = sentences(
        [
            count(
                found.total,
                "Where to read more closely: {n} pair of neighbours differs by more than 150 mV "
                "(ASTM C876).",
                "Where to read more closely: {n} pairs of neighbours differ by more than 150 mV "
                "(ASTM C876).",
            ),
            _listed(len(found.greatest), found.total),
        ]
    )
    return [Table(caption, columns, rows)]
