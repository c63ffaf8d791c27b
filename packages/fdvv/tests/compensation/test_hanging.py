"""No learned table lets a free cap hang: found over the whole travel, mended, or refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import CompensationJob
from fdvv.compensation.rig_aware import RigAware
from fdvv.compensation.rig_learning import hanging_mm, least_command_cN
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

TARGET = ForceSurface.of_model(load_builtin("mx-clear"), [50.0, 200.0])
JOB = CompensationJob(TARGET, 4.0, 440.0)
RIG = RigModel(
    gain=(0.9, 0.05, -0.01),
    friction_cN=3.0,
    stick_cN=2.0,
    weight_cN=12.0,
    mass_g=20.0,
    own_cN=(4.0, 0.0, -14.0, 6.0, 4.0),
    own_step_mm=1.0,
)


def surface_of(rows_cN: FloatArray, job: CompensationJob = JOB, rig: RigModel = RIG) -> ForceSurface:
    """Return the commands of a rig on which these rows, (n,), were learned for every curve."""
    rows = np.tile(rows_cN, (2, 1))
    residual = ForceSurface(TARGET.displacement_mm, TARGET.velocity_mm_s, rows, rows)
    method = RigAware(rounds=0, learned_rig=LearnedRig(rig, residual, 4.0, np.ones((2, 2))))
    return method.done(method.init(job)).surface


def comes_home(rig: RigModel, surface: ForceSurface, row: int, from_mm: float) -> bool:
    """Let a free cap go at a displacement: follow it slowly with a release's table, by its force alone."""
    x = from_mm
    while x > 0:
        coil = np.interp(x, surface.displacement_mm, surface.release_cN[row]) * rig.gain_at(np.array(x))
        net = float(coil) + float(rig.own_at(np.array(x)))
        if net <= rig.friction_cN + rig.stick_cN:
            return False
        x -= 0.01
    return True


def test_a_dip_anywhere_is_found_and_mended_over_the_whole_travel() -> None:
    x = TARGET.displacement_mm
    for middle in np.arange(0.3, 4.0, 0.4):
        dip = -120.0 * np.exp(-(((x - middle) / 0.15) ** 2))
        raw = ForceSurface(x, TARGET.velocity_mm_s, TARGET.press_cN + 13 + dip, TARGET.release_cN + 13 + dip)
        assert np.abs(hanging_mm(RIG, raw, 4.0) - middle).min() < 0.06
        assert not comes_home(RIG, raw, 0, 4.0)
        mended = surface_of(dip)
        assert hanging_mm(RIG, mended, 4.0).size == 0
        assert all(comes_home(RIG, mended, row, start) for row in (0, 1) for start in (4.0, 2.0, 0.5))


def test_a_table_that_lifts_everywhere_stays_as_it_is() -> None:
    x, learned = TARGET.displacement_mm, np.full(TARGET.displacement_mm.size, 4.0)
    surface, beyond = surface_of(learned), TARGET.displacement_mm > 0.1
    expected = (TARGET.release_cN - RIG.own_at(x)) / RIG.gain_at(x) + 4.0
    np.testing.assert_allclose(surface.release_cN[:, beyond], expected[:, beyond])


def test_a_fast_press_may_take_its_inertia_off_but_its_release_lifts() -> None:
    surface = surface_of(np.full(TARGET.displacement_mm.size, -100.0))
    least = least_command_cN(RIG, TARGET.displacement_mm, 440.0)
    beyond = TARGET.displacement_mm > 0.1
    assert (surface.press_cN[1] < least)[beyond & (TARGET.displacement_mm < 3.0)].all()
    assert (surface.press_cN[0] >= least)[beyond].all()
    assert (surface.release_cN >= least).all()


def test_a_rig_too_weak_to_lift_its_cap_is_refused_in_one_line() -> None:
    heavy = replace(RIG, weight_cN=150.0)
    with pytest.raises(ModelError, match=r"the cap would hang at 2\.\d+ mm: .* the limit is 120") as caught:
        surface_of(np.zeros(TARGET.displacement_mm.size), replace(JOB, force_limit_cN=120.0), heavy)
    assert "\n" not in str(caught.value)
