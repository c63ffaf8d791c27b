"""How long a job still takes, from its order and from how long it has taken."""

from __future__ import annotations

import pytest

from fdvv.rendering.settings import CompensateSettings
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder, Order, ProbeOrder, TuneOrder
from fdvv_studio.studio.jobs.time_left import parts_of, remaining_s

ORDER = CompensateOrder("builtin:mx-clear", "clear")
ALL_s = sum(part.time_s for part in parts_of(ORDER))


def test_before_the_first_press_a_job_takes_what_its_order_lets_expect() -> None:
    assert remaining_s(ORDER, "", 0.0, 0.0) == pytest.approx(ALL_s)


def test_it_falls_as_the_work_goes_on_from_part_to_part() -> None:
    steps = [("baseline", 0.5), ("compensate", 0.0), ("compensate", 0.9), ("probe", 0.1), ("probe", 0.9)]
    found = [remaining_s(ORDER, *step, elapsed_s=2.0) for step in steps]
    assert found == sorted(found, reverse=True)
    assert found[-1] < 2.0


def test_a_machine_that_is_slower_takes_longer_for_the_rest_too() -> None:
    spent_s = parts_of(ORDER)[0].time_s
    on_time = remaining_s(ORDER, "compensate", 0.0, spent_s)
    assert on_time == pytest.approx(ALL_s - spent_s)
    assert remaining_s(ORDER, "compensate", 0.0, 10 * spent_s) > 2 * on_time


@pytest.mark.parametrize(
    ("order", "longer"),
    [
        (ORDER, CompensateOrder("b", "n", device="serial:/dev/ttyACM0")),
        (ORDER, CompensateOrder("b", "n", settings=CompensateSettings(method="paper"))),
        (ProbeOrder("b", "n"), ProbeOrder("b", "n", actuation="learned")),
        (CaptureOrder("n"), CaptureOrder("n", watch=True)),
        (TuneOrder("b", "n", observer="simulated observer"), TuneOrder("b", "n")),
    ],
)
def test_people_and_more_presses_take_longer(order: Order, longer: Order) -> None:
    assert remaining_s(longer, "", 0.0, 0.0) > 1.2 * remaining_s(order, "", 0.0, 0.0)
