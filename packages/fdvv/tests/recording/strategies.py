"""Recordings of every kind, drawn at random."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from fdvv.recording.types import Bench, Mark, Quantity, Recording, Source, Stage, Stream, Take

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
NAME = st.text(st.characters(categories=["L", "N", "P"]), min_size=1, max_size=12)
NUMBER = st.floats(-1e6, 1e6)
KINDS = ("|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8", "<f4", "<f8")


@st.composite
def streams(draw: st.DrawFn, name: str) -> Stream:
    count = draw(st.integers(0, 30))
    steps = draw(arrays.arrays(np.float64, count, elements=st.floats(1e-6, 1e3)))
    shape = (count, 3) if draw(st.booleans()) else (count,)
    raw: npt.NDArray[Any] = draw(arrays.arrays(draw(st.sampled_from(KINDS)), shape))
    scale = draw(NUMBER.filter(bool))
    times = draw(NUMBER) + np.cumsum(steps)
    return Stream(name, draw(st.sampled_from(Quantity)), draw(NAME), times, raw, scale, draw(NUMBER))


@st.composite
def takes(draw: st.DrawFn, number: int) -> Take:
    names = draw(st.lists(NAME, unique=True, max_size=4))
    return Take(
        number,
        tuple(draw(streams(name)) for name in names),
        tuple(draw(st.lists(st.builds(Mark, TEXT, NAME, NUMBER), max_size=4))),
        draw(st.sampled_from(Stage)),
        draw(st.none() | st.floats(1e-3, 1e4)),
        draw(TEXT),
        draw(TEXT),
    )


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    positive = st.floats(0, 1e4)
    bench = st.builds(Bench, *[positive] * 6, st.booleans())
    return Recording(
        draw(NAME),
        tuple(draw(takes(number)) for number in range(1, 1 + draw(st.integers(0, 3)))),
        draw(bench),
        tuple(draw(st.lists(st.builds(Source, TEXT, TEXT, TEXT), max_size=2))),
        draw(TEXT),
        draw(TEXT),
        draw(st.booleans()),
        tuple(draw(st.lists(TEXT, max_size=2))),
    )


def contents(value: Any) -> Any:
    """Return everything that a record holds as plain values, arrays as kind, shape and bytes."""
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tobytes()
    if isinstance(value, tuple):
        return [contents(item) for item in value]
    if isinstance(value, Recording | Take | Stream | Mark | Source | Bench):
        return {name: contents(item) for name, item in vars(value).items()}
    return repr(value)
