"""Timing and forces of tapping people: fitted on some, judged on others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.people_calibration import (
    BAATH,
    Taps,
    fit_timing,
    force_spread_ratio,
    pooled_log_likelihood,
    read_taps,
    spread_error_ratio,
    tap_peaks,
    timing_log_likelihood,
)

from fdvv.errors import FitError, InputError

PERIODS_ms = (600.0, 1200.0, 2400.0)


def drawn(people: int, seed: int, clock: float = 0.06, carried: float = 0.4, count: int = 200) -> Taps:
    """Draw people whose clocks differ by 20 % and whose errors live on by a share."""
    random = np.random.default_rng(seed)
    rows = []
    for person in range(people):
        ratio, bias = clock * np.exp(0.2 * random.standard_normal()), 15 * random.standard_normal()
        for period in PERIODS_ms:
            late = 0.0
            for _ in range(count):
                fresh = random.standard_normal() * np.sqrt(1 - carried**2)
                late = carried * late + ratio * period * fresh
                rows.append((person, 1, period, late + bias - 0.03 * period))
    return Taps(*np.array(rows, dtype=float).T)


def test_a_fit_finds_what_taps_were_drawn_with() -> None:
    fit = fit_timing(drawn(24, 0))
    assert fit.clock_ratio == pytest.approx(0.06, rel=0.12)
    assert fit.clock_spread == pytest.approx(0.2, abs=0.08)
    assert fit.bias_ratio == pytest.approx(-0.03, abs=0.006)
    assert fit.gain == pytest.approx(0.6, abs=0.06)


def test_a_clock_that_scales_tells_unknown_people_better_than_one_normal_for_all() -> None:
    known, unknown = drawn(12, 1), drawn(12, 2)
    fit = fit_timing(known)
    assert timing_log_likelihood(fit, unknown) > pooled_log_likelihood(known, unknown) + 0.1
    guess = fit.clock_ratio * np.array(PERIODS_ms)
    assert spread_error_ratio(guess, unknown) < 0.35
    assert spread_error_ratio(np.full(3, known.late_ms.std()), unknown) > 0.5


def test_too_few_taps_are_refused() -> None:
    with pytest.raises(FitError, match="two people"):
        fit_timing(drawn(3, 0, count=5))


def test_a_table_of_taps_is_read_and_taps_of_no_beat_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "taps.csv"
    path.write_text("subject,trial,isi,asynch\n1,1,600,-30\n1,1,600,400\n2,1,600,10\n")
    taps = read_taps(path)
    assert taps.late_ms.tolist() == [-30.0, 10.0]
    path.write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="line 1"):
        read_taps(path)
    path.write_text("subject,trial,isi,asynch\n1,1,600\n")
    with pytest.raises(InputError, match="four numbers"):
        read_taps(path)


@pytest.mark.shared
def test_the_shipped_timing_is_that_of_baath_and_madisons_people(shared_data: Path) -> None:
    fit = fit_timing(_real(shared_data))
    for name, shipped in vars(BAATH).items():
        assert getattr(fit, name) == pytest.approx(shipped, rel=0.002), name


@pytest.mark.shared
@pytest.mark.parametrize("fold", range(3))
def test_ten_real_people_tell_five_others_better_than_a_single_normal(shared_data: Path, fold: int) -> None:
    taps = _real(shared_data)
    held_out = taps.people[fold::3]
    known = taps.of([one for one in taps.people if one not in held_out])
    unknown, fit = taps.of(held_out), fit_timing(known)
    assert timing_log_likelihood(fit, unknown) > pooled_log_likelihood(known, unknown)
    guess = fit.clock_ratio * np.array(taps.periods_ms)
    pooled = np.full(len(taps.periods_ms), known.late_ms.std())
    assert spread_error_ratio(guess, unknown) < spread_error_ratio(pooled, unknown)


def _real(shared_data: Path) -> Taps:
    return read_taps(next((shared_data / "baath-sync-tapping").glob("*.csv")))


@pytest.mark.shared
def test_one_persons_spread_of_force_tells_the_others_better_than_the_assumed_one(shared_data: Path) -> None:
    """Fitted on SS02, judged on SS05; the assumed 15 % of push_spread_ratio is the simple guess."""
    folder = shared_data / "forcepeaks-tapping"
    known, other = (force_spread_ratio(sorted(folder.glob(f"{who}*raw.dat"))) for who in ("SS02", "SS05"))
    assert abs(known - other) < abs(0.15 - other)
    assert 0.04 < known < 0.12


@pytest.mark.shared
def test_a_log_without_forces_has_no_peaks(shared_data: Path) -> None:
    path = next((shared_data / "forcepeaks-tapping").glob("SS02*10.35.50*trial1-raw.dat"))
    assert tap_peaks(path).size == 0
    with pytest.raises(FitError, match="no trial"):
        force_spread_ratio([path])
