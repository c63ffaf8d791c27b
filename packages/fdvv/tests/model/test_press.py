from typing import Any

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.press import Press


def press(**fields: Any) -> Press:
    whole: dict[str, Any] = {
        "t_s": np.array([0.0, 0.001, 0.002]),
        "displacement_mm": np.array([0.0, 0.1, 0.2]),
        "force_cN": np.array([0.0, 5.0, 6.0]),
        "velocity_mm_s": 100.0,
    }
    return Press(**{**whole, **fields})


@pytest.mark.parametrize(
    "column", ["displacement_mm", "force_cN", "sensed_mm", "sensed_cN", "commanded_cN", "saturated"]
)
def test_every_column_runs_on_the_same_clock(column: str) -> None:
    with pytest.raises(ModelError, match=rf"{column} must match t_s, got \(2,\) and \(3,\)"):
        press(**{column: np.zeros(2)})


@pytest.mark.parametrize("t_s", [[0.0, 0.0, 0.1], [0.2, 0.1, 0.0]])
def test_time_rises_strictly(t_s: list[float]) -> None:
    with pytest.raises(ModelError, match="strictly rising"):
        press(t_s=np.array(t_s))


def test_a_single_instant_is_no_press() -> None:
    one = np.zeros(1)
    with pytest.raises(ModelError, match="at least 2"):
        Press(one, one, one, 100.0)
