from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv import units

PAIRS = [
    (units.cN_from_gf, units.gf_from_cN),
    (units.N_from_cN, units.cN_from_N),
    (units.m_from_mm, units.mm_from_m),
]


@pytest.mark.parametrize(("there", "back"), PAIRS)
@given(value=st.floats(-1e6, 1e6))
def test_a_conversion_there_and_back_gives_the_value(
    there: Callable[[float], float], back: Callable[[float], float], value: float
) -> None:
    assert back(there(value)) == pytest.approx(value, rel=1e-14, abs=1e-300)


def test_conversions_give_textbook_values() -> None:
    assert units.cN_from_gf(100.0) == pytest.approx(98.0665)
    assert units.N_from_cN(440.0) == pytest.approx(4.4)
    assert units.m_from_mm(4.0) == pytest.approx(0.004)
