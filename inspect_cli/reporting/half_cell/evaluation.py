"""The evaluation of half-cell readings as content: maps, diagrams, tables, surface by surface.

The same blocks serve a flight and a survey from a file; they know no log and no plan.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.content.blocks import Block, Figures, Heading, Paragraph, drawn
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.basis import basis_facts, uncertainty_blocks
from inspect_cli.reporting.half_cell.classes import (
    classes_table,
    resistivity_blocks,
    verdict_blocks,
)
from inspect_cli.reporting.half_cell.cumulative import cumulative_figure
from inspect_cli.reporting.half_cell.error_map import error_figure
from inspect_cli.reporting.half_cell.findings_text import evaluation_method
from inspect_cli.reporting.half_cell.histogram import histogram_figure
from inspect_cli.reporting.half_cell.map_frame import TALL, frame_of
from inspect_cli.reporting.half_cell.minima import gradient_blocks, refinement_blocks
from inspect_cli.reporting.half_cell.places import points_on, shared_range
from inspect_cli.reporting.half_cell.point_table import points_table
from inspect_cli.reporting.half_cell.potential_map import map_figure
from inspect_cli.reporting.half_cell.potential_statistics import (
    conditions_table,
    mixture_blocks,
    statistics_blocks,
)
from inspect_cli.reporting.half_cell.resistivity import resistivity_figure
from inspect_cli.reporting.half_cell.scoring import scoring_blocks
from inspect_cli.reporting.words.text import Text, say
from inspect_cli.schema.scoring import Scoring


def evaluation_blocks(
    evaluated: Sequence[SurfaceFindings], points: Sequence[ReadPoint], scoring: Scoring | None
) -> list[Block]:
    """All findings as figures, tables and sentences.

    Args:
        evaluated: each surface's findings and map.
        points: the readings one by one; those without a surface belong to the only one.
        scoring: the verdicts against the truth of a simulation; None without it.
    """
    several, ends = len(evaluated) > 1, shared_range(evaluated)
    own = points_on(evaluated, points)
    blocks: list[Block] = []
    for k, e in enumerate(evaluated):
        if several:
            blocks.append(Heading(say("Surface “{surface}”", surface=e.surface)))
        blocks += _surface(k, e, ends, _reasons(own[e.surface]))
    blocks += scoring_blocks(scoring)
    if evaluated:
        blocks += [Heading(say("How the readings were evaluated")), evaluation_method()]
    if points:
        blocks += [Heading(say("All readings")), points_table(points, evaluated)]
    return blocks


def _reasons(points: Sequence[ReadPoint]) -> Mapping[str, Text]:
    return {p.point.label: p.reason for p in points if not p.point.valid}


def _surface(
    k: int, evaluated: SurfaceFindings, ends: tuple[float, float], reasons: Mapping[str, Text]
) -> list[Block]:
    assessed, summary = evaluated.assessed, evaluated.assessed.summary
    if summary.points == 0:
        nothing = say("Nothing was read on surface “{surface}”.", surface=evaluated.surface)
        return [Paragraph(nothing, "note")]
    distribution = (cumulative_figure(k, evaluated), histogram_figure(k, evaluated))
    resistivity = resistivity_figure(k, evaluated)
    return [
        *_maps(k, evaluated, ends, reasons),
        *verdict_blocks(assessed),
        classes_table(summary),
        *statistics_blocks(summary),
        *drawn((f for f in distribution if f is not None), side_by_side=True),
        *mixture_blocks(summary.mixture),
        Heading(say("Gradients")),
        *gradient_blocks(summary.gradient),
        *refinement_blocks(summary.refinement),
        Heading(say("Resistivity")),
        *drawn([] if resistivity is None else [resistivity]),
        *resistivity_blocks(summary),
        Heading(say("What the potentials are typical of")),
        conditions_table(summary),
        Heading(say("How sure the potentials are")),
        basis_facts(summary),
        *uncertainty_blocks(summary),
    ]


def _maps(
    k: int, evaluated: SurfaceFindings, ends: tuple[float, float], reasons: Mapping[str, Text]
) -> list[Block]:
    """The potentials and their standard error; side by side where the surface is tall."""
    found = (map_figure(k, evaluated, ends, reasons), error_figure(k, evaluated))
    figures = tuple(figure for figure in found if figure is not None)
    tall = frame_of(evaluated.assessed.readings.uv_m).slope > TALL
    return [Figures(figures, side_by_side=tall and len(figures) > 1)] if figures else []
