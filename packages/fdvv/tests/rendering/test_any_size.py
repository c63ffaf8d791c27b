"""A weak and a strong rig render as well as the default one; the figures are those of benchmarks.any_size."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.any_size import SIZES, judged, known_of, sized_rig, with_cell

from fdvv.twin.rig import Rig

WORSE_ratio = 1.5


@pytest.mark.slow
def test_a_weak_and_a_strong_rig_render_as_well_as_the_default_one() -> None:
    seeds = (700, 701)
    usual = float(np.median([judged(Rig(), seed) for seed in seeds]))
    # a heavy mover needs a load cell: docs/explanation/rig-aware.md
    rigs = {"0.5 N": sized_rig(SIZES[0], 1000), "50 N": with_cell(sized_rig(SIZES[3], 250))}
    for name, rig in rigs.items():
        found = float(np.median([judged(rig, seed, known_of(rig)) for seed in seeds]))
        assert found <= WORSE_ratio * usual, name
