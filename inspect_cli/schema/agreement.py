"""What a mission asks for and its platform, or the rest of the mission, does not give.

Checked on the nodes, so that each problem is told at its place in the file.
"""

from __future__ import annotations

from inspect_cli.errors import Location, Problem
from inspect_cli.schema.explain import suggest
from inspect_cli.schema.mission import MissionFile
from inspect_cli.schema.nodes import Node, Step, join
from inspect_cli.schema.vehicle import PlatformBase

POSE_SOURCES = {"external": "pose", "onboard": "odometry"}
"""Which sensor an estimation flies on."""


def disagreements(file: MissionFile, node: Node, platform: PlatformBase) -> list[Problem]:
    """Every such problem of a mission that is valid by itself."""
    problems = _missing_profiles(file, node, platform)
    if file.estimation == "onboard" and platform.sensors.odometry is None:
        what = f"{platform.name} has no sensors.odometry to fly on"
        problems.append(Problem(what, _place(node, ("estimation",)), "choices: external"))
    return problems + _idle_faults(file, node) + _uneven_force_sensors(file, node, platform)


def _missing_profiles(file: MissionFile, node: Node, platform: PlatformBase) -> list[Problem]:
    """Impedance profiles that the mission or one of its tasks names and the platform lacks."""
    known = list(platform.control.profiles)
    named: list[tuple[str | None, tuple[Step, ...]]] = [(file.impedance, ("impedance",))]
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


def _idle_faults(file: MissionFile, node: Node) -> list[Problem]:
    """Faults of the pose sensor that the mission does not fly on."""
    flown = POSE_SOURCES[file.estimation]
    what = f"estimation {file.estimation} flies on {flown}; a fault of another has no effect"
    return [
        Problem(what, _place(node, ("truth", "faults", k, "sensor")), f"choices: {flown}")
        for k, fault in enumerate(file.truth.faults)
        if fault.sensor in POSE_SOURCES.values() and fault.sensor != flown
    ]


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
