"""Ratios, parts and blends as firmware/core/arithmetic.h defines them, in whole numbers of any size."""

from __future__ import annotations

from typing import NamedTuple

ONE = 1 << 15


class Ratio(NamedTuple):
    """mantissa / 2^shift, 2^15 <= mantissa < 2^16."""

    mantissa: int
    shift: int


def ratio_of(value: int) -> Ratio:
    """Cut to the highest 16 bits."""
    shift = 16 - value.bit_length()
    return Ratio(value << shift if shift > 0 else value >> -shift, shift)


def reciprocal(mantissa: int) -> int:
    """Two steps of Newton's iteration towards 2^31 / mantissa."""
    guess = 95990 - mantissa
    for _ in range(2):
        guess = guess * (65536 - mantissa * guess // 65536) // ONE
    return guess


def inverse(ratio: Ratio) -> Ratio:
    if ratio.mantissa == ONE:
        return Ratio(ONE, 30 - ratio.shift)
    return Ratio(reciprocal(ratio.mantissa), 31 - ratio.shift)


def product(one: Ratio, other: Ratio) -> Ratio:
    wide = one.mantissa * other.mantissa
    cut = wide.bit_length() - 16
    return Ratio(wide >> cut, one.shift + other.shift - cut)


def scale(value: int, ratio: Ratio) -> int:
    """Round value * ratio to the nearest, halves away from zero."""
    twice = abs(value) * ratio.mantissa * 2
    size = ((twice >> ratio.shift if ratio.shift >= 0 else twice << -ratio.shift) + 1) // 2
    return -size if value < 0 else size


def part(way: int, whole: int) -> int:
    """Return way / whole in Q15."""
    cut = 10 if whole >= 1 << 21 else 5 if whole >= 1 << 16 else 0
    way, whole = way >> cut, whole >> cut
    fill = 16 - whole.bit_length()
    if whole << fill == ONE:
        return way << fill
    return (way << fill) * reciprocal(whole << fill) >> 16


def blend(one: int, other: int, part_q15: int) -> int:
    """Go from one to the other; halves up."""
    return one + (2 * (other - one) * part_q15 + ONE) // (2 * ONE)


def clamp(value: int, low: int, high: int) -> int:
    return min(max(value, low), high)


def slope(samples: list[tuple[int, int]]) -> tuple[int, int]:
    """Return numerator and denominator of the least-squares slope over (time, place)."""
    n = len(samples)
    t, x = sum(t for t, _ in samples), sum(x for _, x in samples)
    tt, tx = sum(t * t for t, _ in samples), sum(t * x for t, x in samples)
    return n * tx - t * x, n * tt - t * t
