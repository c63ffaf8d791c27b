"""Stop at a chosen moment, as a killed process does."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


class Killed(BaseException):
    """Raised in the place of a kill."""


@contextmanager
def kill_at(step: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Stop whatever runs within when it forces something to the disk for that time, counted from 0."""
    steps, real = iter(range(10_000)), os.fsync

    def fsync(file: int) -> None:
        if next(steps) == step:
            raise Killed
        real(file)

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", fsync)
        yield
