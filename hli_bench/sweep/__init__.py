"""Sweeps: many runs over a grid and random draws, on the cores of this computer or on a Dask cluster."""
