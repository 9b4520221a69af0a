"""Thin command line: parse, call bench, print."""
