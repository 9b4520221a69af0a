"""The emulated CNC: one package per stage, named as in the diagnosis manual."""
