"""What a builder knows of a rig is read from TOML, and what is wrong with it is said in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.own_force import NODES, prior_root
from fdvv.compensation.identification.prior_file import load_prior, load_sensor
from fdvv.compensation.identification.rig_model import RANGES, Prior, ranges_of, size_of
from fdvv.errors import InputError
from tests.compensation._plant import Plant, TRAVEL_mm

SENSOR = "range_N = 5.0\nnoise_cN = 0.3\ndelay_ms = 0.04\n"


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "known.toml"
    path.write_text(text)
    return path


def test_what_is_known_replaces_the_mean_and_the_spread_and_nothing_else(tmp_path: Path) -> None:
    prior = load_prior(
        written(
            tmp_path, "mass_g = { mean = 5.0, spread = 1.0 }\nelectric_lag_ms = { mean = 0.2, spread = 0.05 }"
        )
    )
    assert set(prior.ranges) == {"mass_g", "electric_lag_s"}
    assert (prior.ranges["mass_g"].mean, prior.ranges["mass_g"].spread) == (5.0, 1.0)
    assert prior.ranges["electric_lag_s"].mean == pytest.approx(2e-4)
    means, spreads, *_ = prior.vectors(1e-3)
    plain, wide, *_ = Prior().vectors(1e-3)
    assert (means != plain).sum() == (spreads != wide).sum() == 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mas_g = { mean = 5.0, spread = 1.0 }", 'mas_g: is no key of this file; did you mean "mass_g"?'),
        ("mass_g = 5.0", "mass_g: must hold a mean and a spread"),
        ("mass_g = { mean = 5.0 }", "mass_g: must hold a mean and a spread"),
        ('mass_g = { mean = "5", spread = 1.0 }', "mass_g.mean: must be a number, got '5'"),
        ("mass_g = { mean = 5.0, spread = 0 }", "mass_g.spread: is 0; write one standard deviation"),
        ("mass_g = { mean = 0.005, spread = 1.0 }", "mass_g.mean: is 0.005, not 0.5 to 1000; check its unit"),
        ("", "says nothing of the rig"),
    ],
)
def test_a_wrong_prior_is_refused_with_file_key_and_remedy(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        load_prior(written(tmp_path, text))
    line = str(caught.value)
    assert said in line
    assert "known.toml" in line
    assert "\n" not in line


def test_a_load_cell_has_a_plate_before_it_and_a_worn_sensor_a_mass_behind_it(tmp_path: Path) -> None:
    cell = load_sensor(written(tmp_path, SENSOR + "plate_g = 0.4\nstiffness_N_mm = 500\n"))
    assert cell.cell is not None
    assert (cell.cell.plate_kg, cell.cell.stiffness_N_m) == pytest.approx((4e-4, 5e5))
    assert cell.cell.damping_N_s_m == pytest.approx(2 * 0.05 * np.sqrt(5e5 * 4e-4))
    assert cell.sensor.cone_g == pytest.approx(-0.4)
    worn = load_sensor(written(tmp_path, SENSOR + "moving_g = 2.0\n"))
    assert worn.cell is None
    assert (worn.sensor.cone_g, worn.sensor.noise_cN) == (2.0, 0.3)
    assert worn.sensor.filter_s == pytest.approx(4e-5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("range_N = 5.0\nnoise_cN = 0.3\n", "delay_ms: is missing"),
        (SENSOR + "plate_g = 0.4\n", "stiffness_N_mm: is missing; a load cell in the cap needs"),
        (SENSOR + "gain = 1.0\n", "gain: is no key of this file"),
        (SENSOR.replace("5.0", "5000.0"), "range_N: is 5000, not 0.05 to 1000; check its unit"),
    ],
)
def test_a_wrong_data_sheet_is_refused_with_file_key_and_remedy(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        load_sensor(written(tmp_path, text))
    assert said in str(caught.value)


def test_rigs_of_the_class_keep_their_prior_and_others_go_with_their_force() -> None:
    for full_duty_N in (None, 5.0, 16.0, 35.0):
        assert ranges_of(full_duty_N) == RANGES
    assert size_of(0.5) == pytest.approx(0.1)
    assert size_of(70.0) == pytest.approx(2.0)
    weak, strong = ranges_of(0.5), ranges_of(70.0)
    assert weak["mass_g"].mean == pytest.approx(2.2)
    assert strong["mass_g"].mean == pytest.approx(44.0)
    for name in ("gain_0", "position_lag_s", "half_play_cN"):
        assert weak[name] == strong[name] == RANGES[name]
    for sized in (weak, strong):
        for name, known in RANGES.items():
            assert sized[name].spread * max(known.mean, 1e-9) >= 0.999 * known.spread * sized[name].mean


def test_a_springs_spread_is_a_line_beside_the_two_smooth_parts() -> None:
    plain, sprung = (prior_root(0.25, 1.0, 0.5, spread) for spread in (0.0, 3.0))
    places = 0.25 * np.arange(NODES)
    added = sprung @ sprung.T - plain @ plain.T
    np.testing.assert_allclose(added, 9.0 * np.outer(places, places), atol=1e-5)


def test_a_certain_prior_holds_the_number_and_a_wrong_one_is_paid_for(tmp_path: Path) -> None:
    plant = Plant(position_noise_mm=2e-3, force_noise_cN=0.5)
    presses = [plant.press(100.0, 0)]
    for mean in (plant.mass_g, 10.0):
        prior = load_prior(written(tmp_path, f"mass_g = {{ mean = {mean}, spread = 0.05 }}"))
        assert identify(presses, TRAVEL_mm, prior).mass_g == pytest.approx(mean, abs=0.3)
