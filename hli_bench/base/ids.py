"""Identifiers that must not be mixed up."""

from typing import NewType

AxisNumber = NewType("AxisNumber", int)
"""Logical axis number `kopf.achs_nr` (1, 2, ...), the index of `gpAx[]` on the HLI."""

AxisIndex = NewType("AxisIndex", int)
"""Position of an axis in the rows of a bench, from 0."""

NodeId = NewType("NodeId", int)
"""CANopen node id, 1..127."""
