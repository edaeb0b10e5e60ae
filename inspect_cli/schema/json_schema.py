"""JSON Schema (draft 2020-12) of the files that people write, for their editors.

``inspect schema`` prints it. The copies beside this module are for editors that want a file or
an address; a test compares them with the models.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Literal

from pydantic.json_schema import models_json_schema

from inspect_cli.schema.mission import MissionFile
from inspect_cli.schema.platform import PLATFORM_KINDS
from inspect_cli.schema.units import split_key

DIALECT = "https://json-schema.org/draft/2020-12/schema"

Kind = Literal["mission", "platform"]
TITLES: dict[Kind, str] = {"mission": "Mission of inspect", "platform": "Platform of inspect"}


def json_schema(kind: Kind) -> dict[str, Any]:
    """The schema of a mission or a platform file, computed from the models."""
    body = _mission() if kind == "mission" else _platform()
    _title_with_units(body)
    return {"$schema": DIALECT, **body, "title": TITLES[kind]}


def schema_text(kind: Kind) -> str:
    """The schema as it is committed."""
    return json.dumps(json_schema(kind), indent=2, ensure_ascii=False) + "\n"


def committed_file(kind: Kind) -> Path:
    """The committed copy."""
    return Path(__file__).with_name(f"{kind}.schema.json")


def _mission() -> dict[str, Any]:
    schema = MissionFile.model_json_schema(by_alias=True)
    # A mission that extends another may leave out what it inherits, but for its own name.
    whole = schema.pop("required")
    schema["anyOf"] = [{"required": whole}, {"required": ["name", "extends"]}]
    return schema


def _platform() -> dict[str, Any]:
    kinds = list(PLATFORM_KINDS.values())
    references, body = models_json_schema([(kind, "validation") for kind in kinds], by_alias=True)
    return {**body, "oneOf": [references[kind, "validation"] for kind in kinds]}


def _title_with_units(schema: dict[str, Any]) -> None:
    """Give every key a title that spells its unit out: ``pitch_m`` is "Pitch, metres"."""
    for key, entry in schema.get("properties", {}).items():
        stem, unit = split_key(key)
        words = stem.replace("_", " ")
        entry["title"] = words[:1].upper() + words[1:] + (f", {unit.name}" if unit else "")
    for definition in schema.get("$defs", {}).values():
        _title_with_units(definition)
