"""In flight: the local surface from depth points, pursuit of it, smooth references."""
