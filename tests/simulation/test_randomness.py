"""Every component has its own numbers, whoever else draws."""

from __future__ import annotations

import numpy as np

from inspect_cli.simulation.randomness import component_rng


def draw(seed: int, name: str) -> list[float]:
    return component_rng(seed, name).standard_normal(8).tolist()


def test_the_same_seed_and_name_repeat() -> None:
    assert draw(3, "imu") == draw(3, "imu")


def test_another_seed_or_name_differs() -> None:
    everything = [draw(seed, name) for seed in range(4) for name in ("imu", "pose", "tof", "probe")]
    values = np.array(everything).ravel()
    assert np.unique(values).size == values.size


def test_streams_are_not_correlated() -> None:
    names = ("imu", "pose", "tof", "probe")
    long = np.array([component_rng(1, name).standard_normal(20_000) for name in names])
    off = np.corrcoef(long) - np.eye(len(names))
    assert np.abs(off).max() < 5.0 / np.sqrt(20_000)
