"""CiA 402: tables of objects, states, touch probe, modes and faults, and the drive that they drive."""
