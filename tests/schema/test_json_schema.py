"""The JSON Schemas: valid, closed, committed as they are, and in agreement with the loader."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from inspect_cli.schema.json_schema import Kind, committed_file, json_schema, schema_text
from inspect_cli.schema.strict_yaml import read_yaml

KINDS: tuple[Kind, ...] = ("mission", "platform", "survey")


def plain(file: Path) -> Any:
    return json.loads(json.dumps(read_yaml(file).plain))


def objects(schema: Any) -> list[dict[str, Any]]:
    if isinstance(schema, dict):
        own = [schema] if "properties" in schema and "type" in schema else []
        return own + [found for value in schema.values() for found in objects(value)]
    if isinstance(schema, list):
        return [found for value in schema for found in objects(value)]
    return []


@pytest.mark.parametrize("kind", KINDS)
def test_the_schema_is_a_schema(kind: Kind) -> None:
    schema = json_schema(kind)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("kind", KINDS)
def test_every_mapping_is_closed_and_every_key_has_a_title(kind: Kind) -> None:
    found = objects(json_schema(kind))
    assert len(found) > (1 if kind == "survey" else 10)
    for schema in found:
        assert schema["additionalProperties"] is False
        assert all(entry["title"] for entry in schema["properties"].values())


@pytest.mark.parametrize("kind", KINDS)
def test_the_committed_copy_is_what_the_models_say(kind: Kind) -> None:
    file = committed_file(kind)
    assert file.read_text(encoding="utf-8") == schema_text(kind), (
        f"write it again: inspect schema {kind} > {file.name}"
    )


@pytest.mark.parametrize("kind", ["mission", "platform"])
def test_every_built_in_file_is_valid(kind: Kind, root: Path) -> None:
    validator = jsonschema.Draft202012Validator(json_schema(kind))
    files = sorted((root / f"{kind}s").rglob("*.yaml"))
    assert files
    for file in files:
        validator.validate(plain(file))


@pytest.mark.parametrize(
    ("key", "value"),
    [("pitch_cm", 5), ("pitch_m", "10cm"), ("pitch_m", -1), ("rows", 1.5), ("order", "spiral")],
)
def test_an_editor_refuses_what_the_loader_refuses(campaign: Path, key: str, value: object) -> None:
    validator = jsonschema.Draft202012Validator(json_schema("mission"))
    mission = plain(campaign / "missions" / "m.yaml")
    validator.validate(mission)
    mission["tasks"][0]["contact_grid"][key] = value
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(mission)


def test_a_mission_that_extends_another_may_be_short() -> None:
    validator = jsonschema.Draft202012Validator(json_schema("mission"))
    validator.validate({"name": "variant", "extends": "m.yaml"})
    with pytest.raises(jsonschema.ValidationError):
        validator.validate({"name": "variant"})


@pytest.mark.parametrize(
    ("settings", "valid"),
    [
        ({}, True),
        ({"spacing_m": 0.25, "electrode": "SCE", "date": "2025-03-31"}, True),
        ({"spacing_m": [0.25, 0.5], "origin_m": [1.0, -2.0]}, True),
        ({"georeference": {"longitude_deg": 8.5, "latitude_deg": 47.4}}, True),
        ({"spacing_m": 0.0}, False),
        ({"spacing_m": [0.25]}, False),
        ({"spacing_mm": 250}, False),
        ({"electrode": "gold"}, False),
        ({"georeference": {"longitude_deg": 8.5}}, False),
    ],
)
def test_settings_of_a_survey_as_an_editor_sees_them(
    settings: dict[str, Any], *, valid: bool
) -> None:
    validator = jsonschema.Draft202012Validator(json_schema("survey"))
    assert validator.is_valid(settings) is valid
