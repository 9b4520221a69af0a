"""Conversions between the manual's integer units and people's units. No other module multiplies by 10_000."""

from typing import Final

TENTH_UM_PER_MM: Final = 10_000
"""0.1 um per mm; likewise 0.0001 degree per degree for rotary axes."""


def tenth_um(mm: float) -> int:
    """Return mm (or degrees) as whole 0.1 um (or 0.0001 degree), rounded half to even."""
    return round(mm * TENTH_UM_PER_MM)


def mm(tenth_um: float) -> float:
    """Return 0.1 um (or 0.0001 degree) as mm (or degrees); exact for what mm prints with four decimals."""
    return tenth_um / TENTH_UM_PER_MM


def tenth_um_per_s(mm_per_min: float) -> float:
    """Return a feed of the F word (mm/min or degrees/min) in 0.1 um/s."""
    return mm_per_min * TENTH_UM_PER_MM / 60.0


def mm_per_min(tenth_um_per_s: float) -> float:
    """Return a velocity in 0.1 um/s as a feed in mm/min (or degrees/min)."""
    return tenth_um_per_s * 60.0 / TENTH_UM_PER_MM


def tenth_um_from_um_per_s(um_per_s: float) -> float:
    """Return a list velocity (um/s or 0.001 degree/s) in 0.1 um/s (or 0.0001 degree/s)."""
    return um_per_s * 10.0


def tenth_um_per_s2(mm_per_s2: float) -> float:
    """Return a list acceleration (mm/s2 or degrees/s2) in 0.1 um/s2."""
    return mm_per_s2 * TENTH_UM_PER_MM
