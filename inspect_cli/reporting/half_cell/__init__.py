"""Half-cell potentials in a report: maps, classes, populations, tables and sentences."""
