"""Readings that people took: tables and lists, whole or refused by the cell."""
