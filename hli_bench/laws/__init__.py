"""Compiled mathematics of motion on structured rows: plain functions, free of names from the manuals."""
