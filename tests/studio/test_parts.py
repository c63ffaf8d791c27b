"""What is made ready before the first question is answered."""

from __future__ import annotations

import subprocess
import sys

import pytest

RACE = """
import sys, threading
from fdvv.studio import load_parts
from fdvv.model import load_builtin
load_parts()
sys.setswitchinterval(1e-6)
names = ("mx-clear", "mx-red", "mx-blue", "rubber-dome")
together = threading.Barrier(len(names))
threads = [threading.Thread(target=lambda n=n: (together.wait(), load_builtin(n))) for n in names]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
"""


@pytest.mark.parametrize("attempt", range(3))
def test_threads_that_are_the_first_to_read_a_record_do_not_crash_the_process(attempt: int) -> None:
    # without the preparation about every second attempt ends with a segmentation fault
    ended = subprocess.run([sys.executable, "-c", RACE], capture_output=True, check=False)
    assert ended.returncode == 0, ended.stderr
