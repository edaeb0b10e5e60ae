"""Four measured slabs, evaluated again with NumPy alone on the files' own numbers."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import norm
from surveyed import grid, readings

from inspect_cli.assessment.assess import Assessed, assess

PITCH_M = 0.1016
SLABS = ("slab1", "slab2", "slab3", "slab4")
Slab = tuple[np.ndarray, np.ndarray, Assessed]


@pytest.fixture(scope="module", params=SLABS)
def slab(request: pytest.FixtureRequest, shared_data: Path) -> Slab:
    """Potentials (29, 9), mV, resistivities (29, 9), kΩ·cm, and what we make of them."""
    folder = shared_data / "half_cell"
    with (folder / f"{request.param}.csv").open() as file:
        rows = list(csv.reader(file))
    mv = np.array([[float(cell) for cell in row[1:]] for row in rows[1:]])
    kohm_cm = np.loadtxt(folder / "resistivity_S1AC.txt")
    return mv, kohm_cm, assess(request.param, readings(grid(9, 29, PITCH_M), mv, 10.0 * kohm_cm))


@pytest.mark.real_data
def test_statistics(slab: Slab) -> None:
    mv, _, found = slab
    s = found.summary.potential
    assert s is not None
    assert (s.min_mv, s.max_mv) == (mv.min(), mv.max())
    assert (s.median_mv, s.mean_mv) == (np.median(mv), mv.reshape(-1).mean())
    for p in (5, 10, 25, 50, 75, 90, 95):
        assert getattr(s, f"p{p}_mv") == np.percentile(mv, p)


@pytest.mark.real_data
def test_classes_and_areas(slab: Slab) -> None:
    mv, kohm_cm, found = slab
    s = found.summary
    cell = PITCH_M**2
    assert s.area_m2 == pytest.approx(261 * cell)
    masks = {"passive": mv > -200, "uncertain": (mv <= -200) & (mv >= -350), "active": mv < -350}
    for share in s.astm:
        count = np.count_nonzero(masks[share.name])
        assert (share.count, share.share) == (count, count / 261)
        assert share.area_m2 == pytest.approx(count * cell)
    fast = masks["active"] & (kohm_cm <= 10.0)
    verdicts = {"none": masks["passive"], "active": fast, "possible": ~masks["passive"] & ~fast}
    assert {v.name: v.count for v in s.verdicts} == {
        name: np.count_nonzero(mask) for name, mask in verdicts.items()
    }
    rates = {
        "low": kohm_cm > 20,
        "low to moderate": (kohm_cm <= 20) & (kohm_cm > 10),
        "high": (kohm_cm <= 10) & (kohm_cm >= 5),
        "very high": kohm_cm < 5,
    }
    for cell_of in s.astm_by_rate:
        if cell_of.resistivity_class is None:
            assert cell_of.count == 0
        else:
            both = masks[cell_of.astm_class] & rates[cell_of.resistivity_class]
            assert cell_of.count == np.count_nonzero(both)


@pytest.mark.real_data
def test_conditions(slab: Slab) -> None:
    mv, _, found = slab
    for c in found.summary.conditions:
        assert c.count == np.count_nonzero((mv >= c.low_mv) & (mv <= c.high_mv))


@pytest.mark.real_data
def test_refinement(slab: Slab) -> None:
    mv, _, found = slab
    across, along = np.abs(np.diff(mv, axis=0)), np.abs(np.diff(mv, axis=1))
    refinement = found.summary.refinement
    steep = np.concatenate([across[across > 150], along[along > 150]])
    assert refinement.total == len(steep)
    assert [p.difference_mv for p in refinement.greatest] == sorted(steep, reverse=True)[:20]


@pytest.mark.real_data
def test_gradients(slab: Slab) -> None:
    """Each minimum is one among its eight neighbours, its rise the highest reading in 1 m."""
    mv, _, found = slab
    uv = grid(9, 29, PITCH_M)
    padded = np.pad(mv, 1, constant_values=np.inf)
    around = np.stack(
        [padded[1 + i : 30 + i, 1 + j : 10 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
    )
    local = set(np.flatnonzero(mv <= around.min(axis=0)))
    assert set(found.minima.index.tolist()) <= local
    assert int(np.argmin(mv)) in found.minima.index
    flat = mv.reshape(-1)
    for i, rise in zip(found.minima.index, found.minima.rise_mv, strict=True):
        near = np.linalg.norm(uv - uv[i], axis=1) <= 1.0
        assert rise == flat[near].max() - flat[i]


@pytest.mark.real_data
def test_populations(slab: Slab) -> None:
    """Both likelihoods by scipy on the file's numbers; the BIC decides by them."""
    mv, _, found = slab
    mixture = found.mixture
    assert not isinstance(mixture, str)
    x = mv.reshape(-1)
    one = norm.logpdf(x, x.mean(), x.std()).sum()
    (mean_a, mean_p), (sd_a, sd_p), w = mixture.mean_mv, mixture.sd_mv, mixture.weight
    two = np.log(w * norm.pdf(x, mean_a, sd_a) + (1 - w) * norm.pdf(x, mean_p, sd_p)).sum()
    assert mixture.log_likelihood == pytest.approx(two, abs=1e-6)
    better = 2 * (two - one) - 3 * np.log(261) > 10
    verdict = "two populations" if better else "one population"
    assert found.summary.mixture.verdict == verdict


@pytest.mark.real_data
def test_uncertainty(slab: Slab) -> None:
    mv, _, found = slab
    sd = 1e3 * found.budget.total_v.reshape(29, 9)
    unsure = np.zeros_like(mv, dtype=bool)
    for mask, p in (
        (mv > -200, norm.sf(-200, mv, sd)),
        ((mv <= -200) & (mv >= -350), norm.cdf(-200, mv, sd) - norm.cdf(-350, mv, sd)),
        (mv < -350, norm.cdf(-350, mv, sd)),
    ):
        unsure |= mask & (p < 0.95)
    assert found.summary.uncertainty.doubtful == np.count_nonzero(unsure)
