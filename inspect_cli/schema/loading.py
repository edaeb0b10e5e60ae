"""From files to models: a mission with everything it stands on, checked and split.

``load_mission`` is where belief and truth part: the ``Mission`` goes to planning and flying,
the ``TruthModel`` to the simulator and its sensors alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from inspect_cli.errors import Location, Problem, SchemaError
from inspect_cli.schema.agreement import disagreements
from inspect_cli.schema.campaign import campaign_root, inside, is_file, platform_files
from inspect_cli.schema.explain import problems_of, shown, suggest
from inspect_cli.schema.mission import Mission, MissionFile
from inspect_cli.schema.nodes import Node, Step, join, merged, without
from inspect_cli.schema.references import (
    crowded_tasks,
    dangling_surfaces,
    file_problem,
    resolved_files,
)
from inspect_cli.schema.strict_yaml import read_yaml
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.schema.truth import TruthModel
from inspect_cli.schema.vehicle import PLATFORM_KINDS, PlatformBase
from inspect_cli.schema.vehicle.outdated import outdated_entries

MAX_EXTENDS = 5

Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True)
class Loaded:
    """A mission that is ready to be planned and flown."""

    mission: Mission
    """Its paths are relative to ``root``."""
    truth: TruthModel
    """Its paths, too."""
    platform: PlatformBase
    root: Path
    """The campaign folder."""
    mission_file: Path
    platform_file: Path


def load_mission(path: Path, platform: Path | None = None) -> Loaded:
    """Read a mission, the missions it extends and its platform.

    Args:
        path: the mission file.
        platform: to fly instead of the one that the mission names: a platform's name, as the
            mission would write it, or the path of its file.

    Raises:
        SchemaError: with every problem that was found in the files.
    """
    root = campaign_root(path)
    node, problems = resolved_files(_read_extended(path, root, ()), root)
    problems += [*dangling_surfaces(node), *crowded_tasks(node)]
    file = _validated(MissionFile, node, problems)

    asked = _asked_platform(platform, root, problems) if platform else None
    platform_file = asked if platform else _platform_file(node, root, problems)
    model: PlatformBase | None = None
    if platform_file:
        try:
            model = load_platform(platform_file)
        except SchemaError as error:
            problems += error.problems
    if file and model:
        problems += disagreements(file, node, model)
    if problems or file is None or model is None or platform_file is None:
        raise SchemaError(sorted(set(problems), key=_place))

    # Validated already; only the truth and the origin are left behind.
    mission = Mission.model_construct(
        **{name: getattr(file, name) for name in Mission.model_fields}
    )
    return Loaded(mission, file.truth, model, root, path, platform_file)


def load_platform(path: Path) -> PlatformBase:
    """Read a platform file, and those of its folder that it extends, by the model of its kind.

    Raises:
        SchemaError: with every problem that was found in the file.
    """
    node = without(_read_extended(path, path.resolve().parent, ()), ["extends"])
    kind = node.child("kind")
    if kind is None:
        hint = f"choices: {', '.join(PLATFORM_KINDS)}"
        raise SchemaError(Problem("missing key 'kind'", node.at(""), hint))
    if not isinstance(kind.value, str) or kind.value not in PLATFORM_KINDS:
        found = shown(kind.value)
        hint = suggest(found, list(PLATFORM_KINDS))
        raise SchemaError(Problem(f"no such kind of platform: {found}", kind.at("kind"), hint))
    problems = outdated_entries(node)
    if problems:
        raise SchemaError(sorted(problems, key=_place))
    model = _validated(PLATFORM_KINDS[kind.value], node, problems)
    if model is None:
        raise SchemaError(sorted(problems, key=_place))
    return model


def place_in_mission(path: Path, steps: Sequence[Step]) -> Location:
    """Where a mission that was read, or one that it extends, states the value at ``steps``.

    If the file has changed since or is gone, the location is less precise, but still of that file.
    """
    try:
        node = _read_extended(path, campaign_root(path), ())
    except SchemaError:
        return Location(str(path))
    for step in steps:
        child = node.child(step)
        if child is None:
            break
        node = child
    return node.at(join(steps))


def load_survey_settings(path: Path) -> SurveySettings:
    """Read what a YAML file says about a file of readings.

    Raises:
        SchemaError: with every problem that was found in the file.
    """
    problems: list[Problem] = []
    model = _validated(SurveySettings, read_yaml(path), problems)
    if model is None:
        raise SchemaError(sorted(problems, key=_place))
    return model


def _read_extended(path: Path, root: Path, above: tuple[Path, ...]) -> Node:
    """The file laid upon those that it extends; every value keeps its own place."""
    node = read_yaml(path)
    extends = node.child("extends")
    if extends is None or not isinstance(extends.value, str):
        return node
    target = inside(root, path.parent, extends.value)
    problem = file_problem(extends, "extends", target)
    chain = (*above, path.resolve())
    if target in chain:
        problem = Problem("files extend each other in a circle", extends.at("extends"))
    elif len(chain) > MAX_EXTENDS:
        problem = Problem(f"extends more than {MAX_EXTENDS} deep", extends.at("extends"))
    if problem:
        raise SchemaError(problem)
    base = _read_extended(path.parent / extends.value, root, chain)
    # Two files of one name would write into the same folder of reports.
    return merged(without(base, ["name", "extends"]), node)


def _validated(model: type[Model], node: Node, problems: list[Problem]) -> Model | None:
    try:
        return model.model_validate(node.plain)
    except ValidationError as error:
        found = problems_of(error, model, node)
        # A check of the whole file says nothing that problems with a place do not say better.
        placed = [p for p in found if p.where is None or p.where.path]
        problems += placed if problems else found
        return None


def _platform_file(node: Node, root: Path, problems: list[Problem]) -> Path | None:
    name = node.child("platform")
    if name is None or not isinstance(name.value, str):
        return None  # the schema refuses it
    if "/" in name.value or name.value.endswith(".yaml"):
        target = inside(root, Path(name.file).parent, name.value)
        problem = file_problem(name, "platform", target)
        problems += [problem] if problem else []
        return None if problem else target
    return _named_platform(name.value, root, name.at("platform"), problems)


def _asked_platform(platform: Path, root: Path, problems: list[Problem]) -> Path | None:
    is_path = platform.name != str(platform) or platform.suffix == ".yaml" or is_file(platform)
    return platform if is_path else _named_platform(str(platform), root, None, problems)


def _named_platform(
    name: str, root: Path, where: Location | None, problems: list[Problem]
) -> Path | None:
    known = platform_files(root)
    if name not in known:
        what = f"no platform is named '{shown(name)}'"
        problems.append(Problem(what, where, suggest(name, list(known))))
    return known.get(name)


def _place(problem: Problem) -> tuple[str, int, int]:
    where = problem.where or Location("")
    return where.file, where.line or 0, where.column or 0
