"""The kernels that step the physics do what MuJoCo's own Python functions do, also uncompiled."""

from __future__ import annotations

import os
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from inspect_cli.compiled import bound, kernel
from inspect_cli.simulation.stepping import advance, refresh

FALLING = """
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 0.1"/>
    <body pos="0 0 0.12"><freejoint/>
      <geom type="box" size="0.1 0.1 0.1"/><site name="tip" pos="0.1 0.1 0.1"/>
    </body>
  </worldbody>
</mujoco>
"""


def thrown() -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A box that turns and is about to hit the ground."""
    model = mujoco.MjModel.from_xml_string(FALLING)
    data = mujoco.MjData(model)
    data.qvel[:] = (0.3, -0.2, -1.0, 2.0, 1.0, -3.0)
    return model, data


def test_steps_are_those_of_mujoco_to_the_last_bit() -> None:
    """The same state after 200 steps, contacts included, in one stretch or in several."""
    model, expected = thrown()
    mujoco.mj_step(model, expected, 200)
    _, data = thrown()
    count = np.zeros(1, np.int32)
    step = bound(advance, model._address, data._address, count)
    for count[0] in (1, 150, 49):
        step()
    assert np.array_equal(data.qpos, expected.qpos)
    assert np.array_equal(data.qvel, expected.qvel)
    assert data.time == expected.time


def test_kinematics_are_brought_up_to_date() -> None:
    """Sites follow positions that were changed from outside."""
    model, data = thrown()
    data.qpos[:3] = (1.0, 2.0, 3.0)
    bound(refresh, model._address, data._address)()
    assert data.site("tip").xpos == pytest.approx([1.1, 2.1, 3.1])


@kernel
def scaled_sum(values: np.ndarray, total: np.ndarray, factor: float) -> None:
    """Add factor · Σ values to total (1,)."""
    for i in range(values.size):
        total[0] += factor * values[i]


def test_a_bound_kernel_sees_what_its_arrays_hold_now() -> None:
    """Arrays are bound, not their numbers; an added integer becomes the float of the example."""
    values, total = np.array([1.0, 2.0]), np.zeros(1)
    add = bound(scaled_sum, values, total, then=(0.0,))
    add(2)
    values[0] = 10.0
    add(0.5)
    assert total[0] == 6.0 + 6.0


def test_without_compilation_the_other_checks_pass() -> None:
    """With ``NUMBA_DISABLE_JIT=1`` the same kernels run as plain Python and step by ctypes."""
    others = [sys.executable, "-m", "pytest", "-q", "-k", "not without_compilation", __file__]
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTEST_ADDOPTS": "-p no:cacheprovider"}
    run = subprocess.run(others, env=plain, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "3 passed" in run.stdout
