"""From readings to findings: classes, populations, gradients, areas, interpolated maps."""
