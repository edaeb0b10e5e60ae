"""The bare physics of a flight: MuJoCo's ``mj_step`` with the flight's inputs at the same steps.

``mujoco.rollout`` cannot replay a flight: the plant changes the rotors' time constants and the
factors of near surfaces, which are fields of the model, and a rollout holds the model. The replay
is therefore a compiled loop that calls ``mj_step`` by its address, as rollout's loop in C does,
and writes the inputs before each stretch of steps: the part ``mjSTATE_USER`` of the state
(controls, applied forces, plates) and the parameters of the actuators. Nothing else is computed.

With inputs that a rollout can take, the loop is as fast as ``mujoco.rollout`` on one thread.
"""

from __future__ import annotations

import ctypes
from pathlib import Path
from time import perf_counter
from typing import Any

import mujoco
import numba
import numpy as np

STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
INPUTS = mujoco.mjtState.mjSTATE_USER
START = mujoco.mjtState.mjSTATE_INTEGRATION
"""State, inputs and the solver's warm start: all that the next step depends on but the model."""

_library = ctypes.CDLL(str(next(Path(mujoco.__file__).parent.glob("libmujoco*"))))
_step, _set_state = _library.mj_step, _library.mj_setState
_step.argtypes, _step.restype = (ctypes.c_void_p, ctypes.c_void_p), None
_set_state.argtypes = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int)
_set_state.restype = None


@numba.njit
def _replay(
    model: int,
    data: int,
    kind: int,
    steps: np.ndarray,
    inputs: np.ndarray,
    parameters: np.ndarray,
    dynprm: np.ndarray,
    gainprm: np.ndarray,
) -> None:
    """Stretch k takes ``steps[k]`` steps with ``inputs[k]`` and ``parameters[k]`` (2, nu, n)."""
    for k in range(steps.shape[0]):
        _set_state(model, data, inputs[k].ctypes.data, kind)
        for i in range(dynprm.shape[0]):
            for j in range(dynprm.shape[1]):
                dynprm[i, j] = parameters[k, 0, i, j]
                gainprm[i, j] = parameters[k, 1, i, j]
        for _ in range(steps[k]):
            _step(model, data)


class Replay:
    """Records the inputs of one flight through ``plant.step``, then repeats its physics.

    The inputs of a stretch are read after it, because the plates are placed at its beginning; the
    physics itself changes none of them. They have to hold throughout the stretch; if they did
    not, the replay would not end in the flight's state.
    """

    def __init__(self, plant: Any) -> None:
        self._plant = plant
        self._stretches: list[tuple[int, np.ndarray, np.ndarray]] = []
        self._start = self._end = np.empty(0)
        step = plant.step

        def recording_step(steps: int) -> None:
            if not self._stretches:
                self._start = _state(plant.model, plant.data, START)
            step(steps)
            inputs = _state(plant.model, plant.data, INPUTS)
            fields = (plant.model.actuator_dynprm, plant.model.actuator_gainprm)
            self._stretches.append((steps, inputs, np.array(fields)))

        plant.step = recording_step

    def finish(self) -> None:
        """End the recording and prepare the replay."""
        model = self._plant.model
        self._end = _state(model, self._plant.data, STATE)
        steps, inputs, parameters = zip(*self._stretches, strict=True)
        self._inputs = (np.array(steps), np.array(inputs), np.array(parameters))
        self._data = mujoco.MjData(model)
        self.run_s()  # compiles

    def run_s(self) -> float:
        """The time of the physics, s."""
        model, data = self._plant.model, self._data
        mujoco.mj_setState(model, data, self._start, START)
        fields = (model.actuator_dynprm, model.actuator_gainprm)
        begun = perf_counter()
        _replay(model._address, data._address, int(INPUTS), *self._inputs, *fields)
        return perf_counter() - begun

    @property
    def error(self) -> float:
        """The largest difference of the last replay's end from the flight's, in the state's units.

        The state holds the time, positions, velocities and activations (s, m, rad, m/s, rad/s, N).
        """
        return float(np.abs(_state(self._plant.model, self._data, STATE) - self._end).max())


def _state(model: mujoco.MjModel, data: mujoco.MjData, kind: mujoco.mjtState) -> np.ndarray:
    state = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, state, kind)
    return state
