"""Formats a regression's report as JUnit XML, which CI servers read.

Format: the Ant JUnit schema as Jenkins, GitLab and GitHub actions understand it: one test case
per flight, ``failure`` for a flight that does not pass, ``error`` for one that could not be
flown, ``skipped`` for one that fails only as its mission declares.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree

from inspect_cli.regression.outcome import FlightReport, RegressReport
from inspect_cli.regression.verdict import describe

NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 excludes even when escaped (section 2.2, Char)."""


def junit_xml(report: RegressReport) -> str:
    """The document, well-formed whatever the messages hold."""
    flights = report.missions
    errors = sum(flight.status is None for flight in flights)
    suite = ElementTree.Element(
        "testsuite",
        name="inspect regress",
        tests=str(len(flights)),
        failures=str(report.failed - errors),
        errors=str(errors),
        skipped=str(report.known),
        time=f"{sum(flight.wall_s for flight in flights):.3f}",
    )
    for flight in flights:
        _add(suite, flight)
    suites = ElementTree.Element("testsuites")
    suites.append(suite)
    ElementTree.indent(suites)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        + ElementTree.tostring(suites, encoding="unicode")
        + "\n"
    )


def _add(suite: ElementTree.Element, flight: FlightReport) -> None:
    case = ElementTree.SubElement(
        suite,
        "testcase",
        classname=_clean(flight.mission),
        name=_clean(f"{flight.platform}-seed{flight.seed}"),
        time=f"{flight.wall_s:.3f}",
    )
    known = [describe(check) for check in flight.checks if check.verdict == "fail-known"]
    if flight.verdict == "fail":
        kind = "error" if flight.status is None else "failure"
        found = ElementTree.SubElement(case, kind, message=_clean(_first_line(flight)))
        found.text = _clean("\n".join([*flight.reasons, flight.details]).strip())
    elif flight.verdict == "fail-known":
        ElementTree.SubElement(case, "skipped", message=_clean("known: " + "; ".join(known)))


def _first_line(flight: FlightReport) -> str:
    return flight.reasons[0].splitlines()[0] if flight.reasons and flight.reasons[0] else "failed"


def _clean(text: str) -> str:
    return NOT_XML.sub("\ufffd", text)
