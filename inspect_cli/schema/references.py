"""What one part of a mission file says of another, or of files: names and paths that must lead
somewhere. Checked on the nodes, so that they are reported together with the schema's errors.
"""

from __future__ import annotations

from pathlib import Path

from inspect_cli.errors import Problem
from inspect_cli.schema.campaign import inside, is_file
from inspect_cli.schema.explain import shown, suggest
from inspect_cli.schema.nodes import Node, join, matches, replaced
from inspect_cli.schema.specimens import SPECIMENS
from inspect_cli.schema.tasks import TASK_KINDS

FILES = (
    "structure.*.surface.cloud",
    "structure.*.surface.mesh",
    *(f"tasks.*.{name}.{key}" for name, kind in TASK_KINDS.items() for key in kind.file_keys),
    "truth.structure.*.geometry.file",
    *(f"truth.structure.*.specimen.{key}" for model in SPECIMENS.values() for key in model.files),
)
"""Where a mission names files; their paths are relative to the file that they stand in."""

SURFACES = tuple(
    f"tasks.*.{name}.{kind.surface_key}" for name, kind in TASK_KINDS.items() if kind.surface_key
)
"""Where a mission names one of its surfaces."""


def resolved_files(mission: Node, root: Path) -> tuple[Node, list[Problem]]:
    """The mission with every path relative to the campaign folder, and what is wrong with them.

    In the files a path is relative to the file that it stands in, which may be an inherited one.
    """
    problems: list[Problem] = []
    for pattern in FILES:
        for steps, node in matches(mission, pattern):
            if not isinstance(node.value, str):
                continue  # the schema refuses it
            target = inside(root, Path(node.file).parent, node.value)
            problem = file_problem(node, join(steps), target)
            if problem or target is None:
                problems += [problem] if problem else []
                continue
            mission = replaced(mission, steps, target.relative_to(root.resolve()).as_posix())
    return mission, problems


def file_problem(node: Node, path: str, target: Path | None) -> Problem | None:
    """Why the file that ``node`` names cannot be used."""
    if target is None:
        return Problem(
            f"leads out of the campaign folder: {shown(node.value)}",
            node.at(path),
            hint=f"copy it into the campaign; paths are relative to the folder of {node.file}",
        )
    if not is_file(target):
        return Problem(
            f"no such file: {shown(node.value)}",
            node.at(path),
            hint=f"paths are relative to the folder of {node.file}",
        )
    return None


def dangling_surfaces(mission: Node) -> list[Problem]:
    """Surfaces that are named and not there, or there twice."""
    problems: list[Problem] = []
    names: list[str] = []
    for steps, node in matches(mission, "structure.*.name"):
        if node.value in names:
            problems.append(
                Problem(f"a second surface '{shown(node.value)}'", node.at(join(steps)))
            )
        elif isinstance(node.value, str):
            names.append(node.value)
    if not names and mission.child("structure") is not None:
        return problems  # the schema refuses the structure; the rest would only repeat it
    for pattern in SURFACES:
        for steps, node in matches(mission, pattern):
            if isinstance(node.value, str) and node.value not in names:
                what = f"no surface is named '{shown(node.value)}'"
                problems.append(Problem(what, node.at(join(steps)), suggest(node.value, names)))
    for steps, node in matches(mission, "truth.structure.*"):
        name = str(steps[-1])
        if name not in names and node.child("geometry") is None:
            what = f"the truth of a surface that is not there: '{shown(name)}'"
            hint = f"{suggest(name, names)}; one that only the truth knows states its geometry"
            problems.append(Problem(what, node.key_at(join(steps)), hint))
    return problems


def crowded_tasks(mission: Node) -> list[Problem]:
    """Tasks that must be the only one of their mission and are not."""
    tasks = mission.child("tasks")
    if tasks is None or len(list(tasks.children())) < 2:
        return []
    hint = "give it a mission of its own"
    return [
        Problem(kind.alone, node.key_at(join(steps)), hint)
        for name, kind in TASK_KINDS.items()
        if kind.alone
        for steps, node in matches(mission, f"tasks.*.{name}")
    ]
