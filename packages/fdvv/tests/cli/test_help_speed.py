"""``fdvv --help`` is fast."""

from __future__ import annotations

import subprocess
import sys

from tests.support.processor import children_s


def test_help_takes_less_than_three_tenths_of_a_second() -> None:
    command = [sys.executable, "-m", "fdvv", "--help"]
    subprocess.run(command, check=True, capture_output=True)
    spent = []
    for _ in range(5):
        start_s = children_s()
        subprocess.run(command, check=True, capture_output=True)
        spent.append(children_s() - start_s)
    assert min(spent) < 0.3
