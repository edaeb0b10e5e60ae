"""The true structure of a mission; what is wrong with it is said at its place in the mission."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from inspect_cli.errors import InputError, Problem
from inspect_cli.schema.loading import Loaded, place_in_mission
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.truth.geometry import StructureTruth, specimen_path, true_structure


def truth_under_surfaces(loaded: Loaded, believed: Sequence[PlannedSurface]) -> StructureTruth:
    """What is really there of a mission whose planner believes in ``believed``.

    Raises:
        InputError: a specimen does not fit its surface, cannot be read, or has no solution.
    """
    try:
        return true_structure(loaded.truth, believed, loaded.root)
    except InputError as error:
        raise type(error)([_placed(problem, loaded) for problem in error.problems]) from error


def _placed(problem: Problem, loaded: Loaded) -> Problem:
    path = problem.where.path if problem.where else ""
    for name in loaded.truth.structure:
        if path == specimen_path(name):
            steps = ("truth", "structure", name, "specimen")
            return replace(problem, where=place_in_mission(loaded.mission_file, steps))
    return problem
