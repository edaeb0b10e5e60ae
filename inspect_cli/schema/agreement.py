"""What a mission asks for and its platform, or the rest of the mission, does not give.

Checked on the nodes, so that each problem is told at its place in the file.
"""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.errors import Location, Problem
from inspect_cli.schema.explain import suggest
from inspect_cli.schema.mission import MissionFile
from inspect_cli.schema.nodes import Node, Step, join
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.truth import WALL
from inspect_cli.schema.vehicle import PlatformBase, PoseSourceModel


def disagreements(file: MissionFile, node: Node, platform: PlatformBase) -> list[Problem]:
    """Every such problem of a mission that is valid by itself."""
    return [
        *_missing_profiles(file, node, platform),
        *_missing_sensors(file, node, platform),
        *_faults_without_effect(file, node, platform),
        *_uneven_force_sensors(file, node, platform),
    ]


def _missing_profiles(file: MissionFile, node: Node, platform: PlatformBase) -> list[Problem]:
    """Impedance profiles that the mission or one of its tasks names and the platform lacks.

    A platform without any is not asked for the mission's default.
    """
    known = list(platform.impedances)
    named: list[tuple[str | None, tuple[Step, ...]]] = []
    if known or "impedance" in file.model_fields_set:
        named.append((file.impedance, ("impedance",)))
    named += [(task.impedance, ("tasks", k, "impedance")) for k, task in enumerate(file.tasks)]
    return [
        Problem(
            f"{platform.name} has no impedance profile '{name}'",
            _place(node, steps),
            suggest(name, known),
        )
        for name, steps in named
        if name is not None and name not in known
    ]


def _missing_sensors(file: MissionFile, node: Node, platform: PlatformBase) -> Iterator[Problem]:
    """A pose source or an instrument that the mission needs and the platform lacks."""
    sources = _pose_sources(platform)
    if sources and file.estimation not in sources:
        kind = "odometry" if file.estimation == "onboard" else "pose_tracker"
        what = f"{platform.name} has no sensor of kind {kind} to fly on"
        hint = f"choices: {', '.join(sources)}"
        yield Problem(what, _place(node, ("estimation",)), hint)
    kinds = {sensor.kind for sensor in platform.sensors.values()}
    for k, task in enumerate(file.tasks):
        if task.instrument is not None and task.instrument not in kinds:
            what = f"{platform.name} has no sensor of kind {task.instrument} to read with"
            hint = "sensor: none touches without reading"
            yield Problem(what, _place(node, ("tasks", k)), hint)


def _faults_without_effect(
    file: MissionFile, node: Node, platform: PlatformBase
) -> Iterator[Problem]:
    """Faults of sensors that are not there, that the mission does not fly on, or without pixels."""
    sources = _pose_sources(platform)
    flown = sources.get(file.estimation)
    walls = [WALL] if any(s.force_sensor for s in file.truth.structure.values()) else []
    known = [*platform.sensors, *walls]
    cameras = [name for name, model in platform.sensors.items() if model.has_pixels]
    for k, fault in enumerate(file.truth.faults):
        entry = ("truth", "faults", k)
        where = _place(node, (*entry, "sensor"))
        if fault.sensor not in known:
            what = f"{platform.name} has no sensor '{fault.sensor}'"
            yield Problem(what, where, suggest(fault.sensor, known))
        elif fault.sensor in sources.values() and fault.sensor != flown:
            what = (
                f"estimation {file.estimation} flies on {flown}; a fault of another has no effect"
            )
            yield Problem(what, where, f"choices: {flown}")
        elif fault.fault == "holes" and fault.sensor not in cameras:
            images = " and ".join(cameras) or "a depth camera"
            what = f"only the images of {images} have holes; {fault.sensor} can be off or nan"
            yield Problem(what, _place(node, entry))


def _pose_sources(platform: PlatformBase) -> dict[Estimation, str]:
    """The names of the sensors that estimations can be based on."""
    return {
        model.estimation: name
        for name, model in platform.sensors.items()
        if isinstance(model, PoseSourceModel)
    }


def _uneven_force_sensors(file: MissionFile, node: Node, platform: PlatformBase) -> list[Problem]:
    """Force sensors that the platform's physics cannot sample evenly, and all but the first."""
    problems = []
    physics_hz = platform.rates.physics_hz
    measured = {n: s.force_sensor for n, s in file.truth.structure.items() if s.force_sensor}
    for k, (name, sensor) in enumerate(measured.items()):
        where = _place(node, ("truth", "structure", name, "force_sensor"))
        shape = file.truth.structure[name].geometry
        if shape is not None and shape.kind == "mesh":
            problems.append(Problem("a mesh has no frame for a force sensor to measure in", where))
        if k > 0:
            problems.append(Problem("a second force sensor; one surface may carry one", where))
        if physics_hz % sensor.rate_hz:
            what = (
                f"rate_hz {sensor.rate_hz} does not divide physics_hz {physics_hz} "
                f"of {platform.name}"
            )
            divisors = [hz for hz in range(1, physics_hz + 1) if physics_hz % hz == 0]
            near = min(divisors, key=lambda hz: abs(hz - sensor.rate_hz))
            hint = f"the nearest that does is {near}; or fly a platform with a faster physics_hz"
            problems.append(Problem(what, where, hint))
    return problems


def _place(node: Node, steps: tuple[Step, ...]) -> Location:
    """Where the entry stands, or the deepest there is of it: the rest are defaults."""
    passed: list[Step] = []
    for step in steps:
        child = node.child(step)
        if child is None:
            break
        passed.append(step)
        node = child
    return node.at(join(passed)) if passed else Location(node.file)
