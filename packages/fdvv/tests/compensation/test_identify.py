"""A rig's numbers are found again in presses of a plant in closed form, and of the twin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.identification.balance import Sensor
from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_model import Plausible, Prior, RigModel
from fdvv.compensation.rig_aware import explain_rig
from fdvv.device.twin import TwinDevice
from fdvv.errors import FitError, ModelError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from tests.compensation._plant import Plant, TRAVEL_mm, keep_rows, known_of
from tests.support.rig_truth import draw_fast_rig, missed_cN, rig_truth

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
FREE = {
    "gain_0": Plausible(0.9, 10.0),
    "gain_1": Plausible(0.07, 10.0),
    "gain_2": Plausible(-0.011, 10.0),
    "viscous_N_s_m": Plausible(0.5, 10.0, 0.0),
    "back_emf_N_s_m": Plausible(3.0, 100.0),
    "friction_cN": Plausible(4.0, 100.0, 0.0),
    "weight_cN": Plausible(20.0, 500.0),
    "mass_g": Plausible(22.0, 200.0, 1.0),
    "half_play_cN": Plausible(1.0, 0.01, 0.0),
    "position_lag_s": Plausible(9e-4, 1e-2, 5e-5, 4e-3),
    "electric_lag_s": Plausible(5e-4, 1e-2, 2e-5, 4e-3),
}
"""Hardly any belief."""


def presses_of(plant: Plant) -> list[Press]:
    return [plant.press(v, seed) for seed, v in enumerate(SPEEDS_mm_s)]


def compare(known: RigModel, plant: Plant) -> dict[str, float]:
    """Return the errors by name, with the gain at mid travel."""
    true, middle = known_of(plant), np.array(0.5 * TRAVEL_mm)
    names = [name for name in known.error if name not in ("gain", "own_cN")]
    missed = {name: getattr(known, name) - getattr(true, name) for name in names}
    return {**missed, "gain": float(known.gain_at(middle) - true.gain_at(middle))}


CLOSE = {
    "gain": 0.002,
    "delay_s": 1e-5,
    "electric_lag_s": 4e-5,
    "position_lag_s": 2e-5,
    "drag_N_s_m": 0.02,
    "back_emf_N_s_m": 0.03,
    "friction_cN": 0.1,
    "weight_cN": 0.3,
    "mass_g": 0.2,
    "play_cN": 0.01,
    "stick_cN": 0.1,
    "side_ratio": 0.002,
}
PLANTS = {
    "voltage drive": Plant(),
    "current drive": Plant(back_emf_N_s_m=0.0, viscous_N_s_m=0.8, electric_lag_s=1e-4),
    "heavy, slow coil": Plant(mass_g=38.0, electric_lag_s=1.2e-3, weight_cN=2.0, friction_cN=1.5),
    "old positions": Plant(position_lag_s=1.6e-3, mass_g=13.0),
}


@pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)
def test_without_noise_a_plant_in_closed_form_is_found_again(plant: Plant) -> None:
    no_play = Prior(ranges={**FREE, "half_play_cN": Plausible(1e-3, 1e-3, 0.0)})
    known = identify(presses_of(plant), TRAVEL_mm, no_play)
    missed = compare(known, plant)
    assert {name: found for name, found in missed.items() if abs(found) > CLOSE[name]} == {}
    assert np.abs(known.own_cN).max() < 0.1
    assert known.residual_cN < 0.05


def test_the_sensors_cone_and_filter_are_taken_off_as_the_data_sheet_tells() -> None:
    plant = Plant(cone_g=6.0, filter_s=8e-4)
    ranges = {**FREE, "half_play_cN": Plausible(1e-3, 1e-3, 0.0)}
    known = identify(presses_of(plant), TRAVEL_mm, Prior(sensor=Sensor(8e-4, 6.0), ranges=ranges))
    assert {n: x for n, x in compare(known, plant).items() if abs(x) > CLOSE[n]} == {}


NOISY = Plant(position_noise_mm=0.005, force_noise_cN=0.4, half_play_cN=1.5)


@pytest.mark.slow
def test_with_noise_the_standard_errors_hold() -> None:
    found = []
    for seed in range(4):
        presses = [NOISY.press(v, 10 * seed + k) for k, v in enumerate(SPEEDS_mm_s)]
        known = identify(presses, TRAVEL_mm)
        found.append({name: x / known.error[name] for name, x in compare(known, NOISY).items()})
        assert known.position_noise_mm == pytest.approx(0.005, rel=0.15)
    size = np.array([list(each.values()) for each in found])
    assert np.abs(size).max() < 5.0
    assert np.sqrt(np.mean(size**2)) < 2.0


def test_one_press_gives_a_rig_that_is_not_wild() -> None:
    known = identify([NOISY.press(100.0)], TRAVEL_mm)
    missed = compare(known, NOISY)
    assert abs(missed["gain"]) < 0.15
    assert abs(missed["drag_N_s_m"]) < 1.5
    assert abs(missed["mass_g"]) < 10.0


def test_truth_is_not_looked_at() -> None:
    press = NOISY.press(100.0)
    other = replace(press, displacement_mm=np.zeros(press.t_s.size), force_cN=np.ones(press.t_s.size))
    assert identify([press], TRAVEL_mm) == identify([other], TRAVEL_mm)


def test_rows_between_ticks_and_missing_ticks_change_little() -> None:
    presses = presses_of(NOISY)
    plain = identify(presses, TRAVEL_mm)
    holed = [keep_rows(press, np.delete(np.arange(press.t_s.size), slice(150, 153))) for press in presses]
    again = identify(holed, TRAVEL_mm)
    assert abs(again.mass_g - plain.mass_g) < 3 * plain.error["mass_g"]
    assert abs(again.drag_N_s_m - plain.drag_N_s_m) < 3 * plain.error["drag_N_s_m"]


SOUND = NOISY.press(100.0)


@pytest.mark.parametrize(
    ("presses", "says"),
    [
        ([], "needs presses"),
        ([replace(SOUND, commanded_cN=None)], "press 1 holds no commanded force"),
        ([SOUND, keep_rows(SOUND, slice(0, 30))], "press 2 has 30 ticks"),
        ([replace(SOUND, sensed_cN=np.nan * SOUND.t_s)], "press 1 holds numbers that are not finite"),
        ([replace(SOUND, sensed_mm=0.0 * SOUND.t_s)], "too few rows between the stops"),
    ],
)
def test_presses_that_tell_nothing_give_one_line(presses: list[Press], says: str) -> None:
    with pytest.raises(FitError, match=says) as caught:
        identify(presses, TRAVEL_mm)
    assert "\n" not in str(caught.value)


def test_a_prior_knows_its_names_and_spreads() -> None:
    with pytest.raises(ModelError, match="no rig parameter is called weight; choose from gain_0"):
        Prior(ranges={"weight": Plausible(1.0, 1.0)})
    with pytest.raises(ModelError, match="needs a spread"):
        Plausible(1.0, 0.0)
    with pytest.raises(ModelError, match="compute_ratio"):
        Prior(compute_ratio=2.0)


@pytest.mark.parametrize("drive", ["voltage", "current"])
def test_presses_of_the_twin_tell_its_force_within_a_few_centinewtons(drive: str) -> None:
    for seed in (203, 206):
        rig, finger = draw_fast_rig(seed, drive)
        button = load_builtin("mx-clear")
        target = ForceSurface.of_model(button, SPEEDS_mm_s, 0.05)
        device, fresh = TwinDevice(rig, finger, seed), TwinDevice(rig, finger, seed + 5000)
        device.upload(identification_surface(target), button.travel_mm)
        fresh.upload(identification_surface(target, ripple_cN=0.0), button.travel_mm)
        known = identify([device.press(v) for v in SPEEDS_mm_s], button.travel_mm)
        traces = [fresh.press_trace(v) for v in SPEEDS_mm_s]
        before = missed_cN(RigModel(), rig, traces, button.travel_mm)
        after = missed_cN(known, rig, traces, button.travel_mm)
        floor = missed_cN(rig_truth(rig), rig, traces, button.travel_mm)
        assert after < 0.15 * before
        assert after < floor + 2.0


def test_identified_parameters_are_reported_with_their_errors_and_weak_ones_marked() -> None:
    known = identify([NOISY.press(100.0)], TRAVEL_mm)
    text = explain_rig(known)
    assert f"mass {known.mass_g:.1f} +- {known.error['mass_g']:.1f} g" in text
    assert f"from 1 presses; {known.residual_cN:.1f} cN rms unexplained" in text
    assert "weak: " in explain_rig(replace(known, error={"mass_g": 0.6 * known.mass_g}))
    assert "weak" not in explain_rig(replace(known, error={"mass_g": 0.4 * known.mass_g}))
