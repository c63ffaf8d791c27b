import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpread, ModeSpread, PointSpread, VibrationSpread
from fdvv.model.vibration import Mode, Vibration

X_mm = np.array([0.0, 1.0, 3.0])


def test_a_spread_is_read_on_lines_between_its_places_and_is_unknown_beyond() -> None:
    spread = CurveSpread(X_mm, np.array([1.0, 3.0, 5.0]), 4)
    np.testing.assert_allclose(spread.at_cN([0.0, 0.5, 2.0, 3.0]), [1.0, 2.0, 4.0, 5.0])
    assert np.isnan(spread.at_cN([-0.1, 3.1])).all()


def test_a_standard_error_is_the_spread_over_the_root_of_the_presses() -> None:
    assert float(CurveSpread(X_mm, np.full(3, 6.0), 9).error_cN(1.5)) == pytest.approx(2.0)
    assert PointSpread(0.04, 16).error_mm == pytest.approx(0.01)


def test_the_standard_error_is_that_of_a_mean_of_drawn_presses() -> None:
    rng = np.random.default_rng(11)
    drawn = rng.normal(50.0, 3.0, (4000, 12))
    error_cN = CurveSpread(np.array([0.0, 1.0]), np.full(2, 3.0), 12).error_cN(0.5)
    assert float(np.std(drawn.mean(axis=1))) == pytest.approx(float(error_cN), rel=0.04)


@pytest.mark.parametrize(
    ("x_mm", "spread_cN", "presses", "said"),
    [
        ([0.0, 1.0], [1.0], 5, "got 2 and 1"),
        ([0.0], [1.0], 5, "2 places or more"),
        ([0.0, 0.0], [1.0, 1.0], 5, "rise strictly"),
        ([0.0, 1.0], [1.0, -1.0], 5, "at least 0"),
        ([0.0, 1.0], [1.0, float("nan")], 5, "finite"),
        ([0.0, 1.0], [1.0, 1e9], 5, "stay within"),
        ([0.0, 1.0], [1.0, 1.0], 1, "at least 2 presses, got 1"),
    ],
)
def test_a_curves_spread_that_is_none_is_refused(
    x_mm: list[float], spread_cN: list[float], presses: int, said: str
) -> None:
    with pytest.raises(ModelError, match=said):
        CurveSpread(np.array(x_mm), np.array(spread_cN), presses)


@pytest.mark.parametrize(
    ("achieved_mm_s", "spread_mm_s", "said"),
    [
        (0.0, None, "achieved_mm_s must be positive"),
        (float("inf"), None, "achieved_mm_s"),
        (50.0, -1.0, "at least 0"),
    ],
)
def test_a_speed_that_is_none_is_refused(achieved_mm_s: float, spread_mm_s: float | None, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        CurveSpread(X_mm, np.ones(3), 5, achieved_mm_s, spread_mm_s)


def test_points_and_vibrations_refuse_what_is_no_spread() -> None:
    with pytest.raises(ModelError, match="spread_mm must be at least 0"):
        PointSpread(-0.1, 5)
    with pytest.raises(ModelError, match="at least 2 presses"):
        PointSpread(0.1, 1)
    with pytest.raises(ModelError, match="the spread of decay_1_s"):
        ModeSpread(decay_1_s=-1.0)
    with pytest.raises(ModelError, match="the spread of onset_mm"):
        VibrationSpread(5, onset_mm=float("nan"))


def test_a_vibrations_spread_tells_of_each_of_its_modes_or_of_none() -> None:
    modes = (Mode(239.0, 1.0, 10.0), Mode(400.0, 0.5, 20.0))
    for count in (0, 2):
        Vibration(Stroke.PRESS, None, 2.0, 0.01, modes, VibrationSpread(5, modes=(ModeSpread(3.0),) * count))
    with pytest.raises(ModelError, match="tells of 1 modes, the vibration has 2"):
        Vibration(Stroke.PRESS, None, 2.0, 0.01, modes, VibrationSpread(5, modes=(ModeSpread(3.0),)))


def test_a_point_that_is_unknown_has_no_spread() -> None:
    curve = ForceCurve(Stroke.PRESS, 50.0, 1, np.array([0.0, 0.0, 4.0, 4.0]), np.array([0.0, 60.0]))
    with pytest.raises(ModelError, match="reset_mm is unknown"):
        FDVVModel("one", 4.0, (curve,), actuation_mm=2.0, reset_spread=PointSpread(0.1, 5))
