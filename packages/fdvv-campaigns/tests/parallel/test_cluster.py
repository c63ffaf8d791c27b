"""A cluster as the how-to starts it: a scheduler and workers by hand, here on loopback."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.parallel.open import DaskExecutor, open_executor
from fdvv_campaigns.sweep.plan import SweepPlan
from fdvv_campaigns.sweep.sweep import RESULTS, run_sweep
from fdvv_studio.library.build import BUTTONS, build_library
from tests.support.catalog_rows import write_folder

HOW_TO = Path(__file__).resolve().parents[4] / "docs" / "how-to" / "sweep-on-a-cluster.md"
pytestmark = pytest.mark.slow


def commands() -> list[list[str]]:
    """Return the commands of the how-to that start dask, as written there."""
    found = re.findall(r"^(dask (?:scheduler|worker) .*)$", HOW_TO.read_text(), flags=re.MULTILINE)
    return [line.split() for line in found]


def free_port() -> int:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


@pytest.fixture(scope="module")
def cluster() -> Iterator[tuple[str, list[int]]]:
    """Start what the how-to says on another port; return its address and what watches over the workers."""
    port = str(free_port())
    scheduler, worker = commands()
    python = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
    started = [[*python, *scheduler[2:]], *[["-w", *worker[2:]]] * 2]
    with ExitStack() as stack:
        pids = []
        for command in started:
            if command[0] == "-w":
                command = [sys.executable, "-m", "distributed.cli.dask_worker", *command[1:]]
            arguments = [word.replace("10.0.0.5", "127.0.0.1").replace("8786", port) for word in command]
            process = stack.enter_context(
                subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            )
            stack.callback(process.terminate)
            pids.append(process.pid)
        yield f"tcp://127.0.0.1:{port}", pids[1:]


def ready(address: str, workers: int) -> None:
    until = time.monotonic() + 90
    while True:
        try:
            with open_executor(cluster=address) as executor:
                assert isinstance(executor, DaskExecutor)
                if len(executor.client.nthreads()) >= workers:
                    return
        except InputError:
            pass
        assert time.monotonic() < until, "the cluster did not come up"
        time.sleep(0.2)


def test_a_cluster_started_by_hand_finds_the_same_and_survives_a_lost_worker(
    cluster: tuple[str, list[int]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    address, workers = cluster
    ready(address, 2)
    monkeypatch.setattr("fdvv_studio.library.build.FILES", 2)
    source = write_folder(tmp_path / "switches", {f"{i}.csv": float(i) for i in range(6)})
    with open_executor(cluster=address) as executor:
        build_library([source], tmp_path / "there", executor)
    with open_executor(processes=1) as executor:
        build_library([source], tmp_path / "here", executor)
    assert (tmp_path / "there" / BUTTONS).read_bytes() == (tmp_path / "here" / BUTTONS).read_bytes()

    plan = SweepPlan(
        format="fdvv-sweep", version=1, measure="press", factors={"repeat": 12}, settings={"presses": 1}
    )
    monkeypatch.setattr("fdvv_campaigns.sweep.sweep.CHUNK_s", 0.05)

    def kill(done: int, _whole: int) -> None:
        if done == 3:
            for child in Path(f"/proc/{workers[0]}/task/{workers[0]}/children").read_text().split():
                os.kill(int(child), signal.SIGKILL)

    with open_executor(cluster=address) as executor:
        run_sweep(plan, tmp_path / "swept", executor, kill)
    with open_executor(processes=1) as executor:
        run_sweep(plan, tmp_path / "alone", executor)
    assert (tmp_path / "swept" / RESULTS).read_bytes() == (tmp_path / "alone" / RESULTS).read_bytes()
