"""What the checker accepts comes back: a free cap on the firmware's own core, let go anywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from fdvv.firmware.core import Core, RecordArray
from fdvv.program.check import check_program
from fdvv.program.compile import compile_program
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.library import make, programs
from fdvv.program.program import Program, State
from fdvv.program.surface import Limits, flat, line
from fdvv.protocol.tables import Mode, Settings
from tests.support.campaign import campaign
from tests.support.inputs import inputs_at
from tests.support.program.random_images import random_program

LIMITS = Limits()
TICK_s = 250e-6
STEPS = 5
READ_mm = 0.0005


@cache
def all_readings() -> list[RecordArray]:
    """Return the inputs of a tick for every displacement, in the steps of the rig's converter."""
    places = inputs_at(Settings(), np.arange(0, 6.2, READ_mm))
    return [places[i : i + 1] for i in range(places.size)]


@dataclass
class FreeCap:
    """An upright mass with drag, friction and stops, without a finger, within what limits assume."""

    drag_N_s_m: float
    friction_N: float
    rebound_ratio: float
    travel_mm: float
    x_mm: float = 0.0
    v_mm_s: float = 0.0

    def advance(self, force_cN: float) -> None:
        """Let a force push up for one tick."""
        for _ in range(STEPS):
            push_N = 0.01 * (force_cN - LIMITS.weight_cN) + self.drag_N_s_m * self.v_mm_s * 1e-3
            rub_N = math.copysign(self.friction_N, self.v_mm_s)
            if self.v_mm_s == 0:
                rub_N = -min(max(push_N, -self.friction_N), self.friction_N)
            change = -(push_N + rub_N) / LIMITS.mass_kg * 1e3 * TICK_s / STEPS
            stops = self.v_mm_s * (self.v_mm_s + change) < 0
            self.v_mm_s = 0.0 if stops else self.v_mm_s + change
            self.x_mm += self.v_mm_s * TICK_s / STEPS
            if not 0 <= self.x_mm <= self.travel_mm:
                self.x_mm = min(max(self.x_mm, 0.0), self.travel_mm)
                self.v_mm_s *= -self.rebound_ratio


def draw_cap(rng: np.random.Generator, program: Program) -> FreeCap:
    """Draw a cap within the limits."""
    return FreeCap(
        rng.uniform(LIMITS.damping_N_s_m, LIMITS.most_damping_N_s_m),
        0.01 * rng.uniform(0, LIMITS.opposing_cN),
        rng.uniform(0, LIMITS.rebound_ratio),
        program.travel_mm,
    )


def pressed_core(program: Program, rng: np.random.Generator) -> tuple[Core, float]:
    """Press a program about for a while, as a finger would; return the core and where the cap then is."""
    core = Core(Settings(), compile_program(program).image)
    core.arm()
    stops = [0.0, *rng.uniform(0.5, program.travel_mm, rng.integers(1, 4))]
    x_mm = np.concatenate([np.linspace(a, b, 100) for a, b in pairwise(stops)])
    core.run(inputs_at(Settings(), x_mm))
    return core, float(x_mm[-1])


def let_go(program: Program, rng: np.random.Generator, limit_s: float) -> float | None:
    """Let the cap go somewhere; return when it was at the top in the start state for 50 ms, or None."""
    core, x_mm = pressed_core(program, rng)
    cap = draw_cap(rng, program)
    cap.x_mm = x_mm
    start = [s.name for s in program.states].index(program.start)
    rested = 0
    readings = all_readings()
    for i in range(int((limit_s + 0.06) / TICK_s)):
        # a reading that never changes is a dead sensor to the rig
        out = core.run(readings[min(int(cap.x_mm / READ_mm) + i % 2, len(readings) - 1)])[0]
        assert out["mode"] == Mode.ARMED
        cap.advance(float(out["commanded_cN64"]) / 64)
        rested = rested + 1 if cap.x_mm <= LIMITS.top_mm + 0.002 and out["state"] == start else 0
        if rested * TICK_s > 0.05:
            return i * TICK_s - 0.05
    return None


def hold_program(*, back: bool) -> Program:
    """Return a program that holds the cap down, for ever or for 100 ms."""
    up = State("up", "push", "push", (Transition("held", Condition(When.DEEPER_THAN, 2.0)),))
    rising = State("rising", "push", "push", (Transition("up", Condition(When.SHALLOWER_THAN, 1.0)),))
    freed = (Transition("rising", Condition(When.AFTER, 100)),)
    states = (
        (up, State("held", "pull", "pull", freed), rising) if back else (up, State("held", "pull", "pull"))
    )
    return Program("hold", 4.0, "up", states, (flat("push", 50), flat("pull", -30)))


def self_tapping() -> Program:
    """Return a program that pulls the cap down whenever it comes near the top: it taps for ever."""
    states = (
        State("up", "push", "push", (Transition("down", Condition(When.SHALLOWER_THAN, 0.5)),)),
        State("down", "pull", "pull", (Transition("up", Condition(When.AFTER, 20)),)),
    )
    return Program("self-tapping", 4.0, "up", states, (flat("push", 50), flat("pull", -30)))


def test_a_program_that_holds_for_ever_is_refused_by_its_state_and_place() -> None:
    (finding,) = check_program(hold_program(back=False)).refused
    assert finding.state == "held"
    assert "no after_ms" in finding.reason
    assert check_program(hold_program(back=True)).refused == ()


def test_what_was_refused_for_holding_does_not_come_back() -> None:
    rng = np.random.default_rng(1)
    core, _ = pressed_core(hold_program(back=False), rng)
    assert let_go(hold_program(back=False), rng, 0.5) is None
    assert let_go(hold_program(back=True), rng, 1.0) is not None
    assert core.mode is Mode.ARMED


def test_a_button_that_taps_by_itself_is_refused_and_does_so() -> None:
    refused = check_program(self_tapping()).refused
    assert any("for ever" in finding.reason for finding in refused)
    assert let_go(self_tapping(), np.random.default_rng(2), 2.0) is None


def test_a_weak_spot_is_refused_and_the_cap_stays_there() -> None:
    weak = line("weak", (0.0, 40.0), (1.0, 40.0), (1.2, 2.0), (1.4, 40.0))
    program = Program("weak", 4.0, "up", (State("up", "weak", "weak"),), (weak,))
    (finding,) = check_program(program).refused
    assert finding.state == "up"
    assert finding.place.startswith("1.20 mm") or finding.place.startswith("1.15 mm")
    core = Core(Settings(), compile_program(program).image)
    core.arm()
    cap = FreeCap(4.0, 0.05, 0.0, 4.0, x_mm=1.2)
    for _ in range(2000):
        cap.advance(float(core.run(inputs_at(Settings(), [cap.x_mm]))[0]["commanded_cN64"]) / 64)
        if core.mode is not Mode.ARMED:
            break
    assert cap.x_mm == pytest.approx(1.2, abs=0.01)


@pytest.mark.parametrize("name", [p.name for p in programs()])
def test_a_shipped_program_comes_back_within_its_bound(name: str) -> None:
    program = make(name, cooldown_ms=100) if name == "returning-later" else make(name)
    bound_s = check_program(program).return_s
    assert bound_s is not None
    rng = np.random.default_rng(3)
    times = [let_go(program, rng, bound_s + 0.01) for _ in range(2)]
    assert None not in times


@campaign("block", range(30), part=1)
def test_random_programs_that_are_accepted_come_back_within_their_bound(block: int) -> None:
    accepted, seeds = 0, range(1000 + 50 * block, 1050 + 50 * block)
    for seed in seeds:
        rng = np.random.default_rng(seed)
        program = random_program(rng)
        report = check_program(program)
        if report.return_s is None:
            assert all(f.reason and (f.state or f.place) for f in report.refused)
            continue
        accepted += 1
        assert let_go(program, rng, report.return_s + 0.01) is not None, f"seed {seed}"
    assert 5 <= accepted <= len(seeds) - 5


def test_a_bound_of_time_is_not_far_above_what_happens() -> None:
    program = Program("plain", 4.0, "up", (State("up", "push", "push"),), (flat("push", 40.0),))
    bound_s = check_program(program).return_s
    assert bound_s is not None
    core = Core(Settings(), compile_program(program).image)
    core.arm()
    cap = FreeCap(8.0, 0.05, 0.0, 4.0, x_mm=4.0)
    ticks = 0
    while cap.x_mm > 0.1:
        cap.advance(float(core.run(inputs_at(Settings(), [cap.x_mm]))[0]["commanded_cN64"]) / 64)
        ticks += 1
    assert 0.5 * bound_s < ticks * TICK_s < bound_s
