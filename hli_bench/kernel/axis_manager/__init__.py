"""Axis management: which axes home in which order."""
