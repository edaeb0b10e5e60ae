"""The rest of the package of ``test_outside_instrument``: a row for each registry but its own.

A kind of platform, a task, a sensor, a disturbance and a specimen, by the recipes of CONTRIBUTING.
"""

from __future__ import annotations

MODULES = {
    "survey_rotor_model": '''
from typing import Literal
from inspect_cli.schema.vehicle.tilt_rotor import TiltRotorPlatform

class SurveyRotorPlatform(TiltRotorPlatform):
    """A tilt-rotor platform under a name of its own."""

    kind: Literal["survey_rotor"]
''',
    "survey_rotor": """
from inspect_cli.vehicles.tilt_rotor import TiltRotor

class SurveyRotor(TiltRotor):
    pass
""",
    "tap_model": '''
from inspect_cli.schema.base import Name
from inspect_cli.schema.tasks.base import CONTACT_MODES, ContactOptions, TaskKind

class Tap(ContactOptions):
    """A place, and another one above it."""

    on: Name
    at_m: tuple[float, float]
    up_m: float

KIND = TaskKind(Tap, modes=CONTACT_MODES, surface_key="on", reads=True)
''',
    "tap_planner": """
from inspect_cli.planning.points import point_on
from inspect_cli.planning.tasks.situation import Planners
from inspect_cli.planning.tasks.touch import TouchPlanner

def planners_of(asked):
    tap, task = asked.task.work, asked.task
    u, v = tap.at_m
    taps = [
        TouchPlanner(
            point_on(
                asked.prims[tap.on], (u, v + k * tap.up_m), str(asked.number + k), tap.on, tap,
                asked.impedance, task.instrument, cell_m=(0.1, 0.1),
            ),
            tap,
        )
        for k in range(2)
    ]
    return Planners(tuple(taps), taps[-1].point.in_front(tap.standoff_m))
""",
    "barometer_model": '''
from typing import Literal
from inspect_cli.schema.base import NonNegative
from inspect_cli.schema.vehicle.sensors.base import SensorModel

class BarometerModel(SensorModel):
    """Height by air pressure."""

    kind: Literal["barometer"]
    noise_m: NonNegative
''',
    "barometer_sensor": '''
from inspect_cli.records import Record, scalar

class Height(Record):
    """One height."""

    topic = "/sensor/barometer"
    height = scalar("m", "height of the body over the ground")

class Barometer:
    def __init__(self, model, rng):
        self.measurement = Height.create()
        self._model, self._rng = model, rng

    def sample(self, truth):
        self.measurement.t_s = truth.state.t_s
        noise = self._model.noise_m * self._rng.standard_normal()
        self.measurement.height = truth.state.p_WB[2] + noise
        return self.measurement

def barometer(model, around):
    return Barometer(model, around.rng)
''',
    "updraught_model": '''
from typing import Literal
from inspect_cli.schema.disturbances.base import DisturbanceModel

class Updraught(DisturbanceModel):
    """A steady force upwards."""

    kind: Literal["updraught"]
    force_n: float
''',
    "updraught_load": """
class UpdraughtLoad:
    def __init__(self, force_n):
        self._force_n = force_n

    def act(self, t_s, motion, load):
        load.force_W[2] += self._force_n

def updraught(entry, around):
    return UpdraughtLoad(entry.force_n)
""",
    "slope_model": '''
from typing import Literal
from inspect_cli.schema.specimens.base import SpecimenModel

class SlopeSpecimen(SpecimenModel):
    """A potential that falls along u."""

    model: Literal["slope"]
    slope_vpm: float
''',
    "slope_field": """
import numpy as np

class SlopeField:
    def __init__(self, model):
        self._model = model
        self.temperature_c = model.temperature_c

    def at(self, u, v):
        return -0.2 + self._model.slope_vpm * u, 100.0

    def active(self, uv_m):
        return np.zeros(len(uv_m), np.bool_)

def slope_field(model, root, patch):
    return SlopeField(model)
""",
}
ENTRY_POINTS = """
[inspect_cli.platforms]
survey_rotor = survey_rotor_model:SurveyRotorPlatform
[inspect_cli.vehicles]
survey_rotor = survey_rotor:SurveyRotor
[inspect_cli.tasks]
tap = tap_model:KIND
[inspect_cli.task_planners]
tap = tap_planner:planners_of
[inspect_cli.disturbances]
updraught = updraught_model:Updraught
[inspect_cli.loads]
updraught = updraught_load:updraught
[inspect_cli.specimens]
slope = slope_model:SlopeSpecimen
[inspect_cli.specimen_fields]
slope = slope_field:slope_field
"""
