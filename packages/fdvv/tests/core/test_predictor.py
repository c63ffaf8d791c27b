"""Looking ahead, drag and friction against their formulas in floating point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from fdvv.firmware.core import Core, RecordArray
from fdvv.protocol.tables import Condition, Settings, VelocitySource
from tests.support.core.predictor import Predictor
from tests.support.core.programs import REST, armed, image, when
from tests.support.inputs import inputs_at
from tests.support.random_presses import random_inputs, random_path_mm, random_settings
from tests.support.random_programs import random_image

FloatArray = npt.NDArray[np.float64]

# a force in cN64 that is half the place in um16, from 0 to 4 mm; and none anywhere
PLACES = image(
    tables=[(0, 16000, [1600], [[0, 8000, 16000, 24000, 32000]])],
    states=[(replace(REST, velocity_source=VelocitySource.ANNOUNCED), ())],
)
NOTHING = image()
FREE = replace(
    Settings(),
    # the finest places
    position_gain_q14=1024,
    position_offset_um16=0,
    reads=64,
    reading_low=0,
    reading_high=65535,
    force_limit_cN64=32000,
    slew_cN64_tick=32000,
    jump_um16=65535,
    late_ticks=1000,
)


def tuned(bandwidth_Hz: float, tick_us: int = 250, **more: int) -> Settings:
    q = 1 - np.exp(-2e-6 * np.pi * bandwidth_Hz * tick_us)
    return replace(FREE, tick_us=tick_us, predictor_q16=round(2**16 * q), **more)


def float_states(z: FloatArray, bandwidth_Hz: float, tick_s: float) -> tuple[FloatArray, ...]:
    """Return position, velocity and acceleration of the g-h-k filter of textbooks."""
    p = np.exp(-2 * np.pi * bandwidth_Hz * tick_s)
    alpha, beta, gamma = 1 - p**3, 1.5 * (1 - p) ** 2 * (1 + p), (1 - p) ** 3 / 2
    x, v, a, found = z[0], 0.0, 0.0, [(z[0], 0.0, 0.0)]
    for sensed in z[1:]:
        x, v = x + v * tick_s + a * tick_s**2 / 2, v + a * tick_s
        beyond = sensed - x
        x, v, a = x + alpha * beyond, v + beta * beyond / tick_s, a + 2 * gamma * beyond / tick_s**2
        found.append((x, v, a))
    return tuple(np.array(found).T)


def places_mm(settings: Settings, inputs: RecordArray) -> FloatArray:
    """Return where the surface was read, to 2 um16."""
    return np.asarray(armed(PLACES, settings).run(inputs)["commanded_cN64"] / 8000)


def sensed_mm(settings: Settings, inputs: RecordArray) -> FloatArray:
    return np.asarray(Core(settings).run(inputs)["displacement_um16"] / 16000)


@pytest.mark.parametrize("tick_us", [100, 250, 1000])
@pytest.mark.parametrize("bandwidth_Hz", [60, 100, 400])
def test_the_gains_put_three_poles_in_one_place(bandwidth_Hz: float, tick_us: int) -> None:
    p = np.exp(-2e-6 * np.pi * bandwidth_Hz * tick_us)
    alpha, beta, gamma = 1 - p**3, 1.5 * (1 - p) ** 2 * (1 + p), (1 - p) ** 3 / 2
    # place, velocity and half the acceleration per tick
    forward = np.array([[1.0, 1.0, 1.0], [0.0, 1.0, 2.0], [0.0, 0.0, 1.0]])
    gains = np.array([[alpha], [beta], [gamma]])
    around = (np.eye(3) - gains @ np.array([[1.0, 0.0, 0.0]])) @ forward
    np.testing.assert_allclose(np.poly(around), np.poly([p, p, p]), atol=1e-12)
    held = Predictor(tuned(bandwidth_Hz, tick_us)).gains
    found = [ratio.mantissa / 2.0 ** (ratio.shift + right) for ratio, right in held if ratio]
    np.testing.assert_allclose(np.array(found) / [1, 1, 64], gains.ravel(), rtol=5e-4)


@pytest.mark.parametrize("tick_us", [50, 100, 250, 1000])
@pytest.mark.parametrize("bandwidth_Hz", [60, 150, 400])
def test_it_looks_where_the_filter_in_floating_point_does(bandwidth_Hz: float, tick_us: int) -> None:
    rng = np.random.default_rng(tick_us)
    settings = tuned(bandwidth_Hz, tick_us, lead_us=2000)
    path_mm = np.clip(random_path_mm(rng, 3000, tick_us) + rng.normal(0, 0.002, 3000), 0.0, 3.9)
    inputs = inputs_at(settings, path_mm)
    x, v, a = float_states(sensed_mm(settings, inputs), bandwidth_Hz, tick_us * 1e-6)
    ahead = x + np.clip(v * 2e-3 + a * 2e-3**2 / 2, -1, 1)
    inside = (ahead > 0) & (ahead < 4)
    error = np.abs(places_mm(settings, inputs) - ahead)[inside]
    assert np.median(error) < 5e-5
    assert error.max() < 2.5e-4


@pytest.mark.parametrize("tick_us", [50, 100, 250, 1000])
@pytest.mark.parametrize("acceleration_mm_s2", [-4000.0, 0.0, 4000.0])
def test_a_steady_acceleration_is_foreseen_exactly_once_settled(
    acceleration_mm_s2: float, tick_us: int
) -> None:
    settings, lead_s = tuned(100, tick_us, lead_us=5000), 5e-3
    t = np.arange(0, 0.05, tick_us * 1e-6)
    x = (lambda t: 0.5 + 50 * t + acceleration_mm_s2 * (t * (t - 0.03)) / 2)(t)
    found = places_mm(settings, inputs_at(settings, x))
    ahead = (lambda t: 0.5 + 50 * t + acceleration_mm_s2 * (t * (t - 0.03)) / 2)(t + lead_s)
    settled = (t > 0.025) & (ahead > 0) & (ahead < 4)
    assert settled.sum() > 10
    np.testing.assert_allclose(found[settled], ahead[settled], atol=1e-3)


@pytest.mark.parametrize("speed_mm_s", [-200.0, -5.0, 0.0, 3.0, 50.0])
def test_drag_and_friction_are_taken_off_by_speed_and_direction(speed_mm_s: float) -> None:
    # 2 N s/m is 0.2 cN per mm/s
    drag = {"drag_q13": round(0.8 * 2**13), "friction_cN64": 5 * 64, "friction_mm_s16": 10 * 16}
    settings = tuned(250, brake_lead_us=3000, **drag)
    x = (0.2 if speed_mm_s >= 0 else 3.8) + speed_mm_s * 250e-6 * np.arange(70)
    found = armed(NOTHING, settings).run(inputs_at(settings, x))["commanded_cN64"][-10:] / 64
    wanted = -0.2 * speed_mm_s - 5 * np.clip(speed_mm_s / 10, -1, 1)
    np.testing.assert_allclose(found, wanted, atol=0.05)


def test_the_speed_that_drag_goes_by_is_the_one_after_its_own_lead() -> None:
    settings = tuned(100, brake_lead_us=4000, lead_us=1000, drag_q13=round(0.8 * 2**13))
    t = np.arange(0, 0.05, 250e-6)
    found = armed(NOTHING, settings).run(inputs_at(settings, 0.1 + 1500 * t**2))["commanded_cN64"] / 64
    np.testing.assert_allclose(found[t > 0.025], -0.2 * (3000 * (t + 4e-3))[t > 0.025], atol=0.1)


def test_no_look_goes_further_than_a_millimetre() -> None:
    settings = tuned(400, lead_us=20000)
    x = 0.2 + 0.4 * 0.25 * np.arange(25)  # 400 mm/s, 8 mm in the lead
    found = places_mm(settings, inputs_at(settings, x))
    np.testing.assert_allclose(found[-5:], x[-5:] + 1, atol=2e-3)


@pytest.mark.parametrize(("gap", "begins_anew"), [(8, False), (9, True)])
def test_missed_ticks_are_predicted_over_and_a_gap_is_a_new_beginning(gap: int, begins_anew: bool) -> None:
    settings = tuned(100, lead_us=4000)
    elapsed = np.ones(101, np.uint16)
    elapsed[100] = gap
    x = 0.1 + 100 * 250e-6 * np.cumsum(elapsed)
    inputs = inputs_at(settings, x)
    inputs["elapsed_ticks"] = elapsed
    found = places_mm(settings, inputs)[-1]
    assert found == pytest.approx(x[-1] if begins_anew else x[-1] + 0.4, abs=2e-3)


def test_a_cap_that_is_suddenly_elsewhere_is_a_new_beginning() -> None:
    settings = tuned(100, lead_us=4000)
    x = np.concatenate([0.1 + 0.02 * np.arange(80), [3.0]])
    assert places_mm(settings, inputs_at(settings, x))[-1] == pytest.approx(3.0, abs=5e-4)


@pytest.mark.parametrize("seed", range(12))
def test_turned_off_it_changes_no_bit_whatever_else_is_set(seed: int) -> None:
    rng = np.random.default_rng(seed)
    plain = replace(
        random_settings(rng), predictor_q16=0, lead_us=0, brake_lead_us=0, drag_q13=0, friction_cN64=0
    )
    program, inputs = random_image(rng, plain), random_inputs(rng, 500, plain)
    idle = replace(plain, lead_us=9000, brake_lead_us=9000, drag_q13=40000, friction_cN64=6400)
    assert armed(program, plain).run(inputs).tobytes() == armed(program, idle).run(inputs).tobytes()


def test_a_state_is_faded_into_from_what_the_last_one_wanted() -> None:
    # 12 cN of drag are taken off before and after: the command does not jump
    settings = tuned(100, drag_q13=round(0.8 * 2**13))
    table = (0, 16000, [1600], [[1000, 1000]])
    fades = replace(REST, fade_ms=100)
    crossed = when(Condition.DEEPER_THAN, 32000, 1)
    program = image(states=[(REST, [crossed]), (fades, [])], tables=[table])
    x = 0.1 + 60 * 250e-6 * np.arange(200)
    found = armed(program, settings).run(inputs_at(settings, x))
    at = int(np.argmax(found["state"] == 1))
    assert at > 100
    np.testing.assert_allclose(found["commanded_cN64"][at - 40 :], 1000 - 12 * 64, atol=3)
