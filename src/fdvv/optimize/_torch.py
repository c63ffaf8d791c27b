"""What the BoTorch engines share: the parts they import, one thread, double precision, their own seed."""

from __future__ import annotations

import importlib
import importlib.util
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from fdvv.optimize._places import missing
from fdvv.units import FloatArray

REST = 32
"""Places that an acquisition of torch is asked at once for, at most: it keeps a graph of each."""


@contextmanager
def torch_seeded(part: str, seed: int) -> Iterator[Any]:
    """Give torch in one thread, in double precision and with a seed, and put all back. BuildError."""
    try:
        with warnings.catch_warnings():
            # of old ways that botorch's own parts go
            warnings.simplefilter("ignore")
            importlib.import_module("botorch")
            torch: Any = importlib.import_module("torch")
    except ImportError as error:
        raise missing(part, "botorch", error) from error
    threads = torch.get_num_threads()
    try:
        torch.set_num_threads(1)
        with torch.random.fork_rng(devices=[]), warnings.catch_warnings():
            # of a fit that could not be bettered, and of scores that are standardised here already
            warnings.simplefilter("ignore")
            torch.manual_seed(seed)
            yield torch
    finally:
        torch.set_num_threads(threads)


def tensor(torch: Any, rows: FloatArray) -> Any:
    """Give an array as a tensor of double precision."""
    return torch.tensor(np.ascontiguousarray(rows), dtype=torch.double)


def worth_of(torch: Any, acquisition: Any) -> Callable[[FloatArray], FloatArray]:
    """Make an acquisition of single places one of arrays: (n, d) to (n,)."""

    def worth(places: FloatArray) -> FloatArray:
        with torch.no_grad():
            parts = tensor(torch, places)[:, None].split(REST * 8)
            return np.concatenate([acquisition(part).numpy() for part in parts]).astype(np.float64)

    return worth


def torch_there() -> bool:
    """Tell whether the BoTorch engines can be used here."""
    return all(importlib.util.find_spec(name) for name in ("torch", "botorch"))
