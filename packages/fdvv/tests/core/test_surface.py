"""The lookup against the bilinear one in floating point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.protocol.tables import Settings
from tests.support.core.programs import FINE, REST, armed, image
from tests.support.inputs import inputs_at

WIDE = replace(FINE, announced_mm_s16=8)


@pytest.mark.parametrize("seed", range(8))
def test_the_force_is_bilinear_and_held_at_the_edges(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, columns = int(rng.integers(1, 17)), int(rng.integers(2, 100))
    step, start = int(rng.integers(16, 44800 // columns)), int(rng.integers(-19000, 10000))
    speeds = np.sort(rng.choice(16000, rows, replace=False))
    forces = rng.integers(-12000, 12000, (rows, columns))
    core = armed(image(tables=[(start, step, speeds.tolist(), forces.tolist())]), WIDE)
    for announced in [*rng.integers(8, 16001, 20).tolist(), *np.maximum(speeds, 8).tolist()]:
        core.announce(announced)
        x_mm = rng.uniform(-1.2, 2.7, 20)
        outputs = core.run(inputs_at(WIDE, np.repeat(x_mm, 3)))[2::3]
        places = (outputs["displacement_um16"] - start) / step
        along = [np.interp(places, np.arange(columns), row) for row in forces]
        wanted = [np.interp(announced, speeds, column) for column in np.transpose(along)]
        # parts are cut to 2^-15 and wrong by 5e-5, twice, of at most 24000; each blend rounds by a half
        assert outputs["commanded_cN64"] == pytest.approx(np.array(wanted), abs=24000 * 1.7e-4 + 1.5)


@pytest.mark.parametrize("step", [16, 17, 31, 32, 33, 100, 127, 128, 129, 200, 255])
def test_every_sixteenth_of_a_micrometre_finds_its_column(step: int) -> None:
    columns = 255
    nodes = np.arange(columns) * step
    ramp = np.minimum(nodes, 28000)
    core = armed(image(tables=[(0, step, [1600], [ramp.tolist()])]), WIDE)
    x = np.arange(0, min(nodes[-1], 44000))
    found = core.run(inputs_at(WIDE, x / 16000))["commanded_cN64"]
    assert np.abs(found[3:] - np.interp(x[3:], nodes, ramp)).max() <= 0.55


def test_strokes_have_their_own_surfaces() -> None:
    tables = [(0, 16000, [1600], [[f, f]]) for f in (1000, 2000)]
    program = image(states=[(replace(REST, release_surface=1), ())], tables=tables)
    path = np.concatenate([np.arange(0, 2, 0.02), np.arange(2, 0.2, -0.02)])
    outputs = armed(program, Settings()).run(inputs_at(Settings(), path))
    release = (outputs["flags"] & 1) > 0
    assert set(outputs["commanded_cN64"][release]) == {2000}
    assert set(outputs["commanded_cN64"][~release][1:]) == {1000}
