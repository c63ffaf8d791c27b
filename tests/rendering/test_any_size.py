"""A weak and a strong rig render as well as the default one; the figures are those of benchmarks.any_size."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.any_size import SIZES, judged, known_of, sized_rig

from fdvv.twin.rig import Rig

WORSE_ratio = 1.5


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_weak_and_a_strong_rig_render_as_well_as_the_default_one() -> None:
    seeds = (700, 701)
    usual = float(np.median([judged(Rig(), seed) for seed in seeds]))
    for size, tick_us in ((SIZES[0], 1000), (SIZES[3], 50)):
        rig = sized_rig(size, tick_us)
        found = float(np.median([judged(rig, seed, known_of(rig)) for seed in seeds]))
        assert found <= WORSE_ratio * usual, f"{size.full_N:g} N"
