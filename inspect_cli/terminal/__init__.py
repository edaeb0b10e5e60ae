"""What people read: tables, progress and problems on stderr."""

from inspect_cli.terminal.installation import (
    announce_compilation,
    print_campaign,
    print_diagnosis,
)
from inspect_cli.terminal.plans import print_any_plan
from inspect_cli.terminal.printing import print_lines, print_problems
from inspect_cli.terminal.progress import flight_progress, regression_progress
from inspect_cli.terminal.results import print_flight, print_readings, print_report
from inspect_cli.terminal.studies import print_regression, print_study

__all__ = [
    "announce_compilation",
    "flight_progress",
    "print_any_plan",
    "print_campaign",
    "print_diagnosis",
    "print_flight",
    "print_lines",
    "print_problems",
    "print_readings",
    "print_regression",
    "print_report",
    "print_study",
    "regression_progress",
]
