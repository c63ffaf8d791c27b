"""What does each part of the recommended rig bring? One at a time is taken away, or made worse. Simulated.

Run as ``python -m benchmarks.rig_parts [rigs per button]``; 40 s a design with three rigs. Rigs, people,
learning and judging are those of benchmarks.force_loop; medians over rigs and buttons, press / release.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from benchmarks.drawn_rigs import BUTTONS, FIRST_SEED, Case, Options, SPEEDS_mm_s, run_all
from benchmarks.force_loop import DESIGNS, RECOMMENDED, judged, parts
from fdvv.units import FloatArray

WHOLE = DESIGNS[RECOMMENDED]
LOOP_4_kHz = DESIGNS["4 kHz, current drive, cell, 12 g"][0]


@dataclass(frozen=True)
class Variant:
    """A change of the recommended rig: other options, another cell, or none."""

    name: str
    options: tuple[Options, ...] = ()
    cell: dict[str, Any] = field(default_factory=dict)
    law: str = "loop"

    def __call__(self, case: Case) -> FloatArray:
        rig, finger = parts(case, self.law == "loop")
        if self.cell:
            rig = replace(rig, load_cell=replace(rig.load_cell, **self.cell))
        return judged(case, rig, finger, self.law)


VARIANTS = (
    Variant("all of it"),
    Variant("without the cell", law="rig-aware"),
    Variant("voltage drive", ({"coil": {"drive": "voltage"}},)),
    Variant("4 kHz", (LOOP_4_kHz, {"controller": {"reversal_m": 1e-4}})),
    Variant("20 g", ({"mover": {"mass_kg": 0.02}},)),
    Variant("cell of 1e6 N/m", cell={"stiffness_N_m": 1e6}),
    Variant("cell of 3e5 N/m", cell={"stiffness_N_m": 3e5}),
    Variant("cell of 2e5 N/m", cell={"stiffness_N_m": 2e5}),
    Variant("cell of 2e5 N/m, plate of 0.7 g", cell={"stiffness_N_m": 2e5, "plate_kg": 7e-4}),
    Variant("cell with 2 kHz", cell={"bandwidth_Hz": 2000.0}),
    Variant("cell that reads 3 % too much", cell={"gain_error_ratio": 0.03}),
    Variant("cell that reads 5 cN too much", cell={"offset_N": 0.05}),
)


def main(rigs: int = 3) -> None:
    """Print a table."""
    cases = [Case(FIRST_SEED + i, button, WHOLE) for button in BUTTONS for i in range(rigs)]
    print(f"cN over {len(BUTTONS)} buttons on {rigs} rigs and people each; simulated")
    print("| design | " + " | ".join(f"{v:g} mm/s" for v in SPEEDS_mm_s) + " | finished |")
    for variant in VARIANTS:
        own = [replace(case, options=(*WHOLE, *variant.options)) for case in cases]
        found = [rows for _, rows in run_all(variant, own) if not isinstance(rows, str)]
        means = np.median(np.array(found)[:, :, 0], 0) if found else np.full(2 * len(SPEEDS_mm_s), np.nan)
        press, release = np.split(means, 2)
        cells = " | ".join(f"{p:.2f} / {r:.2f}" for p, r in zip(press, release, strict=True))
        print(f"| {variant.name} | {cells} | {len(found)} of {len(cases)} |", flush=True)


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
