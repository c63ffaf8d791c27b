"""Division by multiplication: how wrong it may be."""

from __future__ import annotations

import ctypes

import numpy as np

from fdvv._native import library
from tests.support.core import arithmetic as exact


def test_a_reciprocal_is_wrong_by_5e_5_at_most_and_fits_16_bits() -> None:
    mantissas = np.arange(2**15 + 1, 2**16)
    found = np.array([exact.reciprocal(int(m)) for m in mantissas])
    assert np.abs(found * mantissas / 2**31 - 1).max() <= 5e-5
    assert found.max() < 2**16


def test_a_part_of_a_whole_is_that_of_the_readable_one_and_near_the_true_one() -> None:
    rng = np.random.default_rng(0)
    part = library().fdvv_bridge_part_q15
    for whole in [*range(1, 70), *(2**k + d for k in range(7, 26) for d in (-1, 0, 1)), 65_535_000]:
        for way in {0, whole - 1, whole // 2, *rng.integers(0, whole, 20).tolist()}:
            found = part(ctypes.c_uint32(way), ctypes.c_uint32(whole))
            assert found == exact.part(way, whole)
            true = way / whole
            slack = 2**-15 + 5e-5 * true + (2**-11 if whole >= 2**16 else 0)
            assert abs(found / 2**15 - true) <= slack


def test_a_wide_product_is_exact() -> None:
    product = library().fdvv_bridge_wide_product
    product.restype = ctypes.c_uint64
    ends = [
        0,
        1,
        2**16 - 1,
        2**16,
        2**31,
        2**32 - 1,
        *np.random.default_rng(1).integers(0, 2**32, 40).tolist(),
    ]
    for one in ends:
        for other in ends:
            assert product(ctypes.c_uint32(one), ctypes.c_uint32(other)) == one * other
