"""What a finger would notice of a curve, against errors that are known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.model.file import load_builtin
from fdvv.model.noticeable import LITERATURE
from fdvv.model.surface import ForceSurface
from fdvv.rendering.evaluation.noticed import Noticed, overall, summarize
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.evaluation.vibration_presses import NONE_ASKED, RenderedVibration
from fdvv.rendering.probe import probe
from fdvv.testing.scripted import ScriptedDevice
from fdvv.vibration.compare import VibrationError

MODEL = load_builtin("mx-clear")
NOTHING = Noticed(0.0, 0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def curve() -> ProbeCurve:
    """Return a curve to change the force of."""
    return probe(ScriptedDevice(), MODEL, ForceSurface.of_model(MODEL, [100.0]), [100.0], 2).curves[0]


def off_by(curve: ProbeCurve, steps_JND: float, sign: float = 1.0) -> ProbeCurve:
    """Return a curve whose force is off by so much everywhere, and that asks for no vibration."""
    error_cN = sign * steps_JND * LITERATURE.force_cN(curve.target_cN)
    rendered = np.tile(curve.target_cN + error_cN, (2, 1))
    achieved = np.tile(curve.target_cN, (2, 1))
    return replace(curve, rendered_cN=rendered, at_achieved_cN=achieved, vibration=NONE_ASKED)


def shaken(curve: ProbeCurve, steps_JND: float) -> ProbeCurve:
    """Return a curve whose vibration is off by so much in strength."""
    error = VibrationError(True, (1.0,) * 4, (1.0,) * 4, 0.0, steps_JND, 20.0)
    return replace(curve, vibration=RenderedVibration(MODEL.vibration("press", 100.0), error=error))


def test_a_perfect_rendering_is_never_noticed(curve: ProbeCurve) -> None:
    perfect = shaken(off_by(curve, 0.0), 0.0)
    for part in ("total", "force", "force_at_achieved_speed", "force_to_entry", "force_beyond_entry"):
        assert perfect.noticeable()[part] == NOTHING.to_dict()
    assert max(perfect.noticeable()["noticed_ratio"]) == 0


@given(steps=st.floats(0.0, 20.0), sign=st.sampled_from([-1.0, 1.0]))
def test_an_error_of_so_many_jnds_everywhere_is_that(curve: ProbeCurve, steps: float, sign: float) -> None:
    found = off_by(curve, steps, sign).total
    assert found.mean_JND == pytest.approx(steps, abs=1e-9)
    assert found.largest_JND == pytest.approx(steps, abs=1e-9)
    assert found.excess_JND == pytest.approx(max(0.0, steps - 1), abs=1e-9)
    if abs(steps - 1) > 1e-6:
        assert found.above_ratio == float(steps > 1)


def test_a_vibration_is_added_by_squares_where_it_should_be_felt_and_nowhere_else(curve: ProbeCurve) -> None:
    found = shaken(off_by(curve, 0.8), 0.8).total_JND[0]
    x = curve.displacement_mm
    # 16 ms at 100 mm/s from 2.3 mm on
    felt = (x >= 2.3) & (x <= 3.9)
    np.testing.assert_allclose(found[felt], 0.8 * np.sqrt(2))
    np.testing.assert_allclose(found[~felt], 0.8)


def test_the_beginning_is_reported_apart(curve: ProbeCurve) -> None:
    entry = curve.displacement_mm <= 0.6 + 1e-9
    step_cN = np.where(entry, 3 * LITERATURE.force_cN(curve.target_cN), 0.0)
    late = replace(curve, rendered_cN=curve.target_cN + step_cN[None, :])
    found = late.noticeable()
    assert found["force_to_entry"]["above_ratio"] == 1
    assert found["force_beyond_entry"]["above_ratio"] == 0
    assert found["force"]["above_ratio"] == pytest.approx(entry.mean())


def test_the_speed_achieved_is_a_second_target(curve: ProbeCurve) -> None:
    far = replace(off_by(curve, 2.0), at_achieved_cN=off_by(curve, 2.0).rendered_cN)
    assert far.noticeable()["force"]["above_ratio"] == 1
    assert far.noticeable()["force_at_achieved_speed"] == NOTHING.to_dict()


@given(st.lists(st.floats(0.0, 50.0), min_size=1, max_size=40))
def test_the_share_and_the_excess_agree_with_counting(steps: list[float]) -> None:
    found = summarize(np.array([steps]))
    assert found.above_ratio == pytest.approx(sum(s > 1 for s in steps) / len(steps))
    assert found.excess_JND == pytest.approx(sum(max(0.0, s - 1) for s in steps) / len(steps))


def test_a_rendering_is_the_mean_of_its_curves_and_nothing_has_nothing() -> None:
    assert overall([Noticed(0.2, 1.0, 2.0, 4.0), NOTHING]) == Noticed(0.1, 0.5, 1.0, 2.0)
    assert summarize(np.empty((3, 0))) == NOTHING
