"""Angles between many attitudes or directions at once."""

from __future__ import annotations

import numpy as np

from inspect_cli.spatial.arrays import Points, Vector


def attitude_angle(q_a: Points, q_b: Points) -> Vector:
    """The angle of the rotation between attitudes, (n,) rad in [0, π].

    θ = 4 asin(min(|a − b|, |a + b|) / 2) for unit quaternions, which keeps its precision near
    zero; q and −q are the same attitude.

    Args:
        q_a, q_b: (n, 4) quaternions wxyz, normalised here.

    Source: Hartley et al., "Rotation averaging", IJCV 103 (2013), section 4 (quaternion distance).
    """
    a = _normalized(q_a)
    b = _normalized(q_b)
    chord = np.minimum(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    angles: Vector = 4.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0))
    return angles


def direction_angle(a: Points, b: Points) -> Vector:
    """The angle between directions, (n,) rad in [0, π].

    θ = 2 asin(|a − b| / 2) for unit vectors, which keeps its precision near zero.

    Args:
        a, b: (n, 3), normalised here.
    """
    chord = np.linalg.norm(_normalized(a) - _normalized(b), axis=1)
    angles: Vector = 2.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0))
    return angles


def _normalized(x: Points) -> Points:
    scaled: Points = x / np.linalg.norm(x, axis=1, keepdims=True)
    return scaled
