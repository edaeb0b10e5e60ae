"""Rendered pictures and films of a flight, from its log."""
