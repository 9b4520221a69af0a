"""Pictures of a run: the report of `--report`, one HTML page that needs nothing else."""
