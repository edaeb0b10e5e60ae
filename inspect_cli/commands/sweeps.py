"""Studies and their factors: one quantity is varied at a time, and each value gives a mission.

A study flies its variants, or, if it has a ``sampler``, computes their numbers without flying.

Missions and platforms are varied in memory: a variant is a copy of the loaded models with other
numbers, validated like a file. No file is read or written for it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar

from pydantic import BaseModel, ValidationError

from inspect_cli.errors import InputError
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.words.text import Text
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric
from inspect_cli.schema.study import Quantity, StudyColumn, StudyResult

Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True)
class Factor:
    """A quantity that a study varies."""

    option: str
    """The option of the command line that takes its values, without the dashes."""
    metavar: str
    """The form of the option's value in the help."""
    help: str
    """What the option varies, in a few words for the help."""
    name: str
    """The name of one value, also in names of folders."""
    symbol: str
    unit: str
    values: tuple[float, ...]
    """The default values."""
    base: Callable[[Loaded], float]
    """The value of a mission and its platform as they stand."""
    changed: Callable[[Loaded, float], Loaded]
    """The same mission with another value.

    Raises:
        ValueError: the value is impossible; pydantic's ValidationError is a ValueError.
    """

    def quantity(self, loaded: Loaded) -> Quantity:
        """The quantity of a mission that is varied."""
        return Quantity(name=self.name, symbol=self.symbol, unit=self.unit, base=self.base(loaded))


@dataclass(frozen=True)
class Study:
    """What is varied, which metrics are shown, and the figures."""

    title: str
    explained: Text
    """What is varied and what it is compared with, in sentences for the page."""
    factors: tuple[Factor, ...]
    columns: tuple[StudyColumn, ...]
    """Metrics of the catalogue, and those of ``own``."""
    refuse: Callable[[Loaded], None]
    """Raises InputError for a mission that this study cannot vary."""
    own: Mapping[str, MetricSpec]
    """Numbers of a flight beyond the catalogue, by name."""
    figures: tuple[Callable[[StudyResult], Figure], ...]
    sampler: Callable[[Loaded, int], Sampler] | None = None
    """Makes the sampler of a study that needs no flights from the mission and the seed."""
    flown_columns: tuple[StudyColumn, ...] = ()
    """Metrics of the catalogue that a study with a sampler shows in addition once it flies."""
    concluded: Callable[[StudyResult], StudyResult] | None = None
    """Adds thresholds and findings."""


@dataclass(frozen=True)
class Sampled:
    """A variant's numbers from its plan and from samples, without a flight, by metric."""

    metrics: Mapping[str, Metric]
    standard_errors: Mapping[str, float]


class Sampler(Protocol):
    """Computes a variant's numbers from its plan and from the true specimen."""

    @property
    def trials(self) -> int:
        """The number of samples that each mean is taken over."""
        ...

    @property
    def common(self) -> Mapping[str, Metric]:
        """Numbers of the true specimen, which are the same for every variant."""
        ...

    def __call__(self, variant: Variant, plan: Plan | CoveragePlan) -> Sampled:
        """The numbers of one variant."""
        ...


@dataclass(frozen=True)
class Variant:
    """The mission with one choice of the varied quantities."""

    name: str
    values: dict[str, float]
    loaded: Loaded


def variants(
    name: str, study: Study, loaded: Loaded, asked: Mapping[str, Sequence[float]]
) -> list[Variant]:
    """Every factor varied by itself, the others held at what the mission says.

    Values that two sweeps share give one variant. ``asked`` holds values by option; a factor
    whose option is not in it takes its default values.

    Raises:
        InputError: the study does not have an option, or a value is impossible.
    """
    options = [factor.option for factor in study.factors]
    for option in asked:
        if option not in options:
            hint = f"choices: {', '.join(f'--{known}' for known in options)}"
            raise InputError(f"the study '{name}' does not vary --{option}", hint=hint)
    base = {factor.name: factor.base(loaded) for factor in study.factors}
    chosen = [
        base | {factor.name: value}
        for factor in study.factors
        for value in asked.get(factor.option, factor.values)
    ]
    unique = {_named(study, values): values for values in chosen}
    return [
        Variant(label, values, _varied(name, study, loaded, values))
        for label, values in unique.items()
    ]


def numbers_of(option: str, text: str) -> tuple[float, ...]:
    """The numbers of an option's text, separated by commas.

    Raises:
        InputError: a part is no finite number.
    """
    return tuple(_number(option, part.strip()) for part in text.split(","))


def revalidated(model: Model, **changes: object) -> Model:
    """A copy with other entries, checked as if it had been read.

    Raises:
        ValidationError: an entry breaks the schema.
    """
    # By way of JSON, because a strict model takes no other form of everything it writes.
    changed = model.model_copy(update=changes)
    return type(model).model_validate_json(changed.model_dump_json(by_alias=True))


def _number(option: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        hint = f"write numbers with commas between them: --{option} 0.5,1,2"
        raise InputError(f"--{option}: '{text}' is not a finite number", hint=hint)
    return value


def _named(study: Study, values: Mapping[str, float]) -> str:
    return "-".join(f"{f.name}-{shortest(values[f.name])}" for f in study.factors)


def shortest(value: float) -> str:
    """A number in few digits, all of them where that would make two alike."""
    short = f"{value:g}"
    return short if float(short) == value else repr(value)


def _varied(name: str, study: Study, loaded: Loaded, values: Mapping[str, float]) -> Loaded:
    told = []
    changed = loaded
    for factor in study.factors:
        value = values[factor.name]
        try:
            changed = factor.changed(changed, value)
        except ValueError as error:
            what = f"--{factor.option}: {shortest(value)} {factor.unit} cannot be had"
            raise InputError(what, hint=_reason(error)) from error
        told.append(f"{factor.symbol} = {shortest(value)} {factor.unit}")
    choice = ", ".join(told)
    mission = changed.mission
    title = f"{mission.title or mission.name} ({choice})"
    words = f"A variant of the mission in the study “{name}”: {choice}, all else as it stands."
    return replace(changed, mission=revalidated(mission, title=title, description=words))


def _reason(error: ValueError) -> str:
    if isinstance(error, ValidationError):
        return error.errors(include_url=False)[0]["msg"]
    return str(error)
