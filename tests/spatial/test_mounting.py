"""The frame of a mounted sensor, against SciPy's rotations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.schema.vehicle import MountModel
from inspect_cli.spatial.mounting import Mounting

BODY = Rotation.from_rotvec([0.3, -0.2, 0.9])
TOOL = BODY * Rotation.from_rotvec([0.0, 0.7, 0.0])
P_WB = np.array([1.0, -2.0, 1.5])
P_WT = P_WB + BODY.apply([0.55, 0.0, 0.1])
POSITION = (0.16, -0.05, 0.06)
TURN = (0.1, 0.4, -0.2)


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), TURN])
@pytest.mark.parametrize("axes", ["body", "tool"])
@pytest.mark.parametrize("frame", ["body", "tool"])
def test_its_origin_and_its_axes_go_with_their_frames(
    frame: str, axes: str, turn: tuple[float, float, float]
) -> None:
    frames = {"body": (P_WB, BODY), "tool": (P_WT, TOOL)}
    origin, attitude = frames[frame]
    p_WD, R_WD = Mounting(
        MountModel(frame=frame, position_m=POSITION, axes=axes, rotation_rad=turn)
    ).pose(P_WB, BODY.as_quat(scalar_first=True), P_WT, TOOL.as_matrix())
    np.testing.assert_allclose(p_WD, origin + attitude.apply(POSITION), atol=1e-12)
    expected = frames[axes][1] * Rotation.from_rotvec(turn)
    np.testing.assert_allclose(R_WD, expected.as_matrix(), atol=1e-12)


def test_axes_of_the_tool_are_handed_on_as_they_are() -> None:
    R_WT = TOOL.as_matrix()
    mounting = Mounting(MountModel(frame="body", position_m=POSITION, axes="tool"))
    assert mounting.pose(P_WB, BODY.as_quat(scalar_first=True), P_WT, R_WT)[1] is R_WT
