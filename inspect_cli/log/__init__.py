"""Writing and reading flight logs in MCAP."""
