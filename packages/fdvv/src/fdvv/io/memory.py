"""Keep what a process holds in memory from other programs of the same account, as far as the system can."""

from __future__ import annotations

import ctypes
import sys

PR_SET_DUMPABLE = 4  # its number in linux/prctl.h


def hide_memory() -> bool:
    """Have Linux refuse debuggers and ``/proc/PID/mem`` of this account, and write no core; return if so.

    Root may still read the memory, and swap is not covered. What is started from here is not hidden.
    See prctl(2), PR_SET_DUMPABLE. Other systems: False.
    """
    if not sys.platform.startswith("linux"):
        return False
    import resource

    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    return bool(ctypes.CDLL(None).prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) == 0)
