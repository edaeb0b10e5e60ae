"""The scene of a flight in MuJoCo: visible vehicle, structure, marks, and how they move."""
