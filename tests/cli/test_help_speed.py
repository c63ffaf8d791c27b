"""``fdvv --help`` is fast."""

from __future__ import annotations

import resource
import subprocess
import sys


def test_help_takes_less_than_three_tenths_of_a_second() -> None:
    command = [sys.executable, "-m", "fdvv", "--help"]
    subprocess.run(command, check=True, capture_output=True)
    spent = []
    for _ in range(5):
        start_s = _children_s()
        subprocess.run(command, check=True, capture_output=True)
        spent.append(_children_s() - start_s)
    assert min(spent) < 0.3


def _children_s() -> float:
    """Return the processor time of finished children, which other work on the machine does not change."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
