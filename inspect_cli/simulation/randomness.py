"""One seed per run, spawned by component name, so that adding a sensor reshuffles no other."""

from __future__ import annotations

import zlib

import numpy as np


def component_rng(seed: int, name: str) -> np.random.Generator:
    """The generator of a named component in the run with this seed."""
    sequence = np.random.SeedSequence(entropy=seed, spawn_key=(zlib.crc32(name.encode()),))
    return np.random.Generator(np.random.SFC64(sequence))


def sortie_seed(seed: int, number: int) -> int:
    """The seed of one of the flights that a run with this seed consists of."""
    sequence = np.random.SeedSequence(entropy=seed, spawn_key=(zlib.crc32(b"sortie"), number))
    return int(sequence.generate_state(1)[0])
