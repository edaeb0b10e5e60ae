"""Registries take rows from installed packages, and refuse rows that would hide one another."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import pytest
from pydantic import BaseModel

from inspect_cli.errors import EnvironmentFault
from inspect_cli.plugins import registered
from inspect_cli.schema.registry import OneOf

GROUP = "inspect_cli.tests"


def _install(
    folder: Path, package: str, rows: dict[str, str], text: str = "ROW = 'from outside'\n"
) -> None:
    """A package as an installer leaves it: one module, and metadata with its entry points."""
    (folder / f"{package}.py").write_text(text)
    metadata = folder / f"{package}-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    lines = [f"[{GROUP}]", *(f"{name} = {value}" for name, value in rows.items())]
    (metadata / "entry_points.txt").write_text("\n".join(lines) + "\n")


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def test_without_packages_a_registry_is_what_is_built_in() -> None:
    assert registered(GROUP, {"b": 1, "a": 2}) == {"b": 1, "a": 2}


def test_rows_of_packages_follow_the_built_in_ones_by_name(site: Path) -> None:
    _install(site, "outside_one", {"late": "outside_one:ROW"})
    _install(site, "outside_two", {"early": "outside_two:ROW"})
    rows = registered(GROUP, {"own": "from inside"})
    assert list(rows.items()) == [
        ("own", "from inside"),
        ("early", "from outside"),
        ("late", "from outside"),
    ]


def test_a_name_that_is_taken_is_refused_with_the_package(site: Path) -> None:
    _install(site, "outside_three", {"own": "outside_three:ROW"})
    with pytest.raises(EnvironmentFault, match=r"package outside_three registers 'own'"):
        registered(GROUP, {"own": "from inside"})


@pytest.mark.parametrize("value", ["outside_four:MISSING", "not_installed_at_all:ROW"])
def test_a_row_that_cannot_be_imported_names_its_package(site: Path, value: str) -> None:
    _install(site, "outside_four", {"broken": value})
    with pytest.raises(EnvironmentFault, match=r"package outside_four registers 'broken'"):
        registered(GROUP, {})


@pytest.mark.parametrize(
    "text", ["def (:", "ROW = Foo", "raise ValueError('x')", "raise SystemExit(0)"]
)
def test_a_module_that_fails_names_its_package(
    site: Path, monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    """Whatever a package does when it is imported, nothing goes on without a word."""
    monkeypatch.delitem(sys.modules, "outside_five", raising=False)
    _install(site, "outside_five", {"broken": "outside_five:ROW"}, text)
    with pytest.raises(EnvironmentFault, match=r"package outside_five registers 'broken'"):
        registered(GROUP, {})


@pytest.mark.parametrize(("kind", "word"), [(int, "int"), (Callable, "Callable")])
def test_a_row_of_another_kind_is_refused(site: Path, kind: type, word: str) -> None:
    """A text is neither a number nor can it be called."""
    _install(site, "outside_six", {"odd": "outside_six:ROW"})
    with pytest.raises(EnvironmentFault, match=f"outside_six:ROW, which is no {word}"):
        registered(GROUP, {}, kind)


def test_a_model_is_registered_by_the_name_that_it_takes() -> None:
    """Otherwise no file could name it."""

    class Baro(BaseModel):
        kind: Literal["baro"]

    OneOf({"baro": Baro})
    with pytest.raises(EnvironmentFault, match="Baro is registered as 'barometer'"):
        OneOf({"barometer": Baro})
