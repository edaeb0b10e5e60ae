"""The settings of a file of readings: its ``.survey.yaml``, and options that come before it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from inspect_cli.errors import InputError, Location
from inspect_cli.schema.explain import problems_of
from inspect_cli.schema.loading import load_survey_settings
from inspect_cli.schema.nodes import Node, Scalar
from inspect_cli.schema.survey import SurveySettings

SUFFIX = ".survey.yaml"


def sidecar_of(readings: Path) -> Path:
    """Where the settings of a file stand: ``slab.survey.yaml`` beside ``slab.csv``."""
    return readings.with_name(readings.stem + SUFFIX)


def read_settings(readings: Path, options: Mapping[str, object] | None = None) -> SurveySettings:
    """The settings of a file of readings.

    Args:
        readings: the file; its sidecar is read if there is one.
        options: settings by key that come before the sidecar's; None stands for "not given".
            Pairs and triples are tuples. A path of resistivities is relative to the working
            directory here, and to the readings in the sidecar.

    Raises:
        SchemaError: the sidecar breaks the schema, with file:line:column.
        InputError: an option does.
    """
    sidecar = sidecar_of(readings)
    own = load_survey_settings(sidecar) if sidecar.exists() else SurveySettings()
    given = {key: value for key, value in (options or {}).items() if value is not None}
    if not given:
        return own
    if isinstance(given.get("resistivity"), str | Path):
        given["resistivity"] = str(Path(str(given["resistivity"])).absolute())
    try:
        SurveySettings.model_validate(given)
    except ValidationError as error:
        found = problems_of(error, SurveySettings, _node(given))
        raise InputError([replace(p, where=_option(p.where)) for p in found]) from error
    stated = {key: getattr(own, key) for key in own.model_fields_set}
    return SurveySettings.model_validate({**stated, **given})


def _node(value: object) -> Node:
    """An option's value in the shape of a file's."""
    if isinstance(value, dict):
        return Node({key: _node(item) for key, item in value.items()}, "", 1, 1)
    if isinstance(value, list | tuple):
        return Node(tuple(map(_node, value)), "", 1, 1)
    scalar: Scalar = value if isinstance(value, bool | int | float | str) else str(value)
    return Node(scalar, "", 1, 1)


def _option(where: Location | None) -> Location:
    return Location("option", path=where.path if where else "")
