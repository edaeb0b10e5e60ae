"""The error-state filter and the momentum wrench observer."""
