"""Open the executor that a command names."""

from __future__ import annotations

import importlib.metadata
import logging
import os
import uuid
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from fdvv._version import __version__
from fdvv.errors import BuildError, InputError
from fdvv.parallel.executor import (
    TRIES,
    Chunk,
    ChunkLost,
    Executor,
    Found,
    ProcessExecutor,
    answered,
    found_or_raised,
)

if TYPE_CHECKING:
    from distributed import Client, LocalCluster


HERE = "127.0.0.1:0"
"""Without an address dask's status service listens to every network; it cannot be left out."""
LOCAL = {
    # no worker takes a second chunk in advance: it would share the blame if the first one kills
    "distributed.scheduler.worker-saturation": 1.0,
    "distributed.scheduler.allowed-failures": TRIES - 1,
    "distributed.scheduler.http.routes": [],
    "distributed.worker.http.routes": [],
}
ANSWER_s = 10.0
"""A scheduler that does not answer for so long is not there."""


class DaskExecutor:
    """Works on chunks on the workers of a dask cluster; see Executor."""

    def __init__(self, client: Client) -> None:
        self.client = client

    def run(
        self, work: Callable[[Chunk], Found], chunks: Sequence[Chunk]
    ) -> Generator[tuple[int, Found], None, None]:
        from distributed import KilledWorker, as_completed

        run = uuid.uuid4().hex  # keys of their own: a result is never one of an earlier run
        places = {
            self.client.submit(answered, work, chunk, key=f"{run}-{number}", priority=-number): number
            for number, chunk in enumerate(chunks)
        }
        try:
            for future in as_completed(list(places)):
                number = places[future]
                try:
                    found = future.result()
                except KilledWorker as error:
                    raise ChunkLost(number) from error
                yield number, found_or_raised(number, found)
                future.release()
        finally:
            self.client.cancel(list(places), force=True)


@contextmanager
def started_workers(workers: int | None) -> Iterator[LocalCluster]:
    """Start workers that only this machine can reach, without any page."""
    import dask
    from distributed import LocalCluster

    # a lost worker is logged in many lines, but it is no error: its chunk is done again
    with dask.config.set(LOCAL), LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, memory_limit=0,
        host="127.0.0.1", dashboard_address=HERE, worker_dashboard_address=HERE,
        scheduler_kwargs={"dashboard": False}, silence_logs=logging.CRITICAL,
    ) as local:  # fmt: skip
        yield local


def _found(address: str) -> Client:
    from distributed import Client

    try:
        return Client(address, timeout=ANSWER_s)
    except (OSError, ValueError) as error:
        raise InputError(
            "--cluster", address, f"no scheduler answers ({error})", "start one with: dask scheduler"
        ) from error


def _check_workers(client: Client, address: str) -> None:
    """Refuse workers that do not know the work: handed it, they would break off, again and again."""
    versions = client.run(importlib.metadata.version, "fdvv", on_error="return").values()
    if not versions or set(versions) != {__version__}:
        reason = "it has no workers" if not versions else f"not all of its workers have fdvv {__version__}"
        raise InputError("--cluster", address, reason, "install the same fdvv there")


@contextmanager
def open_executor(
    processes: int | None = None, workers: int | None = None, cluster: str | None = None
) -> Iterator[Executor]:
    """Open what the options of a command ask for; it is closed when the context is left.

    Parameters
    ----------
    processes : local processes; None: as many as this process may use.
    workers : workers of a dask cluster started here, reachable from this machine only.
    cluster : address of a dask scheduler that runs already, as ``tcp://10.0.0.5:8786``. Whoever controls it
        can run code here: use none but your own.

    Raises BuildError without the extra `sweep`, InputError if nobody answers at cluster.
    """
    if workers is None and cluster is None:
        yield ProcessExecutor(processes or len(os.sched_getaffinity(0)))
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise BuildError("dask workers need an extra: pip install 'fdvv[sweep]'") from error
    if cluster is not None:
        with _found(cluster) as client:
            _check_workers(client, cluster)
            yield DaskExecutor(client)
        return
    with started_workers(workers) as local, Client(local) as client:
        yield DaskExecutor(client)
