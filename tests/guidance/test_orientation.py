"""The rule that turns a tool towards a surface."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.guidance.orientation import contact_orientation, heading_orientation


def unit(v):
    return np.asarray(v, dtype=np.float64) / np.linalg.norm(v)


@pytest.mark.parametrize("n", [[-1, 0, 0], [0.3, -0.8, 0.5], [0.1, 0.2, -0.9], [0.0, 0.0, 1.0]])
@pytest.mark.parametrize("hint", [[0, 1, 0], [0, -1, 0], [-1, 0.3, 0]])
def test_is_a_rotation_that_presses_along_the_normal_with_a_level_y_axis(n, hint):
    n, hint = unit(n), np.asarray(hint, dtype=np.float64)
    R = contact_orientation(n, hint)
    assert np.allclose(R.T @ R, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert np.allclose(R[:, 2], -n)
    assert R[2, 1] == pytest.approx(0.0, abs=1e-12)
    assert R[:, 1] @ hint >= -1e-12


def test_faces_a_wall_with_the_tool_ahead():
    # Wall to the east, body heading east: z_T east, y_T north, x_T down.
    R = contact_orientation(np.array([-1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    assert np.allclose(R, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]])


@pytest.mark.parametrize("tilt_deg", [0.0, 0.9])
def test_a_vertical_tool_keeps_its_heading(tilt_deg):
    tilt = np.radians(tilt_deg)
    n = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    hint = unit([0.5, 0.8, 0.0])
    R = contact_orientation(n, hint)
    assert np.arccos(R[:, 1] @ hint) <= tilt + 1e-7
    assert np.allclose(R, heading_orientation(n, hint))


def test_a_hint_along_the_normal_is_refused():
    with pytest.raises(ValueError, match="along the surface's normal"):
        heading_orientation(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0]))
