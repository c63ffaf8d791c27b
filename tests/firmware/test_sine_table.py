"""The firmware's sine table is that of the code."""

from __future__ import annotations

from tools import make_sine


def test_the_sine_table_is_that_of_the_code() -> None:
    assert make_sine.HEADER.read_text() == make_sine.reference(), "run python tools/make_sine.py"
