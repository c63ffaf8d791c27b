"""Chunks of seeded work: the same results wherever they run, whatever is killed meanwhile."""

from __future__ import annotations

import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from fdvv.errors import InputError, WorkerError
from fdvv.parallel.executor import Executor, chunks_of
from fdvv.parallel.open import DaskExecutor, open_executor, started_workers
from tests.support.chunk_work import SeededSum, refuse_three

SEEDS = range(12)


@pytest.fixture(scope="module", params=["processes", "dask"])
def executor(request: pytest.FixtureRequest) -> Iterator[Executor]:
    local = request.param == "processes"
    with open_executor(processes=2) if local else open_executor(workers=2) as opened:
        yield opened


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def pids(folder: Path, count: int) -> list[int]:
    """Wait until so many processes are at work."""
    until = time.monotonic() + 30
    while len(found := list(folder.glob("*.pid"))) < count:
        assert time.monotonic() < until, f"only {len(found)} of {count} processes began"
        time.sleep(0.01)
    return [int(path.stem) for path in found]


def test_results_are_those_of_a_plain_loop(executor: Executor, tmp_path: Path) -> None:
    work = SeededSum(tmp_path)
    assert dict(executor.run(work, SEEDS)) == {seed: work(seed) for seed in SEEDS}


def test_nothing_to_do_is_done_at_once(executor: Executor, tmp_path: Path) -> None:
    assert list(executor.run(SeededSum(tmp_path), [])) == []


def test_a_killed_process_costs_only_its_chunk(executor: Executor, tmp_path: Path) -> None:
    found = list(executor.run(SeededSum(tmp_path, fatal=5), SEEDS))
    assert [path.name[:5] for path in tmp_path.iterdir()] == ["died-"]
    assert len(found) == len(SEEDS)
    work = SeededSum(tmp_path)
    assert dict(found) == {seed: work(seed) for seed in SEEDS}


@pytest.mark.slow
def test_a_chunk_that_kills_every_process_ends_the_run(executor: Executor, tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="chunk 1: every process that took it ended"):
        list(executor.run(SeededSum(tmp_path, fatal=8, deaths=99), [7, 8, 9]))


def test_an_error_in_a_chunk_names_it_and_keeps_its_trace(executor: Executor) -> None:
    with pytest.raises(WorkerError, match="chunk 2: ValueError: three is too many") as caught:
        list(executor.run(refuse_three, [1, 2, 3, 4]))
    assert "in refuse_three" in caught.value.__notes__[0]


INTERRUPTED = """
import sys
from pathlib import Path
from tests.support.chunk_work import wait_for_ever
from fdvv.parallel.open import open_executor
if __name__ == "__main__":
    with open_executor(**{sys.argv[1]: 2}) as executor:
        list(executor.run(wait_for_ever, [Path(sys.argv[2])] * 4))
"""


@pytest.mark.parametrize("kind", ["processes", pytest.param("workers", marks=pytest.mark.slow)])
def test_ctrl_c_ends_every_process_quietly(tmp_path: Path, kind: str) -> None:
    script, folder = tmp_path / "run.py", tmp_path / "pids"
    script.write_text(INTERRUPTED)
    folder.mkdir()
    command = [sys.executable, str(script), kind, str(folder)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        assert process.stderr is not None
        working = pids(folder, 2)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal sends it: to every process that it runs
        said = process.stderr.read()
    assert process.returncode == -signal.SIGINT
    assert said.count("Traceback") == 1, said
    assert said.rstrip().endswith("KeyboardInterrupt")
    assert not any(alive(pid) for pid in working)


def test_processes_end_when_the_results_are_no_longer_wanted(tmp_path: Path) -> None:
    others = set(multiprocessing.active_children())
    with open_executor(processes=2) as executor:
        found = executor.run(SeededSum(tmp_path), range(200))
        next(found)
        assert len(set(multiprocessing.active_children()) - others) == 2
        found.close()
        assert set(multiprocessing.active_children()) <= others


def listening_addresses(process: psutil.Process) -> list[str]:
    """Return where a process listens; nowhere if it has ended, as an earlier worker may just have."""
    try:
        found = process.net_connections("inet")
    except psutil.NoSuchProcess:
        return []
    return [one.laddr.ip for one in found if one.status == psutil.CONN_LISTEN]


def test_workers_are_reached_from_this_machine_only() -> None:
    with open_executor(workers=1):
        here = psutil.Process()
        addresses = [
            address
            for process in (here, *here.children(recursive=True))
            for address in listening_addresses(process)
        ]
    assert len(addresses) >= 3  # scheduler, nanny, worker
    assert set(addresses) == {"127.0.0.1"}


def test_a_cluster_that_runs_already_is_found_by_its_address(tmp_path: Path) -> None:
    with started_workers(1) as local, open_executor(cluster=local.scheduler_address) as executor:
        assert isinstance(executor, DaskExecutor)
        assert len(executor.client.nthreads()) == 1
        assert dict(executor.run(SeededSum(tmp_path), [4])) == {0: SeededSum(tmp_path)(4)}


def test_a_cluster_without_workers_is_refused() -> None:
    with (
        started_workers(0) as local,
        pytest.raises(InputError, match="it has no workers"),
        open_executor(cluster=local.scheduler_address),
    ):
        pass


def test_an_address_where_nobody_answers_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fdvv.parallel.open.ANSWER_s", 0.5)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
        with pytest.raises(InputError, match="no scheduler answers"), open_executor(cluster=address):
            pass


def test_chunks_are_worth_handing_out_and_lose_nothing() -> None:
    chunks = chunks_of(range(11), each_s=0.02)
    assert [len(chunk) for chunk in chunks] == [3, 3, 3, 2]
    assert [item for chunk in chunks for item in chunk] == list(range(11))
    assert chunks_of([1, 2], each_s=5.0) == [(1,), (2,)]
