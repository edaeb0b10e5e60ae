"""What the source says to a reader: the keys that every catalogue must translate."""

from __future__ import annotations

import ast
import string
from collections.abc import Iterator
from pathlib import Path

from inspect_cli.assessment.classes import COMBINED_RULE
from inspect_cli.commands.study import STUDIES
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.reporting.words.published import PUBLISHED

Key = tuple[str, str]
"""The English, and the English of many; empty where nothing is counted."""


def said(package: Path) -> set[Key]:
    """Every template of ``say`` and ``count``, and what tables of the source hold."""
    found = {key for file in package.rglob("*.py") for key in _calls(file)}
    found |= {(spec.meaning, "") for spec in METRICS.values()}
    found |= {(row.words, "") for row in PUBLISHED.values()}
    found |= {(study.title, "") for study in STUDIES.values()}
    headings = (c.heading for s in STUDIES.values() for c in s.columns + s.flown_columns)
    found |= {(part, "") for heading in headings for part in heading.split(", ")}
    return found | {(COMBINED_RULE, "")}


def _calls(file: Path) -> Iterator[Key]:
    source = file.read_text(encoding="utf-8")
    if "inspect_cli.reporting.words.text" not in source:
        return  # a function of that name is another's, such as itertools.count
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name):
            continue
        if node.func.id == "say":
            yield _constant(file, node.args[0]), ""
        if node.func.id == "count":
            yield _constant(file, node.args[1]), _constant(file, node.args[2])


def _constant(file: Path, node: ast.expr) -> str:
    assert isinstance(node, ast.Constant), f"{file}:{node.lineno}: no template but an expression"
    return str(node.value)


def reasons(folder: Path) -> set[str]:
    """The sentences with which metrics say why they are not measured, values written as 1."""
    found = set()
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name):
                continue
            if node.func.id == "NotMeasured":
                found.add(_filled(node.args[0]))
            if node.func.id == "Metric":
                given = [k.value for k in node.keywords if k.arg == "why"]
                found |= {_filled(value) for value in given if not isinstance(value, ast.Name)}
    return found - {""}


def _filled(node: ast.expr) -> str:
    if isinstance(node, ast.JoinedStr):
        return "".join(_filled(part) for part in node.values)
    if isinstance(node, ast.Constant):
        return str(node.value)
    return "1" if isinstance(node, ast.FormattedValue) else ""


def names(template: str) -> set[str]:
    """The {names} of a template."""
    return {name for _, name, _, _ in string.Formatter().parse(template) if name is not None}
