"""The mass found with a load cell is that of all that moves: the cell does not feel its own plate."""

from __future__ import annotations

import numpy as np

from fdvv.compensation.force_loop.method import ForceLoop
from fdvv.compensation.method import CompensationJob
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import CellSpec
from tests.compensation._plant import Plant

# the plate takes part of the finger's force: what is read is less by its mass times acceleration
PLATE_g, FILTER_s, TICK_s = 0.6, 4e-5, 1e-4
BEHIND = Plant(
    mass_g=18.0 - PLATE_g,
    cone_g=0.0,
    filter_s=FILTER_s,
    back_emf_N_s_m=0.0,
    position_lag_s=5e-4,
    command_delay_s=8e-5,
    electric_lag_s=5e-5,
    position_noise_mm=0.001,
    force_noise_cN=0.1,
    tick_s=TICK_s,
)


def test_the_plate_before_the_cell_counts_with_the_mass() -> None:
    speeds = np.array([50.0, 100.0, 150.0, 200.0])
    job = CompensationJob(ForceSurface.of_model(load_builtin("mx-clear"), speeds), 4.0, 440.0)
    method = ForceLoop(
        CellSpec(plate_kg=1e-3 * PLATE_g, stiffness_N_m=5e5, damping_N_s_m=1.4, filter_s=FILTER_s),
        TICK_s,
        rounds=0,
    )
    state = method.init(job)
    while trial := method.trial(state):
        state = method.step(BEHIND.press(trial.velocity_mm_s), state)
    assert state.rig is not None
    assert abs(state.rig.mass_g - 18.0) < 0.3
    assert state.gains is not None
    assert abs(1e3 * state.gains.mass_kg - 18.0) < 0.3
