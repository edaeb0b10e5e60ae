"""Draws a Result and a RunLog as HTML and CSV. It never computes a finding."""
