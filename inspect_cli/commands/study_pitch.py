"""The study ``pitch``: what a wider grid saves, and what it misses.

The cost of each pitch is planned over the same surface, what it finds is sampled
(``commands.pitch_sampling``), and with ``--fly`` every pitch is flown once besides. Points that
the refinement rule would add in flight are left out: the pitch alone is varied.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from inspect_cli.assessment.classes import SUSTAINS_CORROSION_OHM_M
from inspect_cli.commands.half_cell_sampling import half_cell_verdicts
from inspect_cli.commands.pitch_sampling import POSITION_SD_M, GridWork, PitchSampler, Verdicts
from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.commands.sweeps import Factor, Study, revalidated, shortest
from inspect_cli.commands.truth_under_surface import truth_under_surfaces
from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.reporting.studies.pitch_figures import (
    ACTIVE,
    DETECTED,
    DURATION,
    ENERGY,
    FALSE,
    LEVEL,
    MISSED,
    POINTS,
    SITES,
    SORTIES,
    TOO_RESISTIVE,
    cost_figure,
    pitch_figure,
)
from inspect_cli.reporting.words.pitch_findings import (
    FALSELY_ACTIVE,
    OF_AREA,
    OF_SITES,
    TOO_RESISTIVE_BY_RULE,
    UNSTEADY,
    Thresholds,
    written,
)
from inspect_cli.reporting.words.text import number, say
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.study import StudyColumn, StudyResult, StudyVariant, Threshold
from inspect_cli.schema.tasks.contact_grid import ContactGrid
from inspect_cli.schema.tasks.coverage import Coverage
from inspect_cli.spatial.arrays import Points
from inspect_cli.truth.rasters import all_under_surfaces

WHOLE_LINES = 1e-9
VERDICTS: Mapping[str, Verdicts] = {"half_cell": half_cell_verdicts}
"""The instruments whose readings can be sampled without a flight: one row each."""


def _work(loaded: Loaded) -> GridWork:
    """The mission's grid.

    Raises:
        InputError: it has none to vary.
    """
    tasks = loaded.mission.tasks
    work = tasks[0].work
    if len(tasks) != 1 or not isinstance(work, ContactGrid | Coverage):
        raise _refused(
            loaded,
            "the study 'pitch' needs a mission with a single task, a coverage or a contact_grid",
            "see missions/wall_pitch_study.yaml",
        )
    return work


def _refuse(loaded: Loaded) -> None:
    work = _work(loaded)
    if loaded.mission.tasks[0].instrument is None:
        raise _refused(loaded, "the study 'pitch' needs readings; sensor: none takes none", "")
    if loaded.mission.tasks[0].instrument not in VERDICTS:
        hint = f"it can sample: {', '.join(VERDICTS)}"
        raise _refused(loaded, "the study 'pitch' cannot sample this task's instrument", hint)
    if isinstance(work, ContactGrid) and work.rows * work.columns == 1:
        raise _refused(loaded, "a single point has no pitch to vary", "give more rows or columns")
    entry = loaded.truth.structure.get(work.on)
    if entry is None or entry.specimen is None or entry.absent:
        raise _refused(
            loaded,
            f"the study 'pitch' needs a specimen beneath '{work.on}': what is there to be found",
            f"give one under truth: structure: {work.on}: specimen",
        )


def _refused(loaded: Loaded, what: str, hint: str) -> InputError:
    return InputError(Problem(what, Location(str(loaded.mission_file)), hint))


def _pitch(loaded: Loaded) -> float:
    return _work(loaded).pitch_m


def _with_pitch(loaded: Loaded, pitch_m: float) -> Loaded:
    """The same extent with another pitch; the rows and columns of a grid follow."""
    work, task = _work(loaded), loaded.mission.tasks[0]
    changed: GridWork
    if isinstance(work, Coverage):
        changed = revalidated(work, pitch_m=pitch_m, refine=None)
        task = revalidated(task, coverage=changed)
    else:
        lines = {name: _lines(work, name, pitch_m) for name in ("rows", "columns")}
        changed = revalidated(work, pitch_m=pitch_m, **lines)
        task = revalidated(task, contact_grid=changed)
    return replace(loaded, mission=revalidated(loaded.mission, tasks=(task,)))


def _lines(grid: ContactGrid, name: str, pitch_m: float) -> int:
    """How many rows or columns keep the extent of so many pitches; a single line stays one."""
    count = int(getattr(grid, name))
    if count == 1 or not pitch_m > 0.0:  # the schema refuses the pitch
        return count
    extent_m = count * grid.pitch_m
    found = math.floor(extent_m / pitch_m + WHOLE_LINES)
    if found < 1:
        raise ValueError(f"the {name} cover {extent_m:g} m: not even one would be left")
    return found


def _sampler(loaded: Loaded, seed: int) -> PitchSampler:
    """The region that the mission itself covers, and what is truly beneath it."""
    as_it_stands = _with_pitch(loaded, _pitch(loaded))
    plan = plan_loaded(as_it_stands, vehicle_of(as_it_stands))
    one = plan.joined() if isinstance(plan, CoveragePlan) else plan
    structure = truth_under_surfaces(loaded, one.surfaces)
    work = _work(as_it_stands)
    beneath = next(b for b in all_under_surfaces(structure, one.surfaces) if b.surface == work.on)
    verdicts = VERDICTS[as_it_stands.mission.tasks[0].instrument or ""]
    return PitchSampler(as_it_stands, work, beneath, _planned(one), seed, verdicts)


def _planned(plan: Plan) -> Points:
    return np.array([target.uv_m for target in plan.targets if target.uv_m is not None])


def _concluded(result: StudyResult) -> StudyResult:
    """With the pitches at which area and sites are first missed, in numbers and in words."""
    pitches = result.sweep(result.quantities[0])
    said = {DETECTED: OF_AREA, SITES: OF_SITES}
    thresholds = tuple(_threshold(result, pitches, metric) for metric in said)
    words = tuple(_in_words(pitches, threshold, said[threshold.metric]) for threshold in thresholds)
    doubts = (doubt for t in thresholds for doubt in _unsure(pitches, t, said[t.metric]))
    more = (*doubts, *_unsteady(pitches), *_falsely(result, pitches), *_too_resistive(result))
    return result.model_copy(update={"thresholds": thresholds, "findings": words + more})


def _threshold(result: StudyResult, pitches: tuple[StudyVariant, ...], metric: str) -> Threshold:
    quantity = result.quantities[0].name
    below = (v.values[quantity] for v in pitches if (v.value(metric) or 0.0) < LEVEL)
    return Threshold(metric=metric, quantity=quantity, level=LEVEL, first_below=next(below, None))


def _in_words(pitches: tuple[StudyVariant, ...], threshold: Threshold, said: Thresholds) -> str:
    at = [variant.values[threshold.quantity] for variant in pitches]
    first, k = threshold.first_below, _decisive(pitches, threshold)
    share, error = _percent(pitches[k], threshold.metric)
    level, pitch = f"{100.0 * threshold.level:g}", shortest(at[k])
    here = {"level": level, "pitch": pitch, "share": share, "error": error}
    if first is None or k == 0:
        return written(said.never if first is None else said.always, **here)
    before, before_error = _percent(pitches[k - 1], threshold.metric)
    finer = shortest(at[k - 1])
    return written(said.first, **here, before=before, before_error=before_error, finer=finer)


def _decisive(pitches: tuple[StudyVariant, ...], threshold: Threshold) -> int:
    """Which pitch is the first below the level; the widest where none is."""
    at = [variant.values[threshold.quantity] for variant in pitches]
    return len(at) - 1 if threshold.first_below is None else at.index(threshold.first_below)


def _unsure(
    pitches: tuple[StudyVariant, ...], threshold: Threshold, said: Thresholds
) -> Iterator[str]:
    """The pitches on either side of the level that chance may have put there."""
    k = _decisive(pitches, threshold)
    for variant in pitches[max(k - 1, 0) : k + 1]:
        error = variant.standard_errors.get(threshold.metric, 0.0)
        if abs((variant.value(threshold.metric) or 0.0) - threshold.level) < 2.0 * error:
            pitch = shortest(variant.values[threshold.quantity])
            yield written(said.unsure, pitch=pitch, level=f"{100.0 * threshold.level:g}")


def _percent(variant: StudyVariant, metric: str) -> tuple[str, str]:
    value, error = variant.value(metric) or 0.0, variant.standard_errors.get(metric, 0.0)
    return f"{100.0 * value:.1f}", f"{100.0 * error:.1f}"


def _falsely(result: StudyResult, pitches: tuple[StudyVariant, ...]) -> Iterator[str]:
    """What finding so much costs: sound surface that is called active, at the finest pitch."""
    active, false_m2 = result.common.get(ACTIVE), pitches[0].value(FALSE)
    if active is None or not active.value or not false_m2:
        return
    yield written(
        FALSELY_ACTIVE,
        false=f"{false_m2:.3f}",
        active=f"{active.value:.3f}",
        pitch=shortest(pitches[0].values[result.quantities[0].name]),
    )


def _too_resistive(result: StudyResult) -> Iterator[str]:
    """What the rule itself misses, whatever the pitch; nothing where it misses nothing."""
    found, active = result.common.get(TOO_RESISTIVE), result.common.get(ACTIVE)
    if found is None or not found.value or active is None or not active.value:
        return
    yield written(
        TOO_RESISTIVE_BY_RULE,
        area=f"{found.value:.3f}",
        share=f"{100.0 * found.value / active.value:.1f}",
        limit=f"{SUSTAINS_CORROSION_OHM_M:g}",
    )


def _unsteady(pitches: tuple[StudyVariant, ...]) -> Iterator[str]:
    """Where a wider grid missed less than can be chance; nobody should take that for a rule."""
    for finer, wider in pairwise(pitches):
        gain = (finer.value(MISSED) or 0.0) - (wider.value(MISSED) or 0.0)
        errors = (v.standard_errors.get(MISSED, 0.0) for v in (finer, wider))
        if gain > 2.0 * math.hypot(*errors):
            a, b = (shortest(v.values["pitch"]) for v in (finer, wider))
            yield written(UNSTEADY, wider=b, finer=a)


PITCH = Study(
    title="Pitch of the grid: cost against detection",
    explained=say(
        "The pitch p of the grid is varied over the region that the mission covers. Points, "
        "sorties, time and energy are planned. What is found is sampled: the grid is laid onto "
        "the region with 20 offsets, stratified over one pitch along u and v, and the readings "
        "are simulated from the specimen by the probe's own model with its noise. They are "
        "taken where the tool truly is: at its point plus a normal error along u and along v, "
        "with a standard deviation of {external} mm if poses come from an external tracker and "
        "{onboard} mm if from odometry on board. Every place of the region stands for its "
        "nearest reading, and the verdict, by potential and resistivity together, is held "
        "against what is truly so. Numbers with ± are means over the offsets with their "
        "standard errors: they tell of where the grid lies on this surface, not of other "
        "surfaces. A site is a connected truly active region, and it is found when a point "
        "within it was judged active; one beside it finds area of it only.",
        external=number(1e3 * POSITION_SD_M["external"], 0),
        onboard=number(1e3 * POSITION_SD_M["onboard"], 0),
    ),
    factors=(
        Factor(
            option="pitch",
            metavar="P,P,…",
            help="pitches of the grid, m",
            name="pitch",
            symbol="p",
            unit="m",
            values=(0.1, 0.15, 0.25, 0.5),
            base=_pitch,
            changed=_with_pitch,
        ),
    ),
    columns=(
        StudyColumn(metric=POINTS, heading="Points", unit="1"),
        StudyColumn(metric=SORTIES, heading="Sorties", unit="1"),
        StudyColumn(metric=DURATION, heading="Time, planned", unit="s"),
        StudyColumn(metric=ENERGY, heading="Energy, planned", unit="Wh"),
        StudyColumn(metric=MISSED, heading="Missed area", unit="m²"),
        StudyColumn(metric=FALSE, heading="False area", unit="m²"),
        StudyColumn(metric=DETECTED, heading="Detected share, of area", unit="1"),
        StudyColumn(metric=SITES, heading="Found share, of sites", unit="1"),
    ),
    refuse=_refuse,
    own={},
    figures=(pitch_figure, cost_figure),
    sampler=_sampler,
    flown_columns=(
        StudyColumn(metric="scoring.missed_area_m2", heading="Missed area, flown", unit="m²"),
        StudyColumn(metric="scoring.false_area_m2", heading="False area, flown", unit="m²"),
        StudyColumn(metric="scoring.detected_share", heading="Detected share, flown", unit="1"),
        StudyColumn(metric="scoring.sites_found", heading="Sites found, flown", unit="1"),
        StudyColumn(metric="flight.duration_s", heading="Time, flown", unit="s"),
        StudyColumn(metric="flight.energy_wh_flown", heading="Energy, flown", unit="Wh"),
    ),
    concluded=_concluded,
)
