"""How nodes are stepped through time: schedule, lock-step, trace. Knows no node by name."""
