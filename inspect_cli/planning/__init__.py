"""Before the flight: contact poses, order, path, feasibility, the Plan. Pure functions."""
