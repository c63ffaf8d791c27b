"""Processor time of other processes, which other work on the machine does not change."""

from __future__ import annotations

import resource


def children_s() -> float:
    """Return what the children that have ended took."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
