"""The bench: a machine folder becomes nodes, wiring and a schedule."""
