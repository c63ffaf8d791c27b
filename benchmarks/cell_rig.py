"""How far is the compiled rig with a load cell from a solver written from its page, twin.md? Simulated.

Run as ``python -m benchmarks.cell_rig [seeds]``. Replayed: both plants get the same drive, tick by tick.
Closed: each closes its own force loop from its own readings, so a converter step that falls the other way
leads them apart.
"""

from __future__ import annotations

import sys

import numpy as np

from tests.support.reference.cell_press import (
    Departure,
    compiled_press,
    departure,
    gesture_at,
    reference_press,
)

SPEEDS_mm_s = (50.0, 100.0, 200.0)


def departures(velocity_mm_s: float, seed: int) -> tuple[Departure, Departure]:
    """Return the departure with the compiled twin's drive replayed, and with the loop closed."""
    gesture = gesture_at(velocity_mm_s)
    compiled = compiled_press(gesture, velocity_mm_s, seed)
    replayed = reference_press(gesture, velocity_mm_s, seed, compiled.drive)
    closed = reference_press(gesture, velocity_mm_s, seed)
    return departure(compiled, replayed), departure(compiled, closed)


def main(seeds: int = 5) -> None:
    """Print a table; 20 s a seed."""
    print(
        "| mm/s | drive | between stops, cN rms (most) | impact, cN rms (most) | um rms | readings differ |"
    )
    print("|---|---|---|---|---|---|")
    for velocity in SPEEDS_mm_s:
        pairs = [departures(velocity, seed) for seed in range(seeds)]
        for name, found in zip(("replayed", "closed"), zip(*pairs, strict=True), strict=True):
            print(_row(f"{velocity:g} | {name}", list(found)))


def _row(name: str, found: list[Departure]) -> str:
    def worst(field: str) -> float:
        return float(max(vars(one)[field] for one in found))

    def middle(field: str) -> float:
        return float(np.median([vars(one)[field] for one in found]))

    cells = [
        f"{middle(f'{w}_cN'):.4f}, worst {worst(f'{w}_cN'):.4f} ({worst(f'{w}_most_cN'):.3f})"
        for w in ("between", "impact")
    ]
    readings = f"{100 * middle('counts_ratio'):.1f} %, by {worst('most_counts'):.0f} at most"
    return f"| {name} | {' | '.join(cells)} | {worst('displacement_um'):.4f} | {readings} |"


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
