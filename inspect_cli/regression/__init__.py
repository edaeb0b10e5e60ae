"""Flies missions in parallel, compares their metrics with references, tells CI."""
