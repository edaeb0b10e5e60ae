"""Flies missions in parallel, compares their metrics with references, reports to CI servers."""
