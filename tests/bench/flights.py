"""The flight loop against the bare physics.

A flight with everything (sensors, estimation, guidance, control, recording, the log down to its
last byte) is timed in turns with ``mujoco.rollout`` of the same model: the same controls at the
same steps from the same state, on one thread, into memory that is already there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

import mujoco
import numpy as np
from mujoco import rollout

from inspect_cli.autonomy.executive import posture_of
from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import CORE_RECORDS
from inspect_cli.schema.loading import Loaded
from inspect_cli.simulation.loop import Flight
from inspect_cli.truth.geometry import true_structure
from inspect_cli.vehicles.contacts import wrench_record
from tests.bench.rows import Row

PAIRS = 5
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
CONTROL = (
    mujoco.mjtState.mjSTATE_CTRL
    | mujoco.mjtState.mjSTATE_MOCAP_POS
    | mujoco.mjtState.mjSTATE_MOCAP_QUAT
)
"""What the plant sets between two steps: commands, and the plates under the tip."""


@dataclass(frozen=True)
class Timed:
    """One flight: wall-clock times of the whole and of its log, and the time that was flown."""

    wall_s: float
    log_s: float
    flight_s: float


class Pair:
    """Flies a mission, and replays what its plant was told."""

    def __init__(self, loaded: Loaded, folder: Path) -> None:
        self._loaded = loaded
        self._vehicle = vehicle_of(loaded)
        self._plan = plan_loaded(loaded, self._vehicle)
        self._file = folder / "flight.mcap"
        self._prepare_replay()

    def fly(self) -> Timed:
        """Fly once and close the log."""
        flight, log = self._flight()
        begun = perf_counter()
        ending = flight.run()
        landed = perf_counter()
        log.close(ending.status, ending.reason)
        closed = perf_counter()
        log_s = ending.log_wall_s + closed - landed
        return Timed(closed - begun, log_s, ending.flight_s)

    def replay_s(self) -> float:
        """The time of the bare physics."""
        begun = perf_counter()
        rollout.rollout(
            self._model,
            self._data,
            self._start,
            self._controls,
            control_spec=int(CONTROL),
            state=self._states,
            sensordata=self._sensors,
        )
        return perf_counter() - begun

    def _flight(self) -> tuple[Flight, LogWriter]:
        lengths = self._vehicle.capabilities.lengths
        contacts = [wrench_record(contact.name) for contact in self._vehicle.contacts]
        log = LogWriter(self._file, [*CORE_RECORDS, *contacts], lengths)
        loaded = self._loaded
        seed = loaded.mission.seeds[0]
        structure = true_structure(loaded.truth, self._plan.surfaces, loaded.root)
        estimation = loaded.mission.estimation
        flight = Flight(self._vehicle, self._plan, loaded.truth, structure, seed, log, estimation)
        return flight, log

    def _prepare_replay(self) -> None:
        """Fly once, which also compiles every kernel, and keep the controls of each step."""
        flight, log = self._flight()
        plant, told = flight.plant, []
        step = plant.step

        def remembering(steps: int) -> None:
            told.append((control_of(plant.data), steps))
            step(steps)

        plant.step = remembering
        ending = flight.run()
        log.close(ending.status, ending.reason)
        plant.place(posture_of(self._plan.start))
        self._model, self._data = plant.model, [mujoco.MjData(plant.model)]
        start = np.empty(mujoco.mj_stateSize(plant.model, STATE))
        mujoco.mj_getState(plant.model, plant.data, start, STATE)
        self._start = start[None]
        controls = np.concatenate([np.tile(ctrl, (steps, 1)) for ctrl, steps in told])
        self._controls = controls[None]
        self._states = np.zeros((1, len(controls), len(start)))
        self._sensors = np.zeros((1, len(controls), plant.model.nsensordata))


def control_of(data: mujoco.MjData) -> np.ndarray:
    """The numbers of CONTROL, in MuJoCo's order."""
    return np.concatenate([data.ctrl, data.mocap_pos.ravel(), data.mocap_quat.ravel()])


def measure(loaded: Loaded, name: str) -> Iterator[Row]:
    """Medians over pairs of a flight and a replay."""
    with TemporaryDirectory() as folder:
        pair = Pair(loaded, Path(folder))
        pairs = [(pair.fly(), pair.replay_s()) for _ in range(PAIRS)]
    ratio = median(flown.wall_s / bare_s for flown, bare_s in pairs)
    yield Row(f"{name}.ratio_to_open_loop", ratio, "1", 2.5)
    factor = median(flown.flight_s / flown.wall_s for flown, _ in pairs)
    yield Row(f"{name}.real_time_factor", factor, "1", 30.0, "min")
    share = median(flown.log_s / flown.wall_s for flown, _ in pairs)
    yield Row(f"{name}.log_share", share, "1", 0.10)
