"""Sentences of assessments and maps, recognised by their templates; see ``recorded``."""

from __future__ import annotations

from inspect_cli.reporting.words.text import Said, say

FINDINGS: tuple[Said, ...] = (
    # Classes of resistivity, and conditions of concrete.
    *(say("low"), say("low to moderate"), say("high"), say("very high")),
    *(say("negligible"), say("moderate"), say("unread")),
    say("water-saturated, without oxygen"),
    say("moist, chloride-contaminated"),
    say("moist, chloride-free"),
    say("moist, carbonated"),
    say("dry, carbonated"),
    say("dry, non-carbonated"),
    # Why there is no area, gradient, refinement or repeatability.
    say("nothing was read"),
    say("a single place has no spacing; state the pitch"),
    say("fewer than two valid readings have no neighbours"),
    say("readings are {apart} m apart; the criterion compares those within 1 m"),
    say("no negative minimum is {depth} mV deep"),
    say("no place was read twice"),
    # Readings of a place that contradict each other.
    say(
        "The readings at the place of point {label} differ by {spread} mV; repeated readings "
        "should agree within 10 mV (ASTM C876)."
    ),
    say(
        "At {n} places the readings differ by more than 20 mV, most at the place of point {label}, "
        "by {spread} mV; repeated readings should agree within 10 mV (ASTM C876)."
    ),
    # Populations.
    say("valid readings: {n}; two populations ask for at least {least}"),
    say("all readings are equal to their resolution"),
    say("a second population does not lower the BIC by more than 10"),
    say("the second would hold 1 reading: that is an outlier, not a population"),
    say(
        "the second would hold {n} readings by expectation, fewer than {least}: those are "
        "outliers, not a population"
    ),
    say(
        "the second would be as narrow as the readings' resolution: that is a value that repeats, "
        "not a population"
    ),
    say("one population has no readings"),
    say("a population is as narrow as the readings' resolution"),
    say("the likelihood is flat in one direction: the populations cannot be told apart"),
    say("one population prevails between the means"),
    # Where a standard deviation comes from, and why nothing was corrected for temperature.
    say("ASTM C876: two readings of a place differ by at most {limit} mV"),
    say("repeated readings, {n} degrees of freedom"),
    say("the temperature is not known; it is taken to be within 22.2 ± 5.5 °C"),
    say("within 22.2 ± 5.5 °C its effect is negligible (ASTM C876)"),
    say("0.9 mV/°C is the coefficient of a CSE, not of {name}: nothing is corrected"),
    # Why there is no map.
    say("there are no valid readings"),
    say("all {n} valid readings are at one place"),
    say("{n} valid reading is too few for a map, which needs {least}"),
    say("{n} places with valid readings are too few for a map, which needs {least}"),
    say("the valid readings are in one line: there is no area between them"),
    say("no three readings stand near enough to each other to draw between them"),
)
