"""What a known rig says of its force."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import ModelError
from fdvv.units import FloatArray

RIG = RigModel((0.9, 0.05, -0.01), 9e-4, 4e-4, 5e-4, 5.0, 4.5, 3.0, 15.0, 20.0)


def even(count: int, step_s: float) -> FloatArray:
    return np.arange(count, dtype=np.float64) * step_s


def test_at_rest_it_is_the_command_times_the_gain_less_the_weight_plus_friction() -> None:
    t = even(200, 2.5e-4)
    x, v, none = np.full(200, 2.0), np.full(200, 1e-9), np.zeros(200)
    rendered = RIG.finger_force_cN(t, x, v, none, np.full(200, 60.0))
    np.testing.assert_allclose(rendered, 0.96 * 60.0 - 15.0 + 3.0, atol=1e-6)


def test_opposing_is_what_is_felt_without_command_once_the_lag_has_passed() -> None:
    t = even(400, 2.5e-4)
    a = 2.0
    v = 1000 * a * t
    x = 0.5 * v * t
    rendered = RIG.finger_force_cN(t, np.zeros(400), v, np.full(400, a), np.zeros(400))
    opposing_cN = RIG.opposing_cN(v, np.full(400, a), np.zeros(400))
    np.testing.assert_allclose(rendered[40:], opposing_cN[40:], atol=1e-6)
    assert not np.allclose(RIG.opposing_cN(v, a + 0 * v, x)[100:], opposing_cN[100:], atol=0.1)


def test_where_the_gain_is_one_drag_and_mass_are_as_stated() -> None:
    unit = RigModel(drag_N_s_m=5.0, back_emf_N_s_m=4.0, electric_lag_s=1e-3, mass_g=20.0)
    v, a = np.array([100.0, -50.0]), np.array([3.0, 2.0])
    np.testing.assert_allclose(unit.opposing_cN(v, a, np.zeros(2)), 0.1 * 5.0 * v + 0.1 * (20.0 - 4.0) * a)


def test_a_command_is_felt_after_its_delay() -> None:
    t = even(4000, 2.5e-5)
    still = np.zeros(4000)
    rendered = RigModel(delay_s=1e-3, electric_lag_s=6e-4).finger_force_cN(t, still, still, still, 1000 * t)
    np.testing.assert_allclose(rendered[1000:], 1000 * (t[1000:] - 1e-3), atol=1e-6)


def test_numbers_that_are_not_finite_are_refused() -> None:
    with pytest.raises(ModelError, match="finite"):
        RigModel(mass_g=float("nan"))
