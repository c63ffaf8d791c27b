"""Which rows are kept, and what is said of every curve."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import CompensationJob
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.per_curve import PerCurve
from fdvv.compensation.rig_learning import PressError, WORSE_ratio, best_rows, curves_of, minimum_lift_surface
from fdvv.compensation.tables import SharedTable
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface

MODEL = load_builtin("mx-clear")
SPEEDS_mm_s = np.array([50.0, 100.0])
TARGET = ForceSurface.of_model(MODEL, SPEEDS_mm_s)
JOB = CompensationJob(TARGET, MODEL.travel_mm, 440.0)
COUNT = TARGET.displacement_mm.size


def table(value_cN: float) -> SharedTable:
    return SharedTable(TARGET.displacement_mm, SPEEDS_mm_s, np.full((2, COUNT), value_cN), np.eye(2))


def press_error(error_cN: float, row_cN: float) -> PressError:
    return PressError(error_cN, 0.5 * error_cN, 3 * error_cN, np.full(COUNT, row_cN))


def presses(errors_cN: list[float], release_cN: float = 2.0) -> tuple[tuple[PressError, PressError], ...]:
    """Return the presses of one speed; press k was made on a row of k."""
    return tuple((press_error(error, k), press_error(release_cN, k)) for k, error in enumerate(errors_cN))


def test_the_row_of_the_best_press_is_kept_where_the_last_got_much_worse() -> None:
    history = (presses([6.0, 2.0, 2.0 * WORSE_ratio + 0.1]), presses([6.0, 3.0, 3.1]))
    press, release = best_rows((table(9.0), table(8.0)), history)
    np.testing.assert_array_equal(press.rows_cN[:, 0], [1.0, 9.0])
    np.testing.assert_array_equal(release.rows_cN[:, 0], [8.0, 8.0])
    curves = curves_of(JOB, history, None)
    assert [c.mean_error_cN for c in curves] == [1.0, 1.55, 1.0, 1.0]
    assert [c.max_error_cN for c in curves] == pytest.approx([6.0, 9.3, 6.0, 6.0])
    assert ["the best table is kept" in c.explanation for c in curves] == [True, False, False, False]


def test_what_was_learned_since_the_last_press_is_kept_if_that_was_no_worse_than_chance() -> None:
    history = (presses([2.0, 2.0 * WORSE_ratio]), presses([1.0]))
    for kept in best_rows((table(9.0), table(9.0)), history):
        np.testing.assert_array_equal(kept.rows_cN, 9.0)


def test_curves_come_press_first_with_the_error_of_every_press() -> None:
    history = (presses([6.0, 2.0]), presses([5.0, 3.0, 1.0]))
    curves = curves_of(JOB, history, None)
    assert [(str(c.stroke), c.velocity_mm_s) for c in curves] == [
        ("press", 50.0),
        ("press", 100.0),
        ("release", 50.0),
        ("release", 100.0),
    ]
    assert [c.error_cN for c in curves] == [(6.0, 2.0), (5.0, 3.0, 1.0), (2.0, 2.0), (2.0, 2.0, 2.0)]
    assert curves[1].explanation == "error_k 5.0 cN at press 1, 1.0 at press 3"


def test_what_was_not_pressed_is_expected_from_a_memory_or_unknown() -> None:
    residual = ForceSurface(TARGET.displacement_mm, SPEEDS_mm_s, *np.zeros((2, 2, COUNT)))
    memory = LearnedRig(RigModel(), residual, 4.0, np.array([[1.0, 2.0], [3.0, 4.0]]))
    expected = curves_of(JOB, ((), presses([6.0])), memory)
    assert [c.mean_error_cN for c in expected] == [1.0, 3.0, 3.0, 1.0]
    assert "1.0 cN expected" in expected[0].explanation
    assert np.isnan(expected[0].max_error_cN)
    unknown = curves_of(JOB, ((), ()), None)
    assert {c.explanation for c in unknown} == {"not pressed"}
    assert all(np.isnan(c.mean_error_cN) for c in unknown)


def test_an_unknown_rig_starts_where_the_papers_law_does() -> None:
    law = PerCurve(PaperLaw())
    paper = law.done(law.init(JOB)).surface
    np.testing.assert_array_equal(minimum_lift_surface(JOB).press_cN, paper.press_cN)
    np.testing.assert_array_equal(minimum_lift_surface(JOB).release_cN, paper.release_cN)
    assert minimum_lift_surface(CompensationJob(TARGET, 4.0, 60.0)).press_cN.max() == 60.0
