"""Backends for tasks: this process, processes beside it, Dask, or jobs of Slurm."""
