"""Sensor faults: which sensor, from when to when, and what NaN spoils."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from inspect_cli.records import Probe
from inspect_cli.schema.truth import SensorFault
from inspect_cli.truth.faults import PATCH_PIXELS, Faults, punch_holes, spoil


@pytest.mark.parametrize(
    ("t_s", "active"), [(0.0, False), (4.999, False), (5.0, True), (6.999, True), (7.0, False)]
)
def test_a_fault_lasts_from_its_start_up_to_its_end(t_s: float, active: bool) -> None:
    faults = Faults([SensorFault(sensor="tof", start_s=5.0, end_s=7.0)])
    assert (faults.active("tof", t_s) is not None) == active
    assert faults.active("pose", t_s) is None


def test_without_an_end_it_lasts_for_ever() -> None:
    faults = Faults([SensorFault(sensor="tof", start_s=5.0)])
    assert faults.active("tof", 1e6) is not None


def test_the_first_of_two_faults_at_a_time_holds() -> None:
    faults = Faults(
        [
            SensorFault(sensor="probe", fault="nan", start_s=1.0, end_s=2.0),
            SensorFault(sensor="probe", fault="off"),
        ]
    )
    early, late = faults.active("probe", 1.5), faults.active("probe", 3.0)
    assert early is not None
    assert late is not None
    assert (early.fault, late.fault) == ("nan", "off")


def test_spoiling_leaves_the_time_alone() -> None:
    probe = Probe.create()
    probe.t_s, probe.force = 3.0, 1.8
    spoil(probe)
    assert probe.t_s == 3.0
    assert np.isnan([probe.potential, probe.resistance, probe.force]).all()


@pytest.mark.parametrize("share", [0.001, 0.1, 0.5, 0.9, 0.99])
def test_holes_take_their_share_to_the_pixel(share: float) -> None:
    rng = np.random.default_rng(3)
    lost = []
    for _ in range(5):
        image = np.ones((48, 64, 3))
        punch_holes(image, share, rng)
        gone = np.isnan(image)
        assert (gone.all(axis=2) == gone.any(axis=2)).all()  # a pixel is lost as a whole
        assert gone[:, :, 0].sum() == round(share * 48 * 64)
        lost.append(gone[:, :, 0])
    assert not any((a == b).all() for a, b in pairwise(lost))


def test_holes_are_patches_and_lie_everywhere() -> None:
    """Where a pixel is lost its neighbour mostly is; singly lost ones would be at 10 %."""
    rng = np.random.default_rng(4)
    count, pairs, alike = np.zeros((48, 64)), 0, 0
    for _ in range(400):
        image = np.ones((48, 64, 3))
        punch_holes(image, 0.1, rng)
        lost = np.isnan(image[:, :, 0])
        count += lost
        pairs += lost[:, :-1].sum()
        alike += (lost[:, :-1] & lost[:, 1:]).sum()
    mean_wide = 0.5 * (PATCH_PIXELS[0] + PATCH_PIXELS[1] - 1)
    assert alike / pairs > 1.0 - 1.5 / mean_wide
    # 400 images of a tenth: 40 ± 6 in every pixel; holes reach beyond the border, so that it too
    # is lost as often as the middle.
    assert count.min() > 10
    assert count[[0, -1]].mean() == pytest.approx(40.0, rel=0.15)
    assert count[10:-10, 10:-10].mean() == pytest.approx(40.0, rel=0.1)


def test_the_same_seed_makes_the_same_holes() -> None:
    images = []
    for seed in (1, 1, 2):
        image = np.ones((48, 64, 3))
        punch_holes(image, 0.5, np.random.default_rng(seed))
        images.append(image)
    np.testing.assert_array_equal(images[0], images[1])
    assert not np.array_equal(np.isnan(images[0]), np.isnan(images[2]))
