"""hli-bench: an emulated CNC, its drives and terminals, and an open CNC-PLC interface."""
