"""Bins of ticks keep every peak, however the ticks came."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv_studio.live.tick_bins import TickBinner, TickPiece


def piece(t_s: np.ndarray) -> TickPiece:
    random = np.random.default_rng(0)
    place_mm, force_cN, commanded_cN = random.normal(size=(3, t_s.size))
    state, cut = random.integers(0, 4, t_s.size), random.random(t_s.size) < 0.1
    return TickPiece(t_s, place_mm, force_cN, commanded_cN, state, cut, ~cut)


def part(whole: TickPiece, start: int, end: int) -> TickPiece:
    names = ("t_s", "displacement_mm", "force_cN", "commanded_cN", "state", "cut", "rendered")
    return TickPiece(*(getattr(whole, name)[start:end] for name in names))


@given(
    gaps=st.lists(st.integers(1, 40), min_size=1, max_size=60),
    cuts=st.lists(st.integers(0, 60), max_size=5),
    bin_ticks=st.integers(1, 25),
)
def test_pieces_of_any_size_give_the_least_and_the_most_of_every_bin(
    gaps: list[int], cuts: list[int], bin_ticks: int
) -> None:
    whole = piece(np.cumsum(gaps) * 0.001)
    binner = TickBinner(bin_ticks * 0.001)
    edges = [0, *sorted(min(cut, len(gaps)) for cut in cuts), len(gaps)]
    found = [binner.add(part(whole, a, b)) for a, b in pairwise(edges)]
    number = np.floor(whole.t_s / binner.bin_s).astype(int)
    numbers = [n for bins in found for n in bins.number]
    assert numbers == [n for n in dict.fromkeys(number.tolist()) if n != number[-1]]
    for bins in found:
        for i, n in enumerate(bins.number):
            inside = number == n
            assert bins.low[0, i] == whole.displacement_mm[inside].min()
            assert bins.high[2, i] == whole.commanded_cN[inside].max()
            assert bins.ticks[i] == inside.sum()
            assert bins.state[i] == whole.state[inside][-1]
            assert bins.cut[i] == whole.cut[inside].any()


def test_a_bin_without_width_is_refused() -> None:
    with pytest.raises(ModelError, match="above 0"):
        TickBinner(0.0)
