"""JSON Schema (draft 2020-12) of the files that people write, for their editors.

``inspect schema`` prints it. The copies beside this module are for editors that want a file or
an address; a test compares them with the models.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, TypeAlias

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from inspect_cli.schema.mission import MissionFile
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.schema.units import split_key
from inspect_cli.schema.vehicle import PLATFORM_KINDS

REFERENCE = "#/$defs/"
DIALECT = "https://json-schema.org/draft/2020-12/schema"

Defined: TypeAlias = tuple[dict[str, Any], dict[str, Any]]
"""Definitions by name, and the schema of the whole that refers to them."""

Kind = Literal["mission", "platform", "survey"]
TITLES: dict[Kind, str] = {
    "mission": "Mission of inspect",
    "platform": "Platform of inspect",
    "survey": "Settings of a survey for inspect",
}


def json_schema(kind: Kind) -> dict[str, Any]:
    """The schema of a file, computed from the models.

    A mission or platform that extends another may leave out what it inherits, at any depth.
    """
    definitions, whole = DEFINED[kind]()
    for definition in definitions.values():
        _title_with_units(definition)
    head = {"$schema": DIALECT, "title": TITLES[kind]}
    if kind == "survey":  # extends nothing
        return head | {"$defs": definitions} | whole
    partial = {f"Partial{name}": _partial(body) for name, body in definitions.items()}
    return head | {
        "$defs": definitions | partial,
        "if": {"required": ["extends"]},
        "then": {"allOf": [_partial(whole), {"required": ["name"]}]},
        "else": whole,
    }


def schema_text(kind: Kind) -> str:
    """The schema as it is committed."""
    return json.dumps(json_schema(kind), indent=2, ensure_ascii=False) + "\n"


def committed_file(kind: Kind) -> Path:
    """The committed copy."""
    return Path(__file__).with_name(f"{kind}.schema.json")


def _mission() -> Defined:
    return _model("Mission", MissionFile)


def _survey() -> Defined:
    return _model("Survey", SurveySettings)


def _model(name: str, model: type[BaseModel]) -> Defined:
    body = model.model_json_schema(by_alias=True)
    definitions = body.pop("$defs", {})
    return definitions | {name: body}, {"$ref": REFERENCE + name}


def _platform() -> Defined:
    kinds = list(PLATFORM_KINDS.values())
    references, body = models_json_schema([(kind, "validation") for kind in kinds], by_alias=True)
    return body["$defs"], {"oneOf": [references[kind, "validation"] for kind in kinds]}


DEFINED: dict[Kind, Callable[[], Defined]] = {
    "mission": _mission,
    "platform": _platform,
    "survey": _survey,
}


def _partial(schema: Any) -> Any:
    """A copy in which nothing is required, its references led to other such copies.

    An entry that leaves out its kind may then be of several, so that oneOf becomes anyOf.
    """
    if isinstance(schema, list):
        return [_partial(entry) for entry in schema]
    if not isinstance(schema, dict):
        return schema
    copy = {
        "anyOf" if key == "oneOf" else key: _partial(value)
        for key, value in schema.items()
        if key != "required"
    }
    if isinstance(copy.get("$ref"), str):
        copy["$ref"] = copy["$ref"].replace(REFERENCE, REFERENCE + "Partial")
    mapping = copy.get("discriminator", {}).get("mapping", {})
    for name, target in mapping.items():
        mapping[name] = target.replace(REFERENCE, REFERENCE + "Partial")
    return copy


def _title_with_units(schema: dict[str, Any]) -> None:
    """Give every key a title that spells its unit out: ``pitch_m`` is "Pitch, metres"."""
    for key, entry in schema.get("properties", {}).items():
        stem, unit = split_key(key)
        words = stem.replace("_", " ")
        entry["title"] = words[:1].upper() + words[1:] + (f", {unit.name}" if unit else "")
