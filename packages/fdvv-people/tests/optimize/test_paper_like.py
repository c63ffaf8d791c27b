"""What one may start from in the paper's space."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.curve import Stroke
from fdvv.model.file import builtin_names, load_builtin
from fdvv_people.optimize.paper_space import paper_design_like, paper_model, paper_space


@pytest.mark.parametrize("name", builtin_names())
def test_every_built_in_button_has_a_design_near_it_that_the_space_holds(name: str) -> None:
    space, model = paper_space(), load_builtin(name)
    design = paper_design_like(model)
    assert space.checked(design) == design
    assert not space.broken(design)
    assert design["actuation_mm"] == pytest.approx(model.actuation_mm, abs=0.3)
    x = np.linspace(0.3, model.travel_mm - 0.3, 50)
    near = paper_model(design).force_cN(x, 50.0, Stroke.PRESS)
    wanted = model.force_cN(x, 50.0, Stroke.PRESS)
    middle = paper_model({one.name: (one.low + one.high) / 2 for one in space.parameters})
    far = middle.force_cN(x, 50.0, Stroke.PRESS)
    assert np.mean(np.abs(near - wanted)) < 0.5 * np.mean(np.abs(far - wanted))
