"""Where tasks run: in this process, in processes beside it, on Dask, or as jobs of Slurm."""
