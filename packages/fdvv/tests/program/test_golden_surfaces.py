"""The page's surfaces are those of this package: both are held against one file of numbers."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

from fdvv.program.surface import Surface, flat, line, raised

GOLDEN = Path(__file__).resolve().parents[4] / "web" / "tests" / "programs" / "golden_surfaces.json"
BASE = Surface(
    "base",
    (0.0, 0.5, 1.1, 1.4, 2.0, 3.2),
    ((20.0, 31.25, 60.125, 44.0, 52.5, 90.0), (22.0, 35.25, 71.125, 50.0, 60.5, 99.9)),
    (10.0, 200.0),
)
POINTS = [(0.4, 0.0), (1.0, 12.5), (1.5, -3.0)]


def test_the_numbers_that_the_page_is_held_against_are_of_this_package() -> None:
    made = {
        "base": BASE,
        "raised": raised(BASE, "raised", POINTS),
        "line": line("line", *POINTS),
        "flat": flat("flat", -20.0),
    }
    wanted: dict[str, Any] = {name: dataclasses.asdict(surface) for name, surface in made.items()}
    places = [(i * 0.37 - 0.4, v) for i in range(12) for v in (0.0, 10.0, 77.0, 200.0, 400.0)]
    wanted["places"] = [(x, v, BASE.force_at_cN(x, v)) for x, v in places]
    wanted["points"] = POINTS
    assert json.loads(GOLDEN.read_text()) == json.loads(json.dumps(wanted))
