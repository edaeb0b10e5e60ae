"""Kinds, sensors, tasks and a chapter of installed packages are known to every worker process."""

from __future__ import annotations

import json
import shutil

from packages import HERE, install, python


def test_two_kinds_of_packages_are_flown_by_two_workers(tmp_path):
    site, campaign = tmp_path / "site", tmp_path / "campaign"
    install(site, "pitching_crawler", "stiff_crawler")
    shutil.copytree(HERE / "crawler_campaign", campaign)
    done = python(
        site, campaign, "-m", "inspect_cli", "regress", "--jobs", "2", "--update", "--json"
    )
    report = json.loads(done.stdout)
    assert done.returncode == 0, done.stderr
    flights = {(flight["mission"], flight["verdict"]) for flight in report["missions"]}
    assert flights == {("lean-and-prop", "pass"), ("stiff-lean", "pass")}
