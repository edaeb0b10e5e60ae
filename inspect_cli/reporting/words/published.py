"""Published values for each row of the ledger that a mission's check may name by ``ref``.

Rows A1 to A9 are the experiments of Bodie et al., "An Omnidirectional Aerial Manipulation
Platform for Contact-Based Inspection", Robotics: Science and Systems 2019. The words are those
of the ledger, the numbers those of the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.reporting.words.text import Said, Text, say, significant, together


@dataclass(frozen=True)
class Published:
    """What a publication reports of one experiment."""

    section: str
    words: str
    """The published result as a sentence without its full stop."""
    short: str
    """The number alone, for a narrow table; empty if there is none."""
    table: str = ""
    """Number of the table in the section."""

    def cited(self, metric: str) -> Text:
        """The words with their place; of a row with several numbers, the one of the metric."""
        words: Text = Said(self.words)
        if metric in NUMBERS:
            value, unit = NUMBERS[metric]
            words = together(significant(value, 6), f" {unit}")
        if self.table:
            return say(
                "{words} (§\u00a0{section}, Table {table})",
                words=words,
                section=self.section,
                table=self.table,
            )
        return say("{words} (§\u00a0{section})", words=words, section=self.section)


SOURCE = "Bodie et al., RSS 2019"

PUBLISHED: dict[str, Published] = {
    "A1": Published(
        "V-B", "compliant in the pulled direction, stiff in the others, at m* 0.25 in x and y", ""
    ),
    "A2": Published(
        "V-B", "larger motion for a smaller force than in the first test, at m* 0.1", ""
    ),
    "A3": Published("V-B", "less than 0.3 m under 25 N lateral, at m* 5", "< 0.3 m"),
    "A4": Published("V-B", "three pulls, yaw clearly compliant, at I* 0.25 about z", ""),
    "A5.yaw": Published("V-B", "yaw deviation 0.5 rad under 3 N·m, all multipliers 5", "0.5 rad"),
    "A5.pos": Published("V-B", "less than 0.1 m under up to 8 N, all multipliers 5", "< 0.1 m"),
    "A6.att": Published("V-C", "attitude error within 0.07 rad", "≤ 0.07 rad"),
    "A6.repeat": Published("V-C", "two trials draw the same shape; no number is given", ""),
    "A6.force": Published(
        "V-C", "consistent contact force between contact and release; no number is given", ""
    ),
    "A7.slide": Published("V-D", "0.53 m on the surface at 0.17 m/s on average, contact kept", ""),
    "A7.drift": Published(
        "V-D",
        "the estimator drifts several centimetres at first contact, which stays reliable",
        "several cm",
    ),
    "A7.axis": Published("V-D", "attitude changes about y_T only while sliding", ""),
    "A8.force": Published("V-E", "1.8 N in the contact phase, set-point 10 cm behind", "1.8 N"),
    "A8.map": Published("V-E", "corrosion at points 2 and 3 of nine", "points 2, 3"),
    "A8.track": Published(
        "V-E", "precise tracking along all axes outside contact; no number is given", ""
    ),
    "A9.state": Published(
        "V-F",
        "RMSE x 0.0123 m, y 0.0106 m, roll 0.0577 rad, pitch 0.0488 rad, yaw 0.0129 rad; "
        "larger in motion than in hover",
        "",
        "IV",
    ),
    "A9.force": Published(
        "V-F",
        "RMSE f_x 1.62 N, mostly the slow response to the step, f_y 0.91 N, f_z 0.93 N",
        "",
        "IV",
    ),
    "A9.stable": Published(
        "V-F",
        "stable with the apparent mass changed between contacts, set-point 0.6 m behind",
        "stable",
    ),
}

TABLE_IV: dict[str, tuple[str, float, str]] = {
    "estimation.rmse_x_m": ("x", 0.0123, "m"),
    "estimation.rmse_y_m": ("y", 0.0106, "m"),
    "estimation.rmse_roll_rad": ("roll", 0.0577, "rad"),
    "estimation.rmse_pitch_rad": ("pitch", 0.0488, "rad"),
    "estimation.rmse_yaw_rad": ("yaw", 0.0129, "rad"),
    "force_sensor.rmse_fx_n": ("f_x", 1.62, "N"),
    "force_sensor.rmse_fy_n": ("f_y", 0.91, "N"),
    "force_sensor.rmse_fz_n": ("f_z", 0.93, "N"),
}
"""Root mean square errors of pose and force estimates by the metric that answers each: what it is
called there, the number, its unit. The row of z is not legible in the table."""


NUMBERS: dict[str, tuple[float, str]] = {
    "slide.distance_m": (0.53, "m"),
    "slide.speed_mean_mps": (0.17, "m/s"),
    "estimation.expected_rmse_x_m": (0.0123, "m"),
    "estimation.expected_rmse_y_m": (0.0106, "m"),
    "estimation.expected_rmse_yaw_rad": (0.0129, "rad"),
    **{metric: (value, unit) for metric, (_, value, unit) in TABLE_IV.items()},
}
"""The number that a metric answers with its unit, where a row has several."""


OTHERS: dict[tuple[str, str], str] = {
    ("A3", "pull.force_peak_n"): "25 N",
    ("A5.yaw", "pull.torque_peak_nm"): "3 N·m",
    ("A5.pos", "pull.force_peak_n"): "8 N",
    ("A8.force", "contact.force_peak_n"): "",
}
"""Where a metric answers not a row's number but under what it holds, or nothing published."""


def number_of(ref: str | None, metric: str) -> str:
    """The published number that a check answers, for a narrow table; empty where there is none."""
    published = published_of(ref)
    if ref is None or published is None:
        return ""
    if (ref, metric) in OTHERS:
        return OTHERS[ref, metric]
    if published.short or metric not in NUMBERS:
        return published.short
    value, unit = NUMBERS[metric]
    return f"{value:g} {unit}"


def published_of(ref: str | None) -> Published | None:
    """What was published for the row that a check names; None for a row that is not here."""
    return PUBLISHED.get(ref) if ref else None
