"""Where every number comes from: files, versions, seed, plan, chosen constants."""

from __future__ import annotations

import hashlib

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.table import NOTHING, Column, definitions, number, table
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


def provenance(log: RunLog, result: Result, plan: Plan) -> list[Block]:
    """Everything that is needed to compute the page again; it holds no time of day."""
    platform = log.platform()
    mission = log.mission()
    facts = definitions(
        [
            ("Mission", result.mission),
            ("Platform", f"{result.platform} ({platform.kind})"),
            ("Impedance profile", mission.impedance),
            ("Estimation", mission.estimation),
            ("Seed", NOTHING if result.seed is None else str(result.seed)),
            ("Planned duration", f"{number(plan.duration_s, 1)} s"),
            ("Planned energy", f"{number(plan.energy_wh, 1)} Wh"),
            ("Planned path", f"{number(plan.path_m, 1)} m"),
        ]
    )
    source = (
        element("p", element("strong", "Source of the platform's numbers. "), platform.source)
        if platform.source
        else ""
    )
    return joined(facts, source, _warnings(plan), _versions(log), _files(log), _chosen(log))


def _warnings(plan: Plan) -> list[Block]:
    if not plan.warnings:
        return Markup("")
    items = (element("li", warning) for warning in plan.warnings)
    return joined(element("h3", "Warnings of the planner"), element("ul", *items))


def _versions(log: RunLog) -> list[Block]:
    if not log.versions:
        return Markup("")
    rows = [[name, version] for name, version in sorted(log.versions.items())]
    return table(
        "Versions of what computed the flight.", [Column(say("Software")), Column(say("Version"))], rows
    )


def _files(log: RunLog) -> list[Block]:
    rows = [
        [name, number(len(data), 0), element("code", hashlib.sha256(data).hexdigest())]
        for name, data in sorted(log.attachments.items())
    ]
    columns = [
        Column(say("Attachment")),
        Column(say("Size"), "bytes", numeric=True),
        Column(say("SHA-256"), prose=True),
    ]
    return table("Files that the log carries.", columns, rows)


def _chosen(log: RunLog) -> list[Block]:
    """Numbers of the platform that no source gives, each with its reason."""
    chosen = log.platform().chosen
    if not chosen:
        return Markup("")
    rows = [[name, reason] for name, reason in sorted(chosen.items())]
    return table(
        "Numbers of the platform that no source gives, and why they were chosen.",
        [Column(say("Number")), Column(say("Reason"), prose=True)],
        rows,
    )
