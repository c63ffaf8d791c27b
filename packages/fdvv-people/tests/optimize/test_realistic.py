"""Bounds of variations as real buttons are: computed again from every measurement there is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.model.file import builtin_names, load_builtin
from fdvv_people.optimize.model_space import model_parameters, neutral_design
from fdvv_people.optimize.realistic import REAL, realistic_bounds, realistic_space
from fdvv_studio.library.figures import UNREADABLE, row_of_file, row_of_model
from fdvv_studio.library.row import ButtonRow, Origin


def figure(row: ButtonRow, name: str) -> float | None:
    if name != "snap_mm":
        value = getattr(row, name)
        return None if value is None else float(value)
    return None if row.valley_mm is None or row.peak_mm is None else row.valley_mm - row.peak_mm


@pytest.mark.shared
@pytest.mark.slow
def test_the_bounds_hold_the_middle_of_all_buttons_there_are(shared_data: Path) -> None:
    rows = [row_of_model(load_builtin(name), name, Origin.BUILTIN) for name in builtin_names()]
    for path in sorted(shared_data.rglob("*")):
        if path.suffix.lower() in (".csv", ".json"):
            try:
                rows.append(row_of_file(path, path.stem, path.parent.name))
            except UNREADABLE:
                continue
    for name, (low, high) in REAL.items():
        values = [value for row in rows if (value := figure(row, name)) is not None]
        step = 0.05 if name.endswith("_mm") and "cN" not in name else 1.0
        found = np.quantile(values, [0.025, 0.975])
        expected = step * np.floor(found[0] / step), step * np.ceil(found[1] / step)
        assert (low, high) == pytest.approx(expected), name


@pytest.mark.parametrize("name", builtin_names())
def test_every_shipped_button_lies_between_its_own_bounds_unchanged(name: str) -> None:
    base = load_builtin(name)
    space = realistic_space(base)
    neutral = neutral_design(space, base)
    assert space.broken(neutral) == ()
    assert neutral["force_ratio"] == 1.0
    assert neutral["actuation_mm"] == base.actuation_mm


def test_the_bounds_are_narrower_than_those_of_the_space_and_keep_forces_real() -> None:
    base = load_builtin("mx-red")
    bounds = realistic_bounds(base)
    own = {one.name: (one.low, one.high) for one in model_parameters(base)}
    for name, (low, high) in bounds.items():
        assert own[name][0] <= low < high <= own[name][1]
    low, high = bounds["force_ratio"]
    actuation_cN = float(base.force_cN(base.actuation_mm, 0.0, "press"))  # type: ignore[arg-type]
    assert low * actuation_cN == pytest.approx(34.0, abs=0.5)
    assert high * actuation_cN == pytest.approx(63.0, abs=0.5)
    heavy = {**neutral_design(realistic_space(base), base), "force_ratio": high, "bump_cN": 38.0}
    assert [one.name for one in realistic_space(base).broken(heavy)] == ["force"]
