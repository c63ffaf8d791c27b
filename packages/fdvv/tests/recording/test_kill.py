"""A process that records is killed at random moments: no take that was acknowledged is ever lost."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from fdvv.recording.file import load_recording
from fdvv.recording.log import RecordingLog
from fdvv.recording.types import Take
from tests.recording.strategies import contents
from tests.recording.takes import ABOUT, take
from tests.support.campaign import campaign

LONGEST_s = 0.08
"""A child makes its first take after some 20 ms, and then one every few."""


def record(path: Path) -> None:
    """Add takes without end; tell the number of each when it is on the disk."""
    with RecordingLog(path, ABOUT) as log:
        while True:
            number = log.next_number
            log.add(take(number))
            os.write(1, b"kept %d\n" % number)


def serve() -> None:
    """For each path on standard input fork a process that records, tell its number, wait for its end."""
    for line in sys.stdin:
        child = os.fork()
        if not child:
            record(Path(line.strip()))
        os.write(1, b"child %d\n" % child)
        os.waitpid(child, 0)
        os.write(1, b"dead\n")


@pytest.fixture
def server() -> Iterator[subprocess.Popen[str]]:
    code = "from tests.recording.test_kill import serve; serve()"
    root = Path(__file__).resolve().parents[4]
    command = [sys.executable, "-c", code]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, bufsize=1, cwd=root) as process:
        yield process
        assert process.stdin is not None
        process.stdin.close()


def killed(server: subprocess.Popen[str], path: Path, after_s: float) -> int:
    """Let a child record and kill it; return the last number that it reported."""
    assert server.stdin is not None
    assert server.stdout is not None
    server.stdin.write(f"{path}\n")
    kept, child = 0, 0
    for line in server.stdout:
        word, _, number = line.strip().partition(" ")
        if word == "child":
            child = int(number)
            time.sleep(after_s)
            os.kill(child, signal.SIGKILL)
        elif word == "kept":
            kept = int(number)
        elif word == "dead":
            return kept
    raise AssertionError("the server of recording processes went away")


def takes_of(path: Path) -> tuple[Take, ...]:
    """Load the takes of a file; none if it was killed before its head was whole."""
    if not path.exists() or b"\n" not in path.read_bytes():
        return ()
    return load_recording(path).takes


@campaign("seed", range(10), part=1)
def test_killed_at_twenty_random_moments_no_finished_take_is_lost(
    server: subprocess.Popen[str], tmp_path: Path, seed: int
) -> None:
    """A file goes on ten times, then another is begun."""
    rng = random.Random(seed)
    for moment in range(20):
        path = tmp_path / f"{moment // 10}.recording.jsonl"
        before = len(takes_of(path))
        reported = max(before, killed(server, path, rng.uniform(0, LONGEST_s)))
        found = takes_of(path)
        assert reported <= len(found) <= reported + 1
        assert contents(found[before:]) == contents(tuple(take(t.number) for t in found[before:]))
    for path in tmp_path.iterdir():
        with RecordingLog(path, ABOUT) as log:
            log.add(take(log.next_number))
        every = load_recording(path).takes
        assert contents(every) == contents(tuple(take(number) for number in range(1, len(every) + 1)))
