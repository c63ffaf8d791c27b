"""The firmware's force loop against its equations in double precision, and with a cell that fails."""

from __future__ import annotations

import ctypes
import re
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
import pytest

from fdvv._native import library
from fdvv.compensation.force_loop.gains import estimator_gains, rate
from fdvv.protocol.tables import ForceLoopGains

HEADER = Path(__file__).parents[4] / "firmware" / "force_loop" / "loop_protocol.h"
TRAVEL_m, MIDDLE = 4e-3, 2048
TICK_s, REVERSAL_m = 1e-4, 1e-4
STEEPEST_N_m = 800.0
SOUND, SATURATED, DEAD, WRONG = range(4)

GAINS = ForceLoopGains(
    tick_s=TICK_s,
    compute_ratio=0.3,
    mass_kg=0.0116,
    plate_kg=4e-4,
    drag_N_s_m=0.4,
    brake_N_s_m=0.0,
    friction_N=0.04,
    friction_m=1e-4,
    own_N=(-0.12, -0.1, -0.13, -0.05, -0.16, -0.12, -0.02, -0.2),
    own_per_m=1750.0,
    gain=0.95,
    gain_1_m=20.0,
    gain_1_m2=-3000.0,
    coil_rate=rate(TICK_s, 5e-5),
    cell_rate=rate(TICK_s, 4e-5),
    position_rate=rate(TICK_s, 5e-4),
    free_gains=tuple(estimator_gains(TICK_s, 5e-4, 0.0116, 1e-5, 0.05).tolist()),
    stop_gains=tuple(estimator_gains(TICK_s, 5e-4, 0.0116, 1e-5, 3.0).tolist()),
    lead_s=1.7e-4,
    velocity_lead_s=1.7e-4,
    proportional=4.2,
    derivative_s=1.4e-3,
    lowpass_rate=rate(TICK_s, 1 / (2 * np.pi * 4500)),
    integral_1_s=0.4,
    leak=2e-4,
    damping_N_s_m=13.0,
    highpass_rate=rate(TICK_s, 1 / (2 * np.pi * 300)),
    contact_rate=rate(TICK_s, 1e-3),
)


class Loop:
    """fdvv_force_loop by its functions; its memory is opaque."""

    def __init__(self, gains: ForceLoopGains = GAINS) -> None:
        self._lib, self._memory = library(), ctypes.create_string_buffer(1024)
        for name in ("ahead_m", "command_N", "open_N", "release_at"):
            getattr(self._lib, f"fdvv_force_loop_{name}").restype = ctypes.c_float
        self._lib.fdvv_force_loop_init(self._memory, gains.pack())

    @property
    def _x_m(self) -> float:
        """The estimated displacement, which lies behind the gains."""
        return ctypes.c_float.from_buffer(self._memory, len(GAINS.pack())).value

    def tick(
        self, position_m: float, cell_N: float, target_N: float, state: int = 0, apart_N: float = 0.3
    ) -> tuple[float, float]:
        """Return displacement ahead and command of a tick with the same target ahead and now, in a state.

        apart_N : between the curves of both strokes.
        """
        number = ctypes.c_float
        lib, memory = self._lib, self._memory
        lib.fdvv_force_loop_estimate(memory, number(position_m), number(cell_N), number(TRAVEL_m))
        self._turn(apart_N)
        self.turned = self._x_m, self.release_at(self._x_m)
        ahead = float(lib.fdvv_force_loop_ahead_m(memory))
        target = number(target_N)
        lib.fdvv_force_loop_enter(memory, ctypes.c_uint8(state), target)
        command = float(lib.fdvv_force_loop_command_N(memory, target, target, number(TRAVEL_m)))
        lib.fdvv_force_loop_predict(memory, number(command))
        return ahead, command

    def _turn(self, apart_N: float) -> None:
        """Follow the cap's turns between curves that lie so far apart."""
        apart, reversal, travel = (ctypes.c_float(value) for value in (apart_N, REVERSAL_m, TRAVEL_m))
        self._lib.fdvv_force_loop_turn(self._memory, apart, reversal, travel)

    def release_at(self, x_m: float) -> float:
        """Return the weight of the release's curve at a displacement."""
        return float(self._lib.fdvv_force_loop_release_at(self._memory, ctypes.c_float(x_m)))

    def watch(self, counts: int) -> int:
        """Watch one reading of the cell and return why the loop was opened, SOUND if it was not."""
        self._lib.fdvv_force_loop_watch(self._memory, ctypes.c_uint16(counts), ctypes.c_uint16(MIDDLE))
        return int(self._lib.fdvv_force_loop_fault(self._memory))

    def is_closed(self) -> bool:
        """Return whether the loop used the cell in the last tick."""
        return bool(self._lib.fdvv_force_loop_is_closed(self._memory))


@dataclass
class Oracle:
    """The same equations, as docs/explanation/force-loop.md has them, in double precision."""

    g: ForceLoopGains = GAINS
    x: float = 0.0
    v: float = 0.0
    a: float = 0.0
    d: float = 0.0
    s: float | None = None
    u: float = 0.0
    u_f: float = 0.0
    last: float = 0.0
    e: float = 0.0
    low: tuple[float, float] = (0.0, 0.0)
    total: float = 0.0
    slow: float = 0.0
    touch: float = 0.0
    slid: float = 0.0
    slid_at: float = 0.0
    state: int | None = None
    target: float = 0.0
    step: float = 0.0

    def own_N(self, x_m: float) -> float:
        return float(np.interp(x_m * self.g.own_per_m, np.arange(8), self.g.own_N))

    def tick(self, position_m: float, f: float, target: float, state: int = 0) -> tuple[float, float]:
        g = self.g
        if self.s is None:
            self.x = self.s = self.slid_at = position_m
        gains = g.free_gains
        beyond = position_m - self.s
        self.x += gains[0] * beyond
        self.v += gains[1] * beyond
        self.d = float(np.clip(self.d + gains[2] * beyond, -0.15, 0.15))
        self.s += gains[3] * beyond
        self.slid = float(np.clip(self.slid + (self.x - self.slid_at) / g.friction_m, -1, 1))
        self.slid_at = self.x
        rub = g.friction_N * self.slid
        push = f + g.plate_kg * self.a - self.u_f - g.drag_N_s_m * self.v - rub - self.own_N(self.x) + self.d
        self.a = push / g.mass_kg
        felt = f + g.plate_kg * self.a
        ahead = self.x + g.lead_s * self.v + 0.5 * g.lead_s**2 * self.a
        if self.state not in (None, state):
            self.step += self.target - target
        self.state, self.target = state, target
        error = float(np.clip(max(target + self.step, 0.0) - felt, -0.5, 0.5))
        self.step *= 1 - g.tick_s / 1e-3
        self.touch += g.contact_rate * (float(np.clip((felt - 0.005) / 0.03, 0, 1)) - self.touch)
        wanted = g.proportional * error + g.derivative_s * (error - self.e) / g.tick_s
        self.e = error
        first = self.low[0] + g.lowpass_rate * (wanted - self.low[0])
        self.low = (first, self.low[1] + g.lowpass_rate * (first - self.low[1]))
        fed = float(np.clip(self.low[1], -3, 3))
        self.total += g.integral_1_s * g.tick_s * error * self.touch
        self.total *= 1 - g.leak
        fed *= 0.15 + 0.85 * self.touch if fed > 0 else self.touch
        fast = self.v + g.velocity_lead_s * self.a
        self.slow += g.highpass_rate * (self.v - self.slow)
        bracket = target - self.own_N(ahead) - (g.drag_N_s_m + g.brake_N_s_m) * fast
        bracket -= rub
        bracket += 4.0 * (1 - self.touch) * (self.v - float(np.clip(self.v, -0.3, 0.3)))
        bracket += fed + self.total + g.damping_N_s_m * (self.v - self.slow) * self.touch
        command = bracket / (g.gain + ahead * (g.gain_1_m + ahead * g.gain_1_m2))
        mean = command + g.compute_ratio * (self.last - command)
        held = (g.gain + self.x * (g.gain_1_m + self.x * g.gain_1_m2)) * mean + g.brake_N_s_m * self.v
        self.last = command
        self.u += g.coil_rate * (held - self.u)
        self.u_f += g.cell_rate * (self.u - self.u_f)
        self.x += g.tick_s * self.v + 0.5 * g.tick_s**2 * self.a
        self.v += g.tick_s * self.a
        self.s += g.position_rate * (self.x - self.s)
        return ahead, command


def test_the_gains_are_the_header_s_in_name_and_order() -> None:
    text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(encoding="utf-8"), flags=re.DOTALL)
    end = text.index("} fdvv_force_loop_gains;")
    body = text[text.rindex("typedef struct {", 0, end) : end]
    declared = re.findall(r"float (\w+)(?:\[(\d)\])?;", body)
    assert [name for name, _ in declared] == [f.name for f in fields(ForceLoopGains)]
    assert sum(int(count or 1) for _, count in declared) == len(GAINS.pack()) // 4


def test_the_loop_follows_its_equations_between_the_stops() -> None:
    random = np.random.default_rng(1)
    loop, oracle = Loop(), Oracle()
    t = np.arange(800) * TICK_s
    places = 2e-3 + 1e-3 * np.sin(2 * np.pi * 8 * t) + 5e-6 * random.standard_normal(t.size)
    forces = 0.6 + 0.3 * np.sin(2 * np.pi * 21 * t) + 1e-3 * random.standard_normal(t.size)
    for place, force in zip(places, forces, strict=True):
        ahead, command = loop.tick(place, force, 0.6)
        wanted_ahead, wanted = oracle.tick(place, force, 0.6)
        assert ahead == pytest.approx(wanted_ahead, abs=2e-7)
        assert command == pytest.approx(wanted, abs=2e-3)


def test_a_loop_in_a_program_follows_its_equations_through_pulls_steps_and_free_flight() -> None:
    random = np.random.default_rng(2)
    loop, oracle = Loop(), Oracle()
    t = np.arange(1200) * TICK_s
    places = 2e-3 + 0.7e-3 * np.sin(2 * np.pi * 80 * t) + 5e-6 * random.standard_normal(t.size)
    forces = np.maximum(0.0, 0.5 * np.sin(2 * np.pi * 9 * t)) + 1e-4 * random.standard_normal(t.size)
    states = (t / 0.013).astype(int) % 3
    for place, force, state in zip(places, forces, states.tolist(), strict=True):
        target = (0.4, -0.1, 0.7)[state]
        _, command = loop.tick(place, force, target, state)
        assert command == pytest.approx(oracle.tick(place, force, target, state)[1], abs=4e-3)


def test_a_step_between_states_does_not_kick_a_held_cap() -> None:
    """The same step of the target within a state is answered by the lead, which wants all that it may."""
    largest = []
    for state in (0, 1):
        loop = Loop()
        for _ in range(2000):
            loop.tick(2e-3, 0.6, 0.6)
        largest.append(max(loop.tick(2e-3, 0.6, 0.2, state)[1] * -1 for _ in range(10)))
    assert largest[1] < 0.5 * largest[0]


def test_a_still_cap_under_its_target_is_commanded_target_and_weight() -> None:
    loop = Loop()
    for _ in range(3000):
        _, command = loop.tick(2e-3, 0.6, 0.6)
    assert command * (GAINS.gain + 2e-3 * GAINS.gain_1_m + 4e-6 * GAINS.gain_1_m2) == pytest.approx(
        0.6 - float(np.interp(3.5, np.arange(8), GAINS.own_N)), abs=0.05
    )


@pytest.mark.parametrize(
    ("counts", "fault"),
    [
        ([0] * 210, SATURATED),
        ([4095] * 210, SATURATED),
        ([4095] * 150 + [2000], SOUND),
        ([2000, 2001] * 300, SOUND),
    ],
)
def test_a_cell_that_is_saturated_for_long_opens_the_loop(counts: list[int], fault: int) -> None:
    loop = Loop()
    assert [loop.watch(one) for one in counts][-1] == fault


@pytest.mark.parametrize(("speed_m_s", "fault"), [(0.05, DEAD), (0.0, SOUND)])
def test_a_cell_whose_reading_does_not_change_is_dead_if_the_cap_moves(speed_m_s: float, fault: int) -> None:
    loop = Loop()
    for k in range(500):
        loop.tick(1e-3 + speed_m_s * TICK_s * k, 0.6, 0.6)
        found = loop.watch(2000)
    assert found == fault


def test_an_overload_opens_the_loop_while_it_lasts() -> None:
    loop, is_closed = Loop(), []
    for counts in [2000, 4095, 4095, 2001]:
        loop.watch(counts)
        is_closed.append(loop.is_closed())
    assert is_closed == [True, False, False, True]


def test_a_strong_finger_at_the_bottom_stop_is_no_fault_of_the_cell() -> None:
    loop, faults = Loop(), []
    for _ in range(600):
        loop.tick(TRAVEL_m, 4.4, 0.9)
        faults.append(loop.watch(4095))
    assert set(faults) == {SOUND}
    assert not loop.is_closed()


@pytest.mark.parametrize("apart_N", [0.05, 0.3, 0.6])
@pytest.mark.parametrize("swing_m", [4e-6, 2e-5, 3e-4])
def test_a_cap_that_swings_between_the_strokes_gains_no_energy_from_the_target(
    apart_N: float, swing_m: float
) -> None:
    """The force against the cap, over whole swings, takes energy from it, however small they are."""
    loop, path = Loop(), []
    turns = np.linspace(0, 2 * np.pi * 5, 2001)
    for x_m in 2e-3 + swing_m * np.sin(turns) - np.minimum(turns, 1.0) * 1e-4:
        loop.tick(x_m, 0.5, 0.5, apart_N=apart_N)
        path.append(loop.turned)
    x, weight = np.array(path).T
    work_J = -apart_N * np.sum(0.5 * (weight[1:] + weight[:-1]) * np.diff(x))
    assert work_J > -1e-12


@pytest.mark.parametrize("apart_N", [0.05, 0.3, 0.6])
def test_between_the_strokes_the_target_is_no_steeper_than_the_loop_bears(apart_N: float) -> None:
    loop = Loop()
    weights = []
    for x_m in 2e-3 - np.arange(0, 1e-3, 1e-6):
        loop.tick(x_m, 0.5, 0.5, apart_N=apart_N)
        weights.append(loop.turned)
    x, weight = np.array(weights).T
    rising = (weight > 0) & (weight < 1)
    slope = -np.polyfit(x[rising], apart_N * weight[rising], 1)[0]
    assert slope == pytest.approx(min(STEEPEST_N_m, apart_N / REVERSAL_m), rel=0.05)
    assert weight[-1] == 1.0


@pytest.mark.parametrize(("place_m", "weight"), [(TRAVEL_m, 1.0), (0.0, 0.0)], ids=["bottom", "top"])
def test_a_stop_turns_the_stroke(place_m: float, weight: float) -> None:
    loop = Loop()
    for x_m in 2e-3 + (place_m - 2e-3) * np.minimum(np.arange(600) / 400, 1.0):
        loop.tick(x_m, 0.5, 0.5)
    assert loop.turned[1] == weight


@pytest.mark.parametrize("sign", [-1.0, 0.0], ids=["reversed", "unplugged"])
def test_a_cell_that_contradicts_the_motion_opens_the_loop(sign: float) -> None:
    """A finger of 0.8 N holds the cap where its coil gives 0.8 N; the cell says otherwise."""
    loop, faults = Loop(), []
    for k in range(1500):
        loop.tick(2e-3, sign * 0.8, 0.8)
        faults.append(loop.watch(MIDDLE + k % 2))
    assert faults[-1] == WRONG


def test_ringing_halves_what_is_fed_back() -> None:
    loop = Loop(replace(GAINS, damping_N_s_m=0.0))
    commands = [loop.tick(2e-3, 0.6 + 0.5 * (-1) ** (k // 4), 0.6)[1] for k in range(400)]
    assert np.ptp(commands[-80:]) < 0.6 * np.ptp(commands[20:80])


def test_ringing_that_goes_on_at_half_the_gain_is_halved_again() -> None:
    """A tip of steel rings at a quarter of the gain as at the whole of it."""
    loop = Loop(replace(GAINS, damping_N_s_m=0.0, integral_1_s=0.0, lead_s=0.0))
    commands = [loop.tick(2e-3, 0.6 + 0.25 * (-1) ** (k // 8), 0.6)[1] for k in range(2000)]
    assert np.ptp(commands[-80:]) < 0.05 * np.ptp(commands[:80])


def test_a_force_that_swings_slowly_is_no_ringing() -> None:
    loop = Loop(replace(GAINS, damping_N_s_m=0.0))
    commands = [loop.tick(2e-3, 0.6 + 0.4 * np.sin(2 * np.pi * 20 * k * TICK_s), 0.6)[1] for k in range(2000)]
    assert np.ptp(commands[-500:]) > 0.95 * np.ptp(commands[500:1000])
