"""Programs: conditions, time, slots, fades and biases."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.firmware.core import Core
from fdvv.protocol.tables import NONE, Condition, Settings, Transition
from tests.support.core.programs import FINE, REST, Table, armed, image, when
from tests.support.inputs import inputs_at

C = Condition
FLATS: list[Table] = [(0, 16000, [1600], [[force, force]]) for force in (0, 640, 6400)]


def two(*transitions: Transition, **other: int) -> bytes:
    """Two states: the first with these transitions, the second with nothing but other fields."""
    return image(states=[(REST, transitions), (replace(REST, **other), ())], tables=FLATS)


def entered(program: bytes, path_mm: object, settings: Settings = FINE) -> int:
    """Return the tick in which the second state is first reported, or -1."""
    states = armed(program, settings).run(inputs_at(settings, np.asarray(path_mm)))["state"]
    return int(np.argmax(states == 1)) if (states == 1).any() else -1


def test_deeper_and_shallower_are_strict_to_a_sixteenth_of_a_micrometre() -> None:
    at = 10000 / 16000
    step = 1 / 16000
    assert entered(two(when(C.DEEPER_THAN, 10000, 1)), [at - step, at, at + step]) == 2
    assert entered(two(when(C.SHALLOWER_THAN, 10000, 1)), [at + step, at, at - step]) == 2


def test_risen_by_and_fallen_by_count_from_the_extremes_since_the_state_was_entered() -> None:
    um = 1e-3
    path = np.array([1.0, 1.2, 1.19, 1.1901, 1.1899]) - 0.0
    assert entered(two(when(C.RISEN_BY, 160, 1)), path) == 2
    path = np.array([1.0, 0.8, 0.809, 0.81])
    assert entered(two(when(C.FALLEN_BY, 160, 1)), path) == 3
    again = image(states=[(REST, [when(C.DEEPER_THAN, 16000, 1)]), (REST, [when(C.RISEN_BY, 160, 0)])])
    states = armed(again, FINE).run(inputs_at(FINE, [0.9, 1.5, 1.495, 1.49 - um, 0.9]))["state"]
    assert states.tolist() == [0, 1, 1, 0, 0]


def test_turns_are_on_offer_in_the_tick_of_the_turn_only() -> None:
    path = [1.0, 1.0, 0.85, 0.85, 0.85]
    assert entered(two(when(C.TURNED_TO_RELEASE, 0, 1)), path) == 2
    late = two(when(C.TURNED_TO_RELEASE, 0, 1, C.AFTER_MS, 1))
    assert entered(late, path) == -1


def test_a_turn_serves_one_transition() -> None:
    chain = image(
        states=[
            (REST, [when(C.TURNED_TO_RELEASE, 0, 1)]),
            (REST, [when(C.TURNED_TO_RELEASE, 0, 2)]),
            (REST, ()),
        ]
    )
    path = [1.0, 0.8, 0.8, 0.8, 1.2, 1.2, 0.9, 0.9]
    assert armed(chain, FINE).run(inputs_at(FINE, path))["state"].tolist() == [0, 1, 1, 1, 1, 1, 2, 2]


def test_what_a_transition_did_not_use_stays_on_offer_for_the_next_state() -> None:
    chain = image(
        states=[
            (REST, [when(C.SHALLOWER_THAN, 15000, 1)]),
            (REST, [when(C.TURNED_TO_RELEASE, 0, 2)]),
            (REST, ()),
        ]
    )
    states = armed(chain, FINE).run(inputs_at(FINE, [1.0, 0.85, 0.85, 0.85]))["state"]
    assert states.tolist() == [0, 1, 2, 2]


def test_faster_and_slower_compare_the_velocity_of_the_state() -> None:
    settings = replace(FINE, announced_mm_s16=1600)
    assert entered(two(when(C.FASTER_THAN, 1599, 1)), [0.0, 0.0], settings) == 0
    assert entered(two(when(C.FASTER_THAN, 1600, 1)), [0.0, 0.0], settings) == -1
    assert entered(two(when(C.SLOWER_THAN, 1601, 1)), [0.0, 0.0], settings) == 0
    moving = image(
        states=[(replace(REST, velocity_source=2), [when(C.FASTER_THAN, 1500, 1)]), (REST, ())], tables=FLATS
    )
    up_and_down = np.concatenate([np.arange(2, 1, -0.03), [1.0]])
    assert entered(moving, up_and_down) > 0


@pytest.mark.parametrize("tick_us", [50, 100, 125, 250, 333, 999, 1000, 4000])
def test_time_in_a_state_is_exact_over_any_number_of_ticks(tick_us: int) -> None:
    settings = replace(FINE, tick_us=tick_us)
    states = armed(two(when(C.AFTER_MS, 700, 1)), settings).run(inputs_at(settings, np.zeros(15_000)))[
        "state"
    ]
    assert int(np.argmax(states == 1)) == -(-700_000 // tick_us)


def test_time_in_a_state_counts_missed_ticks() -> None:
    inputs = inputs_at(FINE, np.zeros(2000))
    inputs["elapsed_ticks"] = np.random.default_rng(1).integers(1, 5, 2000)
    states = armed(two(when(C.AFTER_MS, 700, 1)), FINE).run(inputs)["state"]
    elapsed_ms = np.cumsum(inputs["elapsed_ticks"].astype(int)) / 4
    elapsed_ms -= elapsed_ms[0]
    assert int(np.argmax(states == 1)) == int(np.argmax(elapsed_ms >= 700))


def test_a_host_event_is_on_offer_for_one_tick() -> None:
    program, inputs = two(when(C.HOST_EVENT, 7, 1)), inputs_at(FINE, np.zeros(4))
    for event, state in ((7, 1), (6, 0)):
        core = armed(program, FINE)
        core.tick(inputs[0])
        core.event(event)
        assert core.tick(inputs[1])["state"] == state
    guarded, core = two(when(C.HOST_EVENT, 7, 1, C.DEEPER_THAN, 16000)), Core(FINE)
    core.activate(guarded)
    core.arm()
    core.event(7)
    core.run(inputs[:1])
    assert core.run(inputs_at(FINE, [2.0]))["state"][0] == 0


def test_an_event_of_another_number_or_none_never_holds() -> None:
    core = armed(two(when(C.ALWAYS, 0, 1, C.HOST_EVENT, 31)), FINE)
    core.event(30)
    assert core.run(inputs_at(FINE, np.zeros(3)))["state"].max() == 0


def test_condition_and_guard_must_both_hold_and_the_first_transition_wins() -> None:
    both = two(when(C.DEEPER_THAN, 8000, 1, C.AFTER_MS, 1))
    assert entered(both, np.full(20, 1.0)) == 4
    first = image(
        states=[(REST, [when(C.DEEPER_THAN, 8000, 1), when(C.DEEPER_THAN, 0, 2)]), (REST, ()), (REST, ())]
    )
    assert armed(first, FINE).run(inputs_at(FINE, [0.0, 1.0, 1.0]))["state"].tolist() == [0, 1, 1]


def test_one_transition_fires_per_tick() -> None:
    always = when(C.ALWAYS, 0, 1)
    chain = image(states=[(REST, [replace(always, target=(k + 1) % 4)]) for k in range(4)])
    states = armed(chain, FINE).run(inputs_at(FINE, np.zeros(6)))["state"]
    assert states.tolist() == [1, 2, 3, 0, 1, 2]


def test_the_new_state_sets_force_and_key_in_the_tick_of_the_transition() -> None:
    outputs = armed(two(when(C.DEEPER_THAN, 16000, 1), press_surface=1, key=9), FINE).run(
        inputs_at(FINE, [0.5, 1.5])
    )
    assert outputs["commanded_cN64"].tolist() == [0, 640]
    assert outputs["key"].tolist() == [0, 9]


def test_the_command_fades_from_the_last_state_to_the_next() -> None:
    program = two(when(C.DEEPER_THAN, 16000, 1), press_surface=2, fade_ms=5)
    forces = armed(program, FINE).run(inputs_at(FINE, np.r_[0.5, np.full(30, 1.5)]))["commanded_cN64"]
    wanted = np.clip(6400 * np.arange(30) / 20, 0, 6400)
    assert forces[0] == 0
    assert forces[1:] == pytest.approx(wanted, abs=1.5)


def test_the_bias_changes_evenly_over_its_time_and_stays() -> None:
    program = image(
        states=[(replace(REST, bias_cN64=-3200, bias_end_cN64=3200, bias_ms=20), ())], tables=FLATS
    )
    forces = armed(program, FINE).run(inputs_at(FINE, np.full(120, 1.5)))["commanded_cN64"]
    assert forces == pytest.approx(np.clip(-3200 + 80 * np.arange(120), -3200, 3200), abs=1.5)
    steady = image(states=[(replace(REST, bias_cN64=-3200, bias_end_cN64=999), ())], tables=FLATS)
    assert set(armed(steady, FINE).run(inputs_at(FINE, np.full(9, 1.5)))["commanded_cN64"]) == {-3200}


def test_slots_are_played_on_the_way_then_on_entering() -> None:
    way = replace(when(C.DEEPER_THAN, 16000, 1), slot=2)
    for transition, slot in ((way, 2), (replace(way, slot=NONE), 3)):
        slots = armed(two(transition, enter_slot=3), FINE).run(inputs_at(FINE, [0.5, 1.5, 1.5]))["slot"]
        assert slots.tolist() == [NONE, slot, NONE]
    arming = image(states=[(replace(REST, enter_slot=1), ())])
    assert armed(arming, FINE).run(inputs_at(FINE, [0.5, 0.5]))["slot"].tolist() == [1, NONE]


@pytest.mark.parametrize("tick_us", [50, 250, 300, 3999])
def test_a_repeated_slot_keeps_its_period_without_drift(tick_us: int) -> None:
    settings = replace(FINE, tick_us=tick_us)
    program = image(states=[(replace(REST, repeat_slot=2, repeat_ms=7), ())])
    slots = armed(program, settings).run(inputs_at(settings, np.zeros(4000)))["slot"]
    due = -(-7000 * np.arange(1, 1 + 4000 * tick_us // 7000) // tick_us)
    assert np.flatnonzero(slots == 2).tolist() == due[due < 4000].tolist()


def test_after_missed_periods_a_repeated_slot_is_played_once() -> None:
    program = image(states=[(replace(REST, repeat_slot=2, repeat_ms=2), ())])
    inputs = inputs_at(FINE, np.zeros(30))
    inputs["elapsed_ticks"][5] = 50
    slots = armed(program, FINE).run(inputs)["slot"]
    assert np.flatnonzero(slots == 2).tolist() == [5, 11, 19, 27]


def test_a_disarmed_program_starts_anew_when_it_is_armed_again() -> None:
    core = armed(two(when(C.DEEPER_THAN, 16000, 1)), FINE)
    assert core.run(inputs_at(FINE, [1.5]))["state"][0] == 1
    core.disarm()
    core.run(inputs_at(FINE, [0.5]))
    core.arm()
    assert core.run(inputs_at(FINE, [0.5]))["state"][0] == 0
