"""Figures and tables of a flight: path, tracking, forces, modes, and each kind of experiment."""
