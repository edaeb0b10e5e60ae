"""Kinds, sensors and tasks of installed packages are known to every worker process."""

from __future__ import annotations

import pytest

pytestmark = pytest.mark.xdist_group("crawlers")  # the flights of both


def test_two_kinds_of_packages_are_flown_by_two_workers(crawlers):
    flights = {(f["mission"], f["verdict"]) for f in crawlers.regression["missions"]}
    assert flights == {("lean-and-prop", "pass"), ("stiff-lean", "pass")}
