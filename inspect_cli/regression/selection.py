"""Selects the missions and seeds that the regression flies, in a fixed order."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.errors import InputError, Problem
from inspect_cli.schema.loading import Loaded, load_mission


@dataclass(frozen=True)
class Selection:
    """A mission and the seeds to fly it with."""

    loaded: Loaded
    seeds: tuple[int, ...]

    @property
    def key(self) -> tuple[Path, str]:
        """What identifies a mission: the campaign folder and the mission's name."""
        return self.loaded.root, self.loaded.mission.name


def mission_files(paths: Sequence[Path], campaign: Path) -> list[Path]:
    """The mission files among ``paths``, sorted; folders are searched for ``*.yaml``.

    Args:
        paths: files and folders; without any, the campaign's ``missions/``.
        campaign: the campaign folder.

    Raises:
        InputError: a path does not exist, or there is no mission at all.
    """
    searched = list(paths) or [campaign / "missions"]
    found: set[Path] = set()
    problems = []
    for path in searched:
        files = sorted(path.rglob("*.yaml")) if path.is_dir() else [path]
        if not path.exists():
            problems.append(Problem(f"there is no {path}", hint=HINT))
        elif not files:
            problems.append(Problem(f"there is no mission (*.yaml) in {path}", hint=HINT))
        found.update(file.resolve() for file in files)
    if problems:
        raise InputError(problems)
    return sorted(found)


HINT = "give mission files or folders, or run it in a campaign folder (`inspect init` makes one)"


def select(files: Iterable[Path]) -> list[Selection]:
    """Load missions, and the missions that they are compared with, and choose the seeds.

    A mission whose metric an acceptance entry divides by (``over``) is flown with the seeds of
    the mission that has the entry; if it was selected itself, with its own seeds as well.

    Raises:
        InputError: with every problem of every file; nothing has been flown.
    """
    loaded = _load_all(files)
    seeds: dict[tuple[Path, str], set[int]] = {}
    missions: dict[tuple[Path, str], Loaded] = {}
    todo = [(mission, mission.mission.seeds) for mission in loaded]
    while todo:
        mission, wanted = todo.pop()
        key = (mission.root, mission.mission.name)
        missions[key] = mission
        new = set(wanted) - seeds.setdefault(key, set())
        if not new:
            continue
        seeds[key] |= new
        todo += [(other, tuple(new)) for other in _divisors(mission, loaded)]
    selections = [Selection(missions[key], tuple(sorted(seeds[key]))) for key in missions]
    return sorted(selections, key=lambda s: (s.loaded.mission_file.resolve(), s.key[1]))


def _load_all(files: Iterable[Path]) -> list[Loaded]:
    loaded: dict[tuple[Path, str], Loaded] = {}
    problems: list[Problem] = []
    for file in files:
        try:
            mission = load_mission(file)
        except InputError as error:
            problems += error.problems
            continue
        key = (mission.root, mission.mission.name)
        if key in loaded:
            first = loaded[key].mission_file
            problems.append(
                Problem(
                    f"{first} and {file} are both named '{mission.mission.name}'",
                    hint="their reports and references would overwrite each other; rename one",
                )
            )
        loaded[key] = mission
    if problems:
        raise InputError(problems)
    return list(loaded.values())


def _divisors(mission: Loaded, loaded: Sequence[Loaded]) -> list[Loaded]:
    """The missions of the same campaign that ``mission`` is compared with.

    Those that are not among the ``loaded`` are searched for in the campaign; names that no file
    has and files that cannot be loaded are skipped, and their checks are then not measured.
    """
    wanted = {entry.over.mission for entry in mission.mission.acceptance if entry.over is not None}
    known = {other.mission.name: other for other in loaded if other.root == mission.root}
    if wanted - known.keys():
        for file in sorted((mission.root / "missions").rglob("*.yaml")):
            with suppress(InputError):
                other = load_mission(file)
                known.setdefault(other.mission.name, other)
    return [known[name] for name in sorted(wanted & known.keys())]
