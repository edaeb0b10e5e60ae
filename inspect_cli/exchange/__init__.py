"""Readings for other programs: CSV, GeoJSON, IFC."""
