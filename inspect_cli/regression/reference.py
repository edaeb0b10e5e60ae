"""Reads and writes the committed reference metrics.

They lie in ``reports/reference/<mission>/<platform>-seed<N>.json``.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from inspect_cli.errors import InputError
from inspect_cli.files import write_whole
from inspect_cli.schema.base import Strict
from inspect_cli.schema.result import Result, Status

SIGNIFICANT_DIGITS = 9


class ReferenceMetrics(Strict):
    """The metrics of a flight that was reviewed and accepted."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    mission: str
    platform: str
    seed: int
    status: Status
    metrics: dict[str, float | None]


def reference_file(root: Path, mission: str, platform: str, seed: int) -> Path:
    """The path of a flight's reference in the campaign folder ``root``."""
    return root / "reports" / "reference" / mission / f"{platform}-seed{seed}.json"


def rounded(value: float | None) -> float | None:
    """A number as references keep it: nine significant digits."""
    return None if value is None else float(f"{value:.{SIGNIFICANT_DIGITS}g}")


def reference_of(result: Result, seed: int) -> ReferenceMetrics:
    """The reference metrics of a result."""
    return ReferenceMetrics(
        mission=result.mission,
        platform=result.platform,
        seed=seed,
        status=result.status,
        metrics={name: rounded(metric.value) for name, metric in result.metrics.items()},
    )


def read_reference(path: Path) -> ReferenceMetrics | None:
    """The reference in a file; None when there is none.

    Raises:
        InputError: the file is damaged.
    """
    try:
        return ReferenceMetrics.model_validate_json(path.read_bytes())
    except FileNotFoundError:
        return None
    except (OSError, ValidationError) as error:
        raise InputError(
            f"the reference {path} cannot be read: {error}",
            hint="restore it from version control, or rewrite it with --update",
        ) from error


def write_reference(path: Path, reference: ReferenceMetrics) -> None:
    """Replace a reference file atomically; keys are sorted, so that diffs stay small.

    Raises:
        EnvironmentFault: the file cannot be written.
    """
    data = reference.model_dump(by_alias=True)
    write_whole(path, json.dumps(data, indent=1, sort_keys=True, ensure_ascii=False) + "\n")
