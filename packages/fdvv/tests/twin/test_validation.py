"""The rig's twin against what is known of such loops, coils, averages and exciters."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import NONE
from fdvv.twin.image import image_of
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil, Exciter, Mover
from fdvv.twin.settings import settings_of
from tests.support.cap_vibration import SNAP_AT_mm, SNAP_Hz, cap_vibration, press_with, snap, ways
from tests.support.closed_forms import coil_error_ratio, mean_response, ripple_N
from tests.support.loop import (
    AWAY,
    LinearLoop,
    bare_loop,
    cycles,
    grainy_loop,
    onset_N_m,
    quantisation_limit_N_m,
)


def test_a_released_coil_gains_speed_as_its_closed_form_says() -> None:
    assert coil_error_ratio() < 1e-3


def test_a_sliding_mean_of_25_ms_is_deaf_to_40_hz() -> None:
    assert mean_response(40.0)[0] < 1e-3
    for frequency_Hz in (5.0, 27.0, 60.0):
        found, expected = mean_response(frequency_Hz)
        assert found == pytest.approx(expected, abs=2e-4)


def test_the_loop_begins_to_cycle_where_its_largest_eigenvalue_reaches_one() -> None:
    rig = bare_loop()
    limit = LinearLoop(rig).limit_N_m()
    assert not cycles(rig, 0.95 * limit)
    assert cycles(rig, 1.05 * limit)


@pytest.mark.slow
def test_the_onset_of_cycling_lies_within_a_twentieth_of_the_eigenvalues_at_4_khz_too() -> None:
    rig = bare_loop(2.5e-4)
    limit = LinearLoop(rig).limit_N_m()
    assert onset_N_m(rig, 0.7 * limit, 1.5 * limit) == pytest.approx(limit, rel=0.05)


def test_friction_swallows_the_grain_of_the_position_up_to_its_known_limit_and_not_beyond() -> None:
    rig = grainy_loop()
    limit = quantisation_limit_N_m(rig)
    assert not cycles(rig, 0.95 * limit, still_mm=1e-3)
    assert cycles(rig, 1.05 * limit, still_mm=1e-3)


def test_a_synthesised_vibration_is_felt_within_a_millisecond_of_its_displacement() -> None:
    _, rig, settings, at_mm = ways()[3]
    for velocity in (50.0, 300.0):
        seen = cap_vibration(rig, settings, at_mm, velocity)
        assert abs(seen.late_ms) < 1.0
        assert seen.frequency_Hz == pytest.approx(SNAP_Hz, rel=0.08)


def test_a_late_sample_makes_a_vibration_late() -> None:
    rig = Rig(exciter=Exciter(latency_s=2e-4, jitter_s=0.0))
    late = Rig(exciter=Exciter(latency_s=6e-3, jitter_s=0.0))
    settings = settings_of(rig)
    onset = [cap_vibration(r, settings, SNAP_AT_mm, 100.0).late_ms for r in (rig, late)]
    assert onset[1] - onset[0] == pytest.approx(5.8, abs=0.3)


def test_the_magnet_pushes_the_cap_by_what_moves_it() -> None:
    free = Mover(gravity_m_s2=0.0, coulomb_N=0.0, viscous_N_s_m=0.0)
    plant = RigPlant(Rig(mover=free, exciter=Exciter(latency_s=0.0, jitter_s=0.0)), AWAY, seed=None)
    button = load_builtin("mx-clear")
    plant.load(image_of(ForceSurface.of_model(button, [100.0]), 4.0, [], [snap()]).image)
    for tick in range(50):
        pulling = tick < 15
        plant.step(-600 if pulling else 0, pulling, 0, 0 if tick == 30 else NONE)
    trace, mass_kg = plant.record(), plant.rig.exciter.mass_kg
    drifting = (trace.t_s > 0.02) & (trace.displacement_mm < 5.0)
    cap_m_s, t = 1e-3 * trace.cap_velocity_mm_s, trace.t_s
    magnet_m_s = cap_m_s + np.gradient(1e-6 * trace.magnet_um, t)
    momentum = plant.rig.frame_kg * cap_m_s + mass_kg * magnet_m_s
    shaken = np.ptp(plant.rig.frame_kg * cap_m_s[drifting])
    assert shaken > 5e-5
    assert np.ptp(momentum[drifting]) < 0.05 * shaken


def test_a_rig_without_an_exciter_does_not_feel_a_vibration() -> None:
    rig = Rig(exciter=Exciter(fitted="no"))
    with_it, without = (press_with(rig, settings_of(rig), SNAP_AT_mm, 100.0, s) for s in ([snap()], []))
    assert (with_it.slot != NONE).any()
    assert np.array_equal(with_it.cap_acceleration_m_s2, without.cap_acceleration_m_s2)


def test_the_ripple_of_a_switched_bridge_is_that_of_its_current_followed_step_by_step() -> None:
    coil, amps, seen = Coil(), 0.0, []
    ohm, period = coil.resistance_ohm + coil.bridge_ohm, 1000
    for step in range(40 * period):
        volts = coil.supply_V if step % period < period / 2 else 0.0
        amps += (volts - ohm * amps) / coil.inductance_H / (732.0 * period)
        seen.append(amps)
    followed = float(np.ptp(seen[-period:])) * coil.force_constant_N_A
    assert ripple_N(coil, 732.0) == pytest.approx(followed, rel=2e-3)
