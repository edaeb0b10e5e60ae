"""Simulated sensors. They may read the truth; what they return is all that flies on."""
