"""Templates of the findings of the study ``pitch``, which ``study.json`` holds in English.

The study fills these templates, and ``recorded`` knows the sentences again by them.
"""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.reporting.words.text import Said, say


@dataclass(frozen=True)
class Thresholds:
    """The sentences on where a share falls below a level as the pitch grows."""

    never: Said
    always: Said
    first: Said
    unsure: Said


OF_AREA = Thresholds(
    say(
        "Detection stays at {level} % or above up to the widest pitch, {pitch} m: "
        "{share} ± {error} % of the truly active area is judged active there."
    ),
    say(
        "Detection is below {level} % at the finest pitch already, {pitch} m: "
        "{share} ± {error} % of the truly active area is judged active there."
    ),
    say(
        "Detection first drops below {level} % at a pitch of {pitch} m: {share} ± {error} % of "
        "the truly active area is judged active there, {before} ± {before_error} % at {finer} m."
    ),
    say(
        "At {pitch} m the share of the area lies within two standard errors of {level} %: other "
        "offsets of the grid could put it on the other side."
    ),
)
OF_SITES = Thresholds(
    say(
        "Detection of whole sites stays at {level} % or above up to the widest pitch, {pitch} m: "
        "{share} ± {error} % of the sites are found there."
    ),
    say(
        "Detection of whole sites is below {level} % at the finest pitch already, {pitch} m: "
        "{share} ± {error} % of the sites are found there."
    ),
    say(
        "Detection of whole sites first drops below {level} % at a pitch of {pitch} m: "
        "{share} ± {error} % of the sites are found there, "
        "{before} ± {before_error} % at {finer} m."
    ),
    say(
        "At {pitch} m the share of the sites lies within two standard errors of {level} %: other "
        "offsets of the grid could put it on the other side."
    ),
)
UNSTEADY = say(
    "The grid of {wider} m missed less area than that of {finer} m, by more than twice the "
    "standard error: active sites on this surface lie in step with the grid."
)
FALSELY_ACTIVE = say(
    "Beside {active} m² that are truly active, {false} m² of sound surface are judged active at "
    "{pitch} m already."
)
TOO_RESISTIVE_BY_RULE = say(
    "Over {area} m² ({share} %) of the truly active area the concrete truly has more than {limit} "
    "Ω·m. A reading there is possible at the most by the combined rule, at any pitch; only one "
    "beside it can be judged active."
)

PITCH_FINDINGS: tuple[Said, ...] = (
    *(OF_AREA.never, OF_AREA.always, OF_AREA.first, OF_AREA.unsure),
    *(OF_SITES.never, OF_SITES.always, OF_SITES.first, OF_SITES.unsure),
    UNSTEADY,
    FALSELY_ACTIVE,
    TOO_RESISTIVE_BY_RULE,
)


def written(finding: Said, **values: str) -> str:
    """The finding as ``study.json`` holds it."""
    return finding.template.format(**values)
