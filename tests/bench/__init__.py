"""What has a limit, measured: ``python -m tests.bench`` with nothing else running."""
