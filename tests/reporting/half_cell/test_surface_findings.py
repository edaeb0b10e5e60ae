"""A report draws the readings as they were assessed for the result, and assesses nothing again."""

from __future__ import annotations

from pathlib import Path

import pytest
from example_flights import survey

from inspect_cli.assessment import assess as module
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.metrics.evaluate import evaluate, evaluate_with_arrays
from inspect_cli.reporting.documents.flight import report_document


def test_a_surface_is_assessed_once_for_result_and_report(
    platform_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assessed: list[str] = []
    assess = module.assess

    def counted(surface: str, *given: object, **named: object) -> module.Assessed:
        assessed.append(surface)
        return assess(surface, *given, **named)

    log = survey(platform_file, 3, 3).log()
    monkeypatch.setattr(module, "assess", counted)
    evaluation = evaluate_with_arrays(log)
    surfaces = with_maps(evaluation.assessed)
    report_document(log, evaluation.result, log.plan(), surfaces)
    assert assessed == [surface.surface for surface in surfaces]
    assert len(assessed) == 1


def test_the_arrays_are_those_that_the_result_was_computed_from(platform_file: Path) -> None:
    log = survey(platform_file, 3, 3).log()
    evaluation = evaluate_with_arrays(log)
    assert evaluation.result == evaluate(log)
    assert evaluation.result.assessment == tuple(one.summary for one in evaluation.assessed)
    (wall,) = evaluation.assessed
    read = {p.label: p.potential_mv for p in evaluation.result.points}
    drawn = dict(zip(wall.readings.labels.tolist(), 1e3 * wall.readings.potential_v, strict=True))
    assert drawn == pytest.approx(read)
