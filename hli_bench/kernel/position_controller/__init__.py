"""Position controller: history of positions, monitoring, measuring runs, homing."""
