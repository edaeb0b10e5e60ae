"""``inspect schema``: the JSON Schema of a file that people write."""

from __future__ import annotations

from inspect_cli.schema.json_schema import Kind, schema_text


def schema(kind: Kind) -> str:
    """The schema's text."""
    return schema_text(kind)
