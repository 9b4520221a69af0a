"""What every package may know: time, units, ids, usage errors, loading by name. Imports nothing of ours."""
