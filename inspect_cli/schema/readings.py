"""``metrics.json`` of a survey that people took: what its readings come to."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.assessment import SurfaceAssessment
from inspect_cli.schema.base import Strict
from inspect_cli.schema.survey import SurveySettings


class SourceOfReadings(Strict):
    """A file that readings were taken from."""

    name: str
    sha256: str


class ReadingsResult(Strict):
    """The whole of ``metrics.json`` for readings without a flight."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    kind: Literal["readings"] = "readings"
    survey: str
    """Its title, or the name of its file."""
    files: tuple[SourceOfReadings, ...]
    settings: SurveySettings
    """As used: with what the file states."""
    assumed: tuple[str, ...]
    """Settings that matter and that neither the file nor the user stated."""
    warnings: tuple[str, ...]
    assessment: tuple[SurfaceAssessment, ...]
    map: tuple[str, ...]
    """How each surface's map was made, or why there is none."""
    versions: dict[str, str]
    """Of what computed this."""
