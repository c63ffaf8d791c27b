"""The linear stage that static figures are made with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.device.twin import TwinDevice
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import stage_finger
from fdvv.twin.pace import mean_speed_mm_s
from fdvv.twin.rig import Rig
from fdvv.twin.rig_moves import Coil, Mover

TRAVEL_mm = 1.5
"""Short, since a press at 0.5 mm/s takes its time."""


def pressed(rig: Rig, surface: ForceSurface, seed: int = 0, travel_mm: float = TRAVEL_mm) -> Press:
    device = TwinDevice(rig, stage_finger(), seed)
    device.upload(surface, travel_mm)
    return device.press(0.5)


def level(force_cN: float) -> ForceSurface:
    """Make a table of one force."""
    table = np.full((1, 2), force_cN)
    return ForceSurface(np.array([0.0, 6.2]), np.array([50.0]), table, table)


def ideal() -> Rig:
    """Make a horizontal rig that pushes with the commanded force, with friction of 1 cN."""
    coil = Coil(droop_ratio=0.0, reluctance_H_m=0.0, source_ohm=0.0, command_bits=0)
    return replace(Rig(), coil=coil, mover=Mover(gravity_m_s2=0.0, coulomb_N=0.01, viscous_N_s_m=0.0))


def test_it_presses_at_the_speed_of_the_papers_probing_machine_down_to_the_deepest_stop() -> None:
    rig = Rig()
    travel_mm = 1000 * rig.stops.travel_limit_m
    press = pressed(rig, level(60.0), travel_mm=travel_mm)
    assert mean_speed_mm_s(press.t_s, press.displacement_mm, travel_mm) == pytest.approx(0.5, rel=0.006)


def test_what_it_feels_of_a_rig_without_faults_is_the_command_and_the_friction() -> None:
    press = pressed(ideal(), level(60.0))
    turn = int(press.displacement_mm.argmax())
    inside = (press.displacement_mm > 0.2) & (press.displacement_mm < 1.4)
    down = inside & (np.arange(inside.size) < turn)
    # back-EMF and inertia of 20 g at 0.8 mm/s: 0.4 cN at most with the coil's 4.9 N s/m
    np.testing.assert_allclose(press.force_cN[down], 61.0, atol=0.5)
    np.testing.assert_allclose(press.force_cN[inside & ~down], 59.0, atol=0.5)


def test_it_holds_the_cap_on_a_falling_flank_that_a_finger_snaps_through() -> None:
    steep = ForceSurface(
        np.linspace(0.0, 1.5, 5),
        np.array([50.0]),
        *(np.array([[60.0, 100.0, 20.0, 40.0, 60.0]]) for _ in range(2)),
    )
    press = pressed(ideal(), steep)
    fastest = np.abs(np.diff(press.displacement_mm[::100]) / np.diff(press.t_s[::100])).max()
    assert fastest < 2.0


def test_nothing_of_the_stage_varies_only_the_rigs_noise_does() -> None:
    one, other = (pressed(Rig(), level(60.0), seed) for seed in (1, 2))
    assert one.t_s.size == other.t_s.size
    np.testing.assert_allclose(one.force_cN[::1000], other.force_cN[::1000], atol=1.0)
