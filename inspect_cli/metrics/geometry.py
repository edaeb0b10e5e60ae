"""Angles between many attitudes or directions at once, and vectors turned by many attitudes."""

from __future__ import annotations

import numpy as np

from inspect_cli.spatial.arrays import Points, Vector

SMALL_SINE = 1e-12
"""Below it a rotation's angle is its sine, to the last digit."""


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


def rotation_vectors(q_a: Points, q_b: Points) -> Points:
    """Log(R_aᵀ R_b), (n, 3) rad: what turns frame a into frame b, about a's axes.

    Args:
        q_a, q_b: (n, 4) quaternions wxyz, normalised here.
    """
    a, b = _normalized(q_a), _normalized(q_b)
    va, vb = a[:, 1:], b[:, 1:]
    w = np.sum(a * b, axis=1)
    v = a[:, :1] * vb - b[:, :1] * va - np.cross(va, vb)
    sine = np.linalg.norm(v, axis=1)
    angle = 2.0 * np.arctan2(sine, np.abs(w))
    scale = np.where(sine > SMALL_SINE, angle / np.where(sine > SMALL_SINE, sine, 1.0), 2.0)
    vectors: Points = (np.where(w < 0.0, -scale, scale))[:, None] * v
    return vectors


def turned_by(q: Points, x: Points) -> Points:
    """R(q) x, (n, 3), for quaternions (n, 4) wxyz, normalised here, and vectors (n, 3)."""
    unit = _normalized(q)
    v = unit[:, 1:]
    t = 2.0 * np.cross(v, x)
    turned: Points = x + unit[:, :1] * t + np.cross(v, t)
    return turned


def turned_back_by(q: Points, x: Points) -> Points:
    """R(q)ᵀ x, (n, 3)."""
    return turned_by(q * np.array([1.0, -1.0, -1.0, -1.0]), x)


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
