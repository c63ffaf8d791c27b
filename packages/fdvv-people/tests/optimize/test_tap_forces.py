"""Forces of taps in ForcePeaks logs."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.people_calibration import force_spread_ratio, tap_peaks

from fdvv.errors import FitError


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
