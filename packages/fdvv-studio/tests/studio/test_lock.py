"""A project has one studio: the second one is refused at once and changes nothing."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Barrier, Thread

import pytest

from fdvv.errors import InputError
from fdvv_studio.studio.lock import LOCK_FILE, note_address, project_lock
from tests.studio.running import RunningStudio
from tests.support.processor import children_s


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with a job that its studio says is running."""
    job = tmp_path / "project" / "jobs" / "0001"
    job.mkdir(parents=True)
    (job / "job.json").write_text('{"state": "running"}')
    return tmp_path / "project"


@pytest.fixture
def first(project: Path) -> Iterator[RunningStudio]:
    studio = RunningStudio(project)
    yield studio
    studio.stop()


def contents(folder: Path) -> dict[Path, tuple[bytes, int]]:
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in files}


def start_second(project: Path) -> tuple[subprocess.CompletedProcess[str], float]:
    """Start another studio; return what it said and the processor time that it took, s."""
    command = [sys.executable, "-m", "fdvv", "studio", "--no-browser", "--keep-address", "--port", "0"]
    before_s = children_s()
    ended = subprocess.run(
        [*command, "--project", str(project)], capture_output=True, text=True, timeout=30, check=False
    )
    return ended, children_s() - before_s


def refused(project: Path, address: str) -> float:
    """Start a second studio, check that it is refused in one line, and return how long that took."""
    before = contents(project)
    ended, took_s = start_second(project)
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert ended.stderr.count("\n") == 1
    assert f"another studio has this project open at {address};" in ended.stderr
    assert contents(project) == before
    return took_s


def test_the_second_studio_of_a_project_is_refused_and_changes_nothing(
    project: Path, first: RunningStudio
) -> None:
    refused(project, first.base)


@pytest.mark.slow
def test_ten_second_studios_are_refused_within_a_second_each(project: Path, first: RunningStudio) -> None:
    took_s = sorted(refused(project, first.base) for _ in range(10))
    assert took_s[5] < 1.0


def test_the_project_of_a_killed_studio_can_be_opened_at_once(project: Path) -> None:
    killed = RunningStudio(project)
    killed.stop(signal.SIGKILL)
    RunningStudio(project).stop()


def test_a_folder_made_for_the_lock_is_gone_afterwards_unless_something_was_kept(tmp_path: Path) -> None:
    project = tmp_path / "a" / "b"
    with project_lock(project) as lock:
        note_address(lock, "http://127.0.0.1:1")
        assert (project / LOCK_FILE).read_text() == "http://127.0.0.1:1"
    assert not (tmp_path / "a").exists()
    with project_lock(project):
        (project / "kept").touch()
    assert list(project.iterdir()) == [project / "kept"]


def test_of_threads_that_open_a_project_again_and_again_only_one_has_it_at_a_time(tmp_path: Path) -> None:
    inside, most, had = 0, 0, 0
    together = Barrier(8)

    def open_often() -> None:
        nonlocal inside, most, had
        together.wait()
        for _ in range(200):
            try:
                with project_lock(tmp_path / "project"):
                    inside += 1
                    most, had = max(most, inside), had + 1
                    inside -= 1
            except InputError:
                pass

    threads = [Thread(target=open_often) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == 1
    assert had > 8
