"""Tables of classes: ASTM C876, the combined verdict, resistivity, and potential against
resistivity."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.classes import COMBINED_RULE
from inspect_cli.reporting.content.blocks import Block, Column, Paragraph, Table
from inspect_cli.reporting.half_cell.class_chips import class_chip
from inspect_cli.reporting.words.naming import named
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Said,
    Text,
    number,
    say,
    sentences,
    significant,
    strong,
    together,
)
from inspect_cli.schema.assessment import ClassShare, Crossed, SurfaceAssessment

ASTM_ROWS: dict[str, tuple[Text, Text]] = {
    "passive": ("E > −200 mV", say("more than 90 % that no reinforcement corrodes")),
    "uncertain": ("−350 mV ≤ E ≤ −200 mV", say("not decided by the potential")),
    "active": ("E < −350 mV", say("more than 90 % that reinforcement corrodes")),
}
RATE_LIMITS = ("ρ > 200", "100 < ρ ≤ 200", "50 ≤ ρ ≤ 100", "ρ < 50")
RISK_LIMITS = ("ρ ≥ 1000", "500 ≤ ρ < 1000", "100 < ρ < 500", "ρ ≤ 100")
AREA_DECIMALS = ((100.0, 1), (10.0, 2), (1.0, 3))
COUNTED = (
    Column(say("Points"), numeric=True),
    Column(say("Share"), numeric=True),
    Column(say("Area"), "m²", numeric=True),
)


def counted(share: ClassShare) -> list[Text]:
    """Points, share and area of a class; without any point there is no share."""
    return [number(share.count, 0), percent(share.share), area(share.area_m2)]


def percent(share: float | None) -> Text:
    """A share in per cent, to a tenth."""
    return NOTHING if share is None else together(number(100.0 * share, 1), " %")


def area(area_m2: float | None) -> Text:
    """An area, m², to the square centimetre if it is small and to the square metre if it is
    large."""
    if not area_m2:
        return number(area_m2, 0)
    return number(area_m2, next((n for least, n in AREA_DECIMALS if area_m2 >= least), 4))


def classes_table(summary: SurfaceAssessment) -> Table:
    """How much of the surface is in each class of ASTM C876."""
    rows: list[list[Text]] = []
    for share in summary.astm:
        what: list[Text] = [class_chip(share.name), *ASTM_ROWS[share.name]]
        rows.append([*what, *counted(share)])
    not_counted = say("no value; not counted in the shares")
    lost: list[Text] = [number(summary.invalid, 0), NOTHING, area(summary.invalid_area_m2)]
    rows.append([say("invalid"), NOTHING, not_counted, *lost])
    columns = [
        Column(say("Class")),
        Column(say("Potential against CSE")),
        Column(say("Probability at the time of measurement"), prose=True),
        *COUNTED,
    ]
    caption = say("Classes of ASTM C876 (numeric magnitude technique).")
    return Table(sentences([caption, _of_the_area(summary)]), columns, rows)


def _of_the_area(summary: SurfaceAssessment) -> Text:
    if summary.area_m2 is None:
        return say("No area is stated: {why}.", why=recorded(summary.area_why))
    if summary.spacing_m is None:
        return ""
    u, v = summary.spacing_m
    return say(
        "A point stands for what is nearer to it than to any other point, {u} m × {v} m at most "
        "places; {area} m² in all.",
        u=significant(u, 4),
        v=significant(v, 4),
        area=area(summary.area_m2),
    )


def verdict_blocks(assessed: Assessed) -> list[Block]:
    """The combined verdict: its table, with the points that it names, and its rule."""
    if assessed.summary.resistivity_known == 0:
        return []
    labels = assessed.readings.labels
    rows: list[list[Text]] = []
    for code, share in enumerate(assessed.summary.verdicts):
        own = [str(label) for label in labels[np.flatnonzero(assessed.verdict == code)]]
        rows.append([class_chip(share.name), *counted(share), named(own)])
    columns = [Column(say("Corrosion")), *COUNTED, Column(say("Places"), prose=True)]
    caption = say("Combined verdict of potential and resistivity.")
    rule = sentences([strong(say("Rule of the combined verdict.")), Said(COMBINED_RULE)])
    return [Table(caption, columns, rows), Paragraph(rule, "rule")]


def resistivity_blocks(summary: SurfaceAssessment) -> list[Block]:
    """Classes of resistivity by two scales, and how they meet those of the potential."""
    if summary.resistivity_known == 0:
        return [
            Paragraph(
                say(
                    "No resistivity is known: neither its classes nor how fast steel corrodes can "
                    "be told, and the combined verdict is “possible” at the most."
                ),
                "note",
            )
        ]
    scales: Sequence[tuple[Text, tuple[ClassShare, ...], tuple[str, ...]]] = (
        (say("corrosion rate, Langford & Broomfield"), summary.rates, RATE_LIMITS),
        (say("corrosion risk, RILEM TC 154-EMC"), summary.risks, RISK_LIMITS),
    )
    rows: list[list[Text]] = [
        [scale, recorded(share.name), limits, *counted(share)]
        for scale, shares, all_limits in scales
        for share, limits in zip(shares, all_limits, strict=True)
    ]
    columns = [
        Column(say("Scale"), prose=True),
        Column(say("Class")),
        Column(say("Resistivity"), "Ω·m"),
        *COUNTED,
    ]
    caption = say(
        "Classes of resistivity of {known} of {n} points. 10 Ω·m are 1 kΩ·cm.",
        known=number(summary.resistivity_known, 0),
        n=number(summary.points, 0),
    )
    return [Table(caption, columns, rows), *_crossed_tables(summary)]


def _crossed_tables(summary: SurfaceAssessment) -> list[Block]:
    return [
        _crossed(
            say(
                "Points by potential (ASTM C876) and by the corrosion rate that their resistivity "
                "lets expect (Langford & Broomfield)."
            ),
            summary.astm_by_rate,
        ),
        _crossed(
            say(
                "Points by potential (ASTM C876) and by the corrosion risk of their resistivity "
                "(RILEM TC 154-EMC)."
            ),
            summary.astm_by_risk,
        ),
    ]


def _crossed(caption: Text, cells: Sequence[Crossed]) -> Table:
    by_row = [(name, list(own)) for name, own in groupby(cells, lambda cell: cell.astm_class)]
    names = [cell.resistivity_class for cell in by_row[0][1]]
    columns = [
        Column("ASTM C876"),
        *(Column(say("unknown") if n is None else recorded(n), numeric=True) for n in names),
        Column(say("all"), numeric=True),
    ]
    rows: list[list[Text]] = [
        [
            class_chip(name),
            *(number(cell.count, 0) for cell in own),
            number(sum(cell.count for cell in own), 0),
        ]
        for name, own in by_row
    ]
    return Table(caption, columns, rows)
