"""Blocks to path segments: lengths, directions, dynamics, and how fast one may run into the next."""
