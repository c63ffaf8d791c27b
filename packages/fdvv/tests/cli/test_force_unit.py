"""Forces on the command line in cN, gf or N; JSON stays in cN."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.force_text import force_of
from tests.support.command_line import Run

GF = 0.980665


def value(text: str, row: str) -> float:
    return float(next(line for line in text.splitlines() if line.startswith(row)).split()[-1])


@pytest.mark.parametrize(("unit", "one_cN"), [("gf", 1 / GF), ("N", 0.01)])
def test_every_force_of_a_table_is_converted_and_nothing_else(fdvv: Run, unit: str, one_cN: float) -> None:
    plain = fdvv("show", "mx-clear").out
    other = fdvv("--force-unit", unit, "show", "mx-clear").out
    assert "cN" not in other
    for name in ("peak", "bottom_out"):
        assert value(other, f"{name}_{unit}") == pytest.approx(one_cN * value(plain, f"{name}_cN"), abs=6e-4)
    assert value(other, f"pre_slope_{unit}_mm") == pytest.approx(
        one_cN * value(plain, "pre_slope_cN_mm"), abs=6e-4
    )
    for name in ("travel_mm", "snap_ratio", "work_mJ"):
        assert value(other, name) == value(plain, name)


def test_the_variable_is_the_setting_and_json_stays_in_cN(fdvv: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    as_json = fdvv("show", "mx-clear", "--json").out
    monkeypatch.setenv("FDVV_FORCE_UNIT", "gf")
    assert "peak_gf" in fdvv("show", "mx-clear").out
    assert fdvv("show", "mx-clear", "--json").out == as_json
    assert "rms gf" in fdvv("compare", "mx-clear", "mx-red").out
    assert "peak_cN" in fdvv("--force-unit", "cN", "show", "mx-clear").out


@pytest.mark.parametrize(("text", "force_cN"), [("5", 5.0), ("5cN", 5.0), ("5 gf", 5 * GF), ("0.05N", 5.0)])
def test_a_force_is_asked_in_any_unit(text: str, force_cN: float) -> None:
    assert force_of(text) == pytest.approx(force_cN)


def test_a_bound_may_carry_its_unit(fdvv: Run, switch: Path) -> None:
    rmse_cN = max(one["rmse_cN"] for one in fdvv("fit", switch, "--json").json["curves"])
    assert fdvv("fit", switch, "--max-rmse-cN", f"{1.01 * rmse_cN / GF}gf").status == 0
    assert fdvv("fit", switch, "--max-rmse-cN", f"{0.99 * rmse_cN / 100}N").status == 1
    assert "is no force" in fdvv("fit", switch, "--max-rmse-cN", "5kg").err
