"""What the readings of one surface come to, as ``metrics.json`` has it."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import Strict

AstmClass = Literal["passive", "uncertain", "active"]
Populations = Literal["one population", "two populations"]


class Basis(Strict):
    """What potentials against CSE at the standard's temperature rest on."""

    electrode: str = "CSE"
    """With which it was read."""
    conversion_mv: float = 0.0
    """What was added to have it against CSE."""
    temperature_c: float | None = None
    temperature_correction_mv: float = 0.0
    """What was added to have it at 22.2 °C."""
    temperature_why: str = ""
    """Why nothing was."""
    own_temperatures_c: tuple[float, float] | None = None
    """Least and greatest temperature where each reading has its own; what stands above then says
    nothing of temperature."""
    own_corrections_mv: tuple[float, float] | None = None
    """Least and greatest amount that was added for it."""
    without_temperature: int = 0
    """Readings whose temperature is not known beside others whose is."""
    merged_readings: int = 0
    """Readings that were made one with another at the same place."""


class ClassShare(Strict):
    """How much of a surface is in one class."""

    name: str
    count: int
    share: float
    """Of the points that have a class; 0 without any."""
    area_m2: float | None


class Crossed(Strict):
    """How many points have a potential of one class and a resistivity of another."""

    astm_class: AstmClass
    resistivity_class: str | None
    """None: the resistivity is not known."""
    count: int


class PotentialStatistics(Strict):
    """Of the valid potentials; percentiles between two readings are linear."""

    min_mv: float
    median_mv: float
    mean_mv: float
    max_mv: float
    sd_mv: float | None
    """Of a sample; None of a single reading."""
    p5_mv: float
    p10_mv: float
    p25_mv: float
    p50_mv: float
    p75_mv: float
    p90_mv: float
    p95_mv: float


class ConditionCount(Strict):
    """Points whose potential is typical of a condition by RILEM TC 154-EMC; conditions overlap."""

    name: str
    low_mv: float
    high_mv: float
    count: int


class Minimum(Strict):
    """A negative minimum of the potential and how it rises around it."""

    label: str
    uv_m: tuple[float, float]
    potential_mv: float
    rise_mv: float | None
    """To the highest reading within 1 m; None without another."""
    rise_within_m: float | None
    """Distance of the nearest reading at least 100 mV higher; None without one within 1 m."""
    active: bool


class GradientFindings(Strict):
    """RILEM TC 154-EMC: a rise of 100 mV within 1 m of a minimum indicates active corrosion."""

    minima: int
    active: int
    not_judged: int
    """Minima without another reading within 1 m."""
    steepest: tuple[Minimum, ...]
    """The steepest of them first, at most as many as the summary has room for."""
    least_depth_mv: float = 20.0
    """How deep a hollow had to be for its bottom to count."""
    scatter_mv: float | None = None
    """Standard deviation of a single reading around its neighbours; None where it is not known."""
    why: str = ""
    """Why there is nothing to judge."""


class Population(Strict):
    """A normal population of potentials with the standard errors of its estimates."""

    share: float
    """Of the readings."""
    mean_mv: float
    mean_error_mv: float | None
    sd_mv: float
    sd_error_mv: float | None


class MixtureFindings(Strict):
    """Whether the potentials are of two populations, and which."""

    verdict: Populations | None
    why: str = ""
    """Why there is no verdict, or only one population."""
    bic_one: float | None = None
    bic_two: float | None = None
    active: Population | None = None
    """The more negative one; where neither is known, there is no second."""
    passive: Population | None = None
    share_error: float | None = None
    errors_why: str = ""
    threshold_mv: float | None = None
    """Where a reading belongs to either population with probability one half."""
    threshold_error_mv: float | None = None
    threshold_why: str = ""
    active_limit_mv: float | None = None
    """95 % of the active population lie below it."""
    passive_limit_mv: float | None = None
    """95 % of the passive population lie above it."""


class Proposal(Strict):
    """A place to read between two neighbours that differ much."""

    between: tuple[str, str]
    uv_m: tuple[float, float]
    difference_mv: float


class RefinementFindings(Strict):
    """ASTM C876: a closer spacing where neighbours differ by more than 150 mV."""

    total: int
    greatest: tuple[Proposal, ...]
    """The greatest differences first, at most as many as the summary has room for."""
    why: str = ""


class RepeatabilityFindings(Strict):
    """What readings at the same place say of the measurement."""

    places: int
    """Read more than once."""
    degrees_of_freedom: int
    sd_mv: float | None
    """Standard deviation within a place, pooled."""
    greatest_sd_mv: float | None
    """Of a single place."""
    disagreeing: int = 0
    """Places whose readings differ by more than 20 mV."""
    worst: str | None = None
    """The point at that of them where they differ most."""
    worst_spread_mv: float | None = None
    """Greatest less least of its readings."""
    why: str = ""


class UncertaintyFindings(Strict):
    """Standard uncertainty of the points' potentials; medians over the valid points."""

    median_mv: float | None
    max_mv: float | None
    reading_mv: float | None
    repeatability_mv: float | None
    conversion_mv: float = 0.0
    """By the conversion to CSE; 0 where a CSE was read with."""
    temperature_mv: float
    single_reading_mv: float
    """Standard deviation of one reading at a place."""
    single_reading_from: str
    """Where that comes from."""
    doubtful: int
    """Points whose class by ASTM C876 is less than 95 % certain."""
    why: str = ""


class SurfaceAssessment(Strict):
    """The findings of one surface. A reading at a place is a point, however often it was read."""

    surface: str
    basis: Basis
    readings: int
    """As they were given, the invalid ones too."""
    points: int
    """Different places."""
    valid: int
    """Points with a potential."""
    invalid: int
    spacing_m: tuple[float, float] | None
    """Typical distance between neighbours along u and v."""
    area_m2: float | None
    """That the points stand for, valid or not."""
    invalid_area_m2: float | None
    area_why: str = ""
    """Why there is no area."""
    astm: tuple[ClassShare, ...]
    potential: PotentialStatistics | None
    potential_why: str = ""
    conditions: tuple[ConditionCount, ...]
    no_condition: int
    """Valid points that are typical of none of them."""
    gradient: GradientFindings
    mixture: MixtureFindings
    resistivity_known: int
    """Points with a resistivity."""
    rates: tuple[ClassShare, ...]
    """Langford & Broomfield."""
    risks: tuple[ClassShare, ...]
    """RILEM TC 154-EMC."""
    verdicts: tuple[ClassShare, ...]
    """The combined rule."""
    astm_by_rate: tuple[Crossed, ...]
    astm_by_risk: tuple[Crossed, ...]
    refinement: RefinementFindings
    repeatability: RepeatabilityFindings
    uncertainty: UncertaintyFindings
