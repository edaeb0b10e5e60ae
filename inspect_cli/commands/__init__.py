"""Plain functions behind the command line: they call the rooms below and print nothing."""
