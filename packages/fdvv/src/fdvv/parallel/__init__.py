"""Executors: this process, worker processes, a Dask cluster."""
