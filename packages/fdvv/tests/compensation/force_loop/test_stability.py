"""The loop's margins over fingers: against a circuit solved by hand, and what the design promises."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.force_loop.gains import design_controller
from fdvv.compensation.force_loop.stability import (
    LARGEST_PEAK,
    COUNTED_quantile,
    FingerBank,
    HeldFinger,
    LOOP_Hz,
    LoopController,
    LoopPlant,
)
from fdvv.errors import ModelError

RECOMMENDED = LoopPlant(
    mass_kg=0.0116,
    plate_kg=4e-4,
    drag_N_s_m=0.3,
    cell_N_m=5e5,
    cell_N_s_m=2 * 0.05 * math.sqrt(5e5 * 4e-4),
    coil_s=5e-5,
    cell_s=1 / (2 * math.pi * 4000),
    delay_s=8e-5,
)
SOFT = HeldFinger(0.005, 300.0, 4.0, 2500.0, 0.1, 0.3, 0.5, 0.2, False)
OPEN = LoopController(1e-9, 1e-12, 1000.0, 1e-9, 1e-9, 100.0)


@pytest.fixture(scope="module")
def designed() -> LoopController:
    return design_controller(RECOMMENDED)


def test_the_loop_is_that_of_springs_and_masses_in_series() -> None:
    controller = LoopController(4.0, 1e-3, 3000.0, 0.5, 10.0, 200.0)
    at = 100
    s = 2j * math.pi * LOOP_Hz[at]
    # pad and joint, then the plate, then the softest cell
    pad = 2500.0 * (0.2 / 0.3 + 0.1) * (0.3 + 0.35 * (s * 0.004 / (1 + s * 0.004) + s * 0.1 / (1 + s * 0.1)))
    top = 1 / (1 / pad + 1 / (0.005 * s**2 + 4 * s + 300)) + 4e-4 * s**2
    held = 1 / (1 / top + 1 / (0.6 * 5e5 + RECOMMENDED.cell_N_s_m * s))
    force = (4 + 1e-3 * s) / (1 + s / (2 * math.pi * 3000)) ** 2 + 0.5 / (s + 2)
    motion = 10 * s**2 / (s + 2 * math.pi * 200)
    delay = np.exp(-8e-5 * s) / (1 + 5e-5 * s) / (1 + s * RECOMMENDED.cell_s)
    cap = 0.0116 * s**2 + 0.3 * s
    wanted = delay * (force * (held - 4e-4 * s**2) + motion + (1 + force) * 500.0) / (cap + held)
    found = FingerBank(RECOMMENDED, (SOFT,)).loop(controller)[1, 0, at]
    assert found == pytest.approx(wanted, rel=1e-9)


def test_without_a_controller_all_of_the_cap_s_dynamics_are_felt_and_no_finger_rings() -> None:
    bank = FingerBank(RECOMMENDED)
    assert bank.residual_ratio(OPEN) == pytest.approx(1.0, abs=1e-6)
    assert np.isfinite(bank.peaks(OPEN)).all()


def test_a_gain_that_is_far_too_high_is_seen_to_be_unstable() -> None:
    assert np.isinf(FingerBank(RECOMMENDED).peaks(LoopController(60.0, 0.02, 4000.0, 0.4, 10.0, 200.0))).any()


def test_the_design_keeps_its_margins_over_the_bank(designed: LoopController) -> None:
    peaks = FingerBank(RECOMMENDED).peaks(designed)
    assert np.isfinite(peaks).all()
    assert np.quantile(peaks, COUNTED_quantile) <= LARGEST_PEAK


def test_the_design_leaves_a_third_of_the_cap_s_dynamics(designed: LoopController) -> None:
    assert FingerBank(RECOMMENDED).residual_ratio(designed).max() < 1 / 3


def drawn_finger(random: np.random.Generator, fresh: bool) -> HeldFinger:
    joint = random.uniform(0.0035, 0.0087), random.uniform(255.0, 1255.0), random.uniform(4.0, 7.4)
    pad = random.uniform(2000.0, 4000.0), random.uniform(0.08, 0.15)
    relaxing = random.uniform(0.2, 0.4), random.uniform(0.3, 0.7)
    return HeldFinger(*joint, *pad, *relaxing, random.uniform(0.05, 1.0), fresh)


def test_fingers_that_the_gains_were_not_chosen_for_are_stable_with_half_as_much_again(
    designed: LoopController,
) -> None:
    random = np.random.default_rng(7)
    fingers = tuple(drawn_finger(random, fresh=bool(i % 2)) for i in range(60))
    strong = replace(
        designed,
        proportional=1.5 * designed.proportional,
        derivative_s=1.5 * designed.derivative_s,
        damping_N_s_m=1.5 * designed.damping_N_s_m,
    )
    assert np.isinf(FingerBank(RECOMMENDED, fingers).peaks(designed)).mean() == 0
    assert np.isinf(FingerBank(RECOMMENDED, fingers).peaks(strong)).mean() < 0.01


def test_a_loop_with_four_times_the_delay_gets_less_gain(designed: LoopController) -> None:
    slow = design_controller(replace(RECOMMENDED, delay_s=3.5e-4))
    assert slow.proportional < 0.6 * designed.proportional


def test_a_rig_that_no_gain_suits_is_refused() -> None:
    with pytest.raises(ModelError, match=r"no gain of the force loop is stable .* 30 ms of delay"):
        design_controller(replace(RECOMMENDED, delay_s=0.03, cell_N_s_m=1e-6))
