"""What is said about an installation and a new campaign."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

if TYPE_CHECKING:
    from inspect_cli.commands.doctor import Diagnosis
    from inspect_cli.commands.init import Campaign
from inspect_cli.terminal.printing import STYLES, UNSURE, console


def announce_compilation(*, shown: bool) -> None:
    """Say why the first run of an installation takes longer."""
    if not shown or os.environ.get("NUMBA_DISABLE_JIT", "0") != "0":
        return
    places = [Path(__file__).parent.parent, Path.home() / ".cache" / "numba"]
    if "NUMBA_CACHE_DIR" in os.environ:
        places = [Path(os.environ["NUMBA_CACHE_DIR"])]
    if not any(next(place.rglob("*.nbi"), None) for place in places):
        console().print("first run of this installation: compiling, once, some 15 s")


def print_campaign(made: Campaign) -> None:
    """A new campaign folder and the first thing to do in it."""
    out = console()
    out.print(f"made {made.folder} with {len(made.files)} files")
    if made.first_mission:
        out.print(f"next: cd {made.folder}; inspect fly {made.first_mission}", soft_wrap=True)


def print_diagnosis(diagnosis: Diagnosis) -> None:
    """What was examined, what was found, and how to mend what fails."""
    out = console()
    for finding in diagnosis.findings:
        verdict = Text(f"{finding.verdict:<8}", style=STYLES[finding.verdict])
        out.print(Text.assemble(verdict, f"{finding.what}: {finding.found}"), soft_wrap=True)
    for finding in diagnosis.findings:
        if finding.hint:
            out.print(Text.assemble((f"{finding.what}: ", UNSURE), finding.hint), soft_wrap=True)
