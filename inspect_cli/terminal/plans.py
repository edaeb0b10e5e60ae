"""Plans of flights and surveys."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

if TYPE_CHECKING:
    from inspect_cli.schema.coverage import CoveragePlan
    from inspect_cli.schema.plan import Plan, Target
from inspect_cli.terminal.printing import (
    UNSURE,
    console,
    counted,
    grouped,
    near,
    number,
    print_warnings,
    table_of,
)

DIGITS = {"N": ".1f"}
"""How margins are shown, by their unit."""


def print_any_plan(plan: Plan | CoveragePlan, file: Path) -> None:
    """The plan of a flight or of a survey."""
    from inspect_cli.schema.coverage import CoveragePlan

    if isinstance(plan, CoveragePlan):
        print_survey_plan(plan, file)
    else:
        print_plan(plan, file)


def print_survey_plan(plan: CoveragePlan, file: Path) -> None:
    """The sorties with their points, times and energies, and the points that are left out."""
    out = console()
    _print_surfaces(plan.sorties[0].plan)
    margins = _margin_units(sortie.plan for sortie in plan.sorties)
    table = table_of(
        f"{plan.mission}: sorties",
        *("sortie", "points", "start x, y\n/m", "time\n/s", "energy\n/Wh", "way\n/m", "cable\n/m"),
        *(f"least\n{_words(name)}\nmargin /{unit}" for name, unit in margins.items()),
        "least\nclearance\n/m",
    )
    for sortie in plan.sorties:
        flight = sortie.plan
        table.add_row(
            str(sortie.number),
            str(len(flight.targets)),
            ", ".join(f"{x:.1f}" for x in flight.start.p_WB[:2]),
            f"{flight.duration_s:.0f}",
            f"{flight.energy_wh:.1f}",
            f"{flight.path_m:.1f}",
            f"{flight.cable_m:.1f}",
            *(
                number(_least_margin(flight, name), DIGITS.get(margins[name], ".2f"))
                for name in margins
            ),
            number(min(_clearances(flight), default=None), ".2f"),
        )
    out.print(table)
    for reason, labels in grouped((p.reason, p.label) for p in plan.skipped).items():
        many = "s" if len(labels) > 1 else ""
        text = Text.assemble((f"left out, point{many} {', '.join(labels)}: ", UNSURE), reason)
        out.print(text, soft_wrap=True)
    out.print(
        f"{counted(plan.points, 'point')} in {counted(len(plan.sorties), 'sortie')}, "
        f"{len(plan.skipped)} left out, "
        f"{plan.tour_m:.1f} m through all standoffs"
    )
    out.print(
        f"{plan.duration_s:.0f} s and {plan.energy_wh:.1f} Wh in all, "
        f"at most {plan.budget_wh:.1f} Wh in each sortie"
    )
    for sortie in plan.sorties:
        print_warnings(f"sortie {sortie.number}: {w}" for w in sortie.plan.warnings)
    out.print(f"plan: {near(file)}", soft_wrap=True)


def print_plan(plan: Plan, file: Path) -> None:
    """The surfaces, the points in the order of the flight, and what the flight takes."""
    out = console()
    _print_surfaces(plan)
    margins = _margin_units([plan])
    points = table_of(
        f"{plan.mission}: targets",
        *("target", "kind", "surface", "x, y, z /m", "press\n/m", "force\n/N"),
        *(f"{_words(name)}\nmargin\n/{unit}" for name, unit in margins.items()),
        "clear-\nance\n/m",
    )
    for target in plan.targets:
        points.add_row(
            target.label,
            target.kind,
            target.surface or "",
            ", ".join(f"{x:.3f}" for x in target.p_WC),
            number(None if target.kind == "pose" else target.press_m, ".2f"),
            number(None if target.kind == "pose" else target.expected_force_n, ".2f"),
            *(number(_margin(target, name), DIGITS.get(margins[name], ".2f")) for name in margins),
            number(target.clearance_m, ".2f"),
        )
    out.print(points)
    out.print(
        f"{plan.duration_s:.0f} s, {plan.path_m:.1f} m, {plan.energy_wh:.1f} Wh, "
        f"cable {plan.cable_m:.1f} m"
    )
    print_warnings(plan.warnings)
    out.print(f"plan: {near(file)}", soft_wrap=True)


def _clearances(plan: Plan) -> list[float]:
    return [t.clearance_m for t in plan.targets if t.clearance_m is not None]


def _margin_units(plans: Iterable[Plan]) -> dict[str, str]:
    """The units of all margins that the targets have, by their names."""
    targets = (target for plan in plans for target in plan.targets)
    return {name: one.unit for target in targets for name, one in target.margins.items()}


def _margin(target: Target, name: str) -> float | None:
    margin = target.margins.get(name)
    return None if margin is None else margin.value


def _least_margin(plan: Plan, name: str) -> float | None:
    values = (_margin(target, name) for target in plan.targets)
    return min((value for value in values if value is not None), default=None)


def _words(name: str) -> str:
    return name.replace("_", " ")


def _print_surfaces(plan: Plan) -> None:
    surfaces = table_of(f"{plan.mission}: surfaces", "surface", "shape", "from", "fit")
    for surface in plan.surfaces:
        fit = surface.fit
        quality = f"{fit.inlier_share:.0%} within, rms {1000 * fit.rms_m:.1f} mm" if fit else ""
        surfaces.add_row(surface.name, surface.shape.kind, surface.source, quality)
    if plan.surfaces:
        console().print(surfaces)
