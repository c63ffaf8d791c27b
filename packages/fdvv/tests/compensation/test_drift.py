"""One press tells what of a rig has changed, and is silent where nothing has."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.identification.drift import detect_drift
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_model import RigModel
from tests.compensation._plant import Plant, TRAVEL_mm

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
RIG = Plant(position_noise_mm=0.003, force_noise_cN=0.3, half_play_cN=0.5)


@pytest.fixture(scope="module")
def known() -> RigModel:
    return identify([RIG.press(v, seed) for seed, v in enumerate(SPEEDS_mm_s)], TRAVEL_mm)


@pytest.mark.parametrize("velocity_mm_s", SPEEDS_mm_s)
def test_a_press_of_the_same_rig_says_nothing(known: RigModel, velocity_mm_s: float) -> None:
    for seed in range(100, 103):
        assert detect_drift(known, RIG.press(velocity_mm_s, seed), TRAVEL_mm) == ""


WARM = tuple(0.9 * np.array(RIG.gain))
WORN = {
    "drag rose from 4.": replace(RIG, viscous_N_s_m=RIG.viscous_N_s_m + 4.4),
    "friction rose from 5.": replace(RIG, friction_cN=RIG.friction_cN + 5.0),
    "gain fell 1": replace(RIG, gain=WARM, back_emf_N_s_m=RIG.back_emf_N_s_m / 0.9),
    "mass rose from ": replace(RIG, mass_g=RIG.mass_g + 10.0),
}


# One press holds more of the press stroke than of the release; there less weight feels like more friction.
ALIKE = {"friction rose from 5.": "weight fell from 18."}


@pytest.mark.parametrize("seed", range(50, 54))
@pytest.mark.parametrize(("says", "worn"), WORN.items(), ids=WORN)
def test_the_change_is_named_with_its_size(known: RigModel, says: str, worn: Plant, seed: int) -> None:
    message = detect_drift(known, worn.press(100.0, seed), TRAVEL_mm)
    assert message.startswith((says, ALIKE.get(says, says)))


def test_the_size_of_a_change_is_that_of_the_plant(known: RigModel) -> None:
    text = detect_drift(known, WORN["drag rose from 4."].press(100.0, 50), TRAVEL_mm)
    was, to = (float(word) for word in text.split() if word.replace(".", "").isdigit())
    assert to - was == pytest.approx(4.4, abs=0.4)


def test_two_changes_are_both_named(known: RigModel) -> None:
    both = replace(RIG, viscous_N_s_m=RIG.viscous_N_s_m + 4.4, mass_g=RIG.mass_g + 15.0)
    text = detect_drift(known, both.press(100.0, 50), TRAVEL_mm)
    assert "drag rose" in text
    assert "mass rose" in text


def test_a_press_that_no_number_explains_is_strange(known: RigModel) -> None:
    press = RIG.press(50.0, 50)
    assert press.sensed_cN is not None
    hum = 12.0 * np.sin(2 * np.pi * 21.0 * press.t_s)
    assert "unexplained" in detect_drift(known, replace(press, sensed_cN=press.sensed_cN + hum), TRAVEL_mm)
