"""Columns come back with every bit, kind and shape, and the text of older files still reads."""

from __future__ import annotations

import base64
import zlib

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from fdvv.io.columns import KINDS, pack_column, unpack_column


@given(
    column=st.sampled_from(KINDS).flatmap(
        lambda kind: arrays.arrays(kind, arrays.array_shapes(min_dims=1, max_dims=3, min_side=0, max_side=9))
    )
)
def test_a_column_comes_back_to_the_bit_with_its_kind_and_shape(column: npt.NDArray[np.generic]) -> None:
    back = unpack_column(pack_column(column))
    assert (back.dtype, back.shape) == (column.dtype, column.shape)
    assert back.tobytes() == column.tobytes()


def test_any_byte_order_and_any_view_are_written_as_the_numbers_they_are() -> None:
    column: npt.NDArray[np.int32] = np.arange(10, dtype=">i4")[::2]
    assert unpack_column(pack_column(column)).tolist() == [0, 2, 4, 6, 8]


def test_nan_keeps_what_it_carries() -> None:
    bits = np.array([0x7FF8000000000001, 0xFFF0000000000123], dtype=np.uint64)
    assert unpack_column(pack_column(bits.view(np.float64))).view(np.uint64).tolist() == bits.tolist()


@pytest.mark.parametrize(("kind", "dtype"), [("<f8", np.float64), ("?", np.bool_)])
def test_text_as_it_was_always_written_is_written_and_read_the_same(
    kind: str, dtype: type[np.generic]
) -> None:
    column: npt.NDArray[np.generic] = np.array([0, 1, 1, 0]).astype(dtype)
    text = kind + ":" + base64.b64encode(zlib.compress(column.tobytes())).decode()
    assert pack_column(column) == text
    assert unpack_column(text).tobytes() == column.tobytes()


@pytest.mark.parametrize(
    "text",
    ["", "<f8", "<f2:", "<f8:§", "<f8:AAAA", "O:eJwDAAAAAAE=", "<f8[2,2]:eJwDAAAAAAE=", "<f8[2:eJwDAAAAAAE="],
)
def test_what_is_no_column_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        unpack_column(text)


@pytest.mark.parametrize(
    "column", [np.array(["a"]), np.array([1j]), np.float64(1.0), np.zeros(2, np.float16)]
)
def test_what_is_no_number_of_these_kinds_is_not_written(column: npt.NDArray[np.generic]) -> None:
    with pytest.raises(ValueError, match="a column cannot hold"):
        pack_column(column)
