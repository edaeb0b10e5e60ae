"""``inspect init`` and what the package carries for it."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from inspect_cli.commands.init import init
from inspect_cli.errors import InputError
from inspect_cli.schema.loading import load_mission


def test_a_new_campaign_has_everything_that_its_missions_need(tmp_path: Path) -> None:
    made = init(tmp_path / "new")
    assert made.first_mission is not None
    assert {"README.md", ".gitignore"} <= {str(file) for file in made.files}
    assert {p.name for p in made.folder.iterdir() if p.is_dir()} == {
        "missions",
        "platforms",
        "reports",
    }
    assert all((made.folder / file).is_file() for file in made.files)
    missions = sorted((made.folder / "missions").rglob("*.yaml"))
    assert missions
    for mission in missions:
        loaded = load_mission(mission)
        assert loaded.root == made.folder.resolve()
        assert loaded.platform_file.is_relative_to(loaded.root)


def test_the_readme_makes_references_before_it_compares_with_them(tmp_path: Path) -> None:
    text = (init(tmp_path / "new").folder / "README.md").read_text()
    assert 0 < text.index("inspect regress --update\n") < text.index("inspect regress\n")


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    assert init(tmp_path).folder == tmp_path


@pytest.mark.parametrize("name", ["something.txt", ".git"])
def test_a_folder_with_something_in_it_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("")
    with pytest.raises(InputError, match="is not empty"):
        init(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_a_file_in_the_way_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="is a file"):
        init(tmp_path / "file")


def test_the_wheel_carries_every_package(root: Path) -> None:
    settings = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["setuptools"]
    present = {
        ".".join(file.parent.relative_to(root).parts)
        for file in (root / "inspect_cli").rglob("__init__.py")
    }
    carried = {
        ".".join((package, *inner.relative_to(root / folder).parts))
        for package, folder in settings["package-dir"].items()
        for inner in (root / folder, *(root / folder).rglob("*/"))
    }
    assert set(settings["packages"]) == present | carried
    for folder in settings["package-dir"].values():
        assert (root / folder).is_dir()
