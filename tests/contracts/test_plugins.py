"""Registries take rows from installed packages, and refuse rows that would hide one another."""

from __future__ import annotations

from pathlib import Path

import pytest

from inspect_cli.errors import EnvironmentFault
from inspect_cli.plugins import registered

GROUP = "inspect_cli.tests"


def _install(folder: Path, package: str, rows: dict[str, str]) -> None:
    """A package as an installer leaves it: one module, and metadata with its entry points."""
    (folder / f"{package}.py").write_text("ROW = 'from outside'\n")
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
