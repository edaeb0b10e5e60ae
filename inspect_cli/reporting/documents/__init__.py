"""Whole reports: of a flight, of a survey of several sorties, of readings from a file."""
