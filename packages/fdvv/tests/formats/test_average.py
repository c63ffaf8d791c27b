from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.formats.force.average import average_by_velocity
from fdvv.formats.force.types import Cycle, ForceFile
from fdvv.model.curve import MeasuredCurve, Stroke


def cycle(shift_mm: float = 0.0, extra_cN: float = 0.0, speed: float | None = None, label: str = "") -> Cycle:
    """One press of a linear switch on a 5 um grid."""
    x = np.round(np.arange(-1.0, 4.0, 0.005), 4)
    force = np.where(x < 0.0, 0.0, 40.0 + 8.0 * x + extra_cN) + 900.0 * np.maximum(x - 3.5, 0.0)
    return Cycle(MeasuredCurve(x + shift_mm, force, Stroke.PRESS, speed), None, 2.0 + shift_mm, None, label)


def file(*cycles: Cycle) -> ForceFile:
    return ForceFile("Oak", "plain-csv", cycles)


def test_a_single_cycle_keeps_its_raw_samples() -> None:
    one = cycle()
    (averaged,) = average_by_velocity(file(one))
    assert averaged.press is one.press
    assert averaged.used == ("cycle 1",)


def test_the_mean_of_repeats_is_the_mean_of_their_forces() -> None:
    (averaged,) = average_by_velocity(file(cycle(extra_cN=-0.3), cycle(), cycle(extra_cN=0.3)))
    assert averaged.left_out == ()
    assert averaged.press is not None
    x = averaged.press.displacement_mm
    inside = (x > 0.01) & (x < 3.49)
    np.testing.assert_allclose(averaged.press.force_cN[inside], 40.0 + 8.0 * x[inside], atol=1e-9)


def test_small_shifts_are_aligned_so_that_the_contact_step_stays_steep() -> None:
    (averaged,) = average_by_velocity(file(cycle(-0.02), cycle(), cycle(0.02)))
    assert averaged.press is not None
    assert np.diff(averaged.press.force_cN).max() > 35.0
    assert averaged.actuation_mm == 2.0


@pytest.mark.parametrize(
    ("odd", "reason"),
    [
        (cycle(3.0, label="odd"), "contact is shifted by +3.00 mm"),
        (cycle(extra_cN=2.0, label="odd"), "force of the press differs by 2.00 cN"),
    ],
)
def test_an_odd_cycle_is_left_out_with_its_reason(odd: Cycle, reason: str) -> None:
    (averaged,) = average_by_velocity(file(odd, cycle(), cycle(), cycle()))
    assert averaged.used == ("cycle 2", "cycle 3", "cycle 4")
    ((label, why),) = averaged.left_out
    assert label == "odd"
    assert why.startswith(reason)


def test_a_cycle_that_misses_a_stretch_is_left_out() -> None:
    whole = cycle().press
    assert whole is not None
    keep = (whole.displacement_mm < 1.0) | (whole.displacement_mm > 2.0)
    torn = Cycle(MeasuredCurve(whole.displacement_mm[keep], whole.force_cN[keep], Stroke.PRESS), None)
    (averaged,) = average_by_velocity(file(cycle(), torn, cycle()))
    assert averaged.left_out == (("cycle 2", "1.0 mm of the press are missing"),)


def test_without_a_majority_only_the_first_cycle_is_used() -> None:
    first = cycle()
    (averaged,) = average_by_velocity(file(first, cycle(extra_cN=20.0), cycle(1.0), cycle(extra_cN=-20.0)))
    assert averaged.press is first.press
    assert averaged.used == ("cycle 1",)
    assert averaged.warnings[0].startswith("mixed populations")


def test_velocities_are_never_mixed() -> None:
    cycles = (cycle(speed=1.0), cycle(speed=50.0), cycle(speed=1.02))
    assert [each.used for each in average_by_velocity(file(*cycles))] == [
        ("cycle 1", "cycle 3"),
        ("cycle 2",),
    ]


def test_a_lone_press_and_a_lone_release_are_not_repeats_of_each_other() -> None:
    press = cycle(speed=0.149)
    assert press.press is not None
    release = Cycle(None, replace(press.press, stroke=Stroke.RELEASE, velocity_mm_s=0.147))
    means = average_by_velocity(file(release, press))
    assert [(m.press is press.press, m.release is release.release) for m in means] == [
        (True, False),
        (False, True),
    ]
    assert not any(m.left_out or m.warnings for m in means)


def test_stated_velocities_are_repeats_only_where_they_are_equal() -> None:
    cycles = [replace(cycle(speed=v, extra_cN=v / 50), stated=True) for v in (100.0, 105.0, 100.0)]
    assert [m.used for m in average_by_velocity(file(*cycles))] == [("cycle 1", "cycle 3"), ("cycle 2",)]


def test_the_order_of_the_cycles_does_not_choose_the_population() -> None:
    cycles = [replace(cycle(shift), label=str(shift)) for shift in (0.0, 3.0, 0.01, 0.02)]
    for order in ((0, 1, 2, 3), (3, 2, 1, 0), (1, 0, 3, 2)):
        assert sorted(average_by_velocity(file(*(cycles[i] for i in order)))[0].used) == [
            "0.0",
            "0.01",
            "0.02",
        ]
