"""What does identification find on rigs of other physics than the twin's? Simulated; some minutes.

Run as ``python -m benchmarks.other_rigs``, or with the number of rigs of each kind and the first seed. Rigs
and fingers are those of tests/support/other_rigs.py, with a solver of their own: springs, cables, detents,
LuGre friction, a force constant that is no parabola, a cap that rocks. Each kind alone, all together, and
none; MX Clear and MX Red in turn; one press each at 50, 100, 150 and 200 mm/s. The seeds were not used for
development. A cell holds the median of the size, and in brackets the error in standard errors, rms.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import numpy as np

from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray
from tests.support.other_rigs import KINDS, OtherRig, draw_other_rig, presses_of

RIGS, FIRST_SEED = 40, 9000
SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
BUTTONS = ("mx-clear", "mx-red")
TRAVEL_mm = 4.0
GROUPS: dict[str, Sequence[str]] = {"none": (), **{kind: (kind,) for kind in KINDS}, "all": KINDS}
NUMBERS = ("gain", "delay_s", "position_lag_s", "drag_N_s_m", "friction_cN", "weight_cN", "mass_g", "play_cN")


def truth(rig: OtherRig) -> FloatArray:
    """Return the true NUMBERS: gain and drag at mid travel, the weight with the own force's mean."""
    middle, drag = rig.gain_at(np.array(2e-3)), rig.viscous_N_s_m + rig.brake_N_s_m
    weight_cN = -rig.own_cN(np.linspace(0.0, TRAVEL_mm, 401)).mean()
    cN = (100 * rig.friction_N, weight_cN, 1e3 * rig.mass_kg, 100 * rig.play_N)
    return np.array([middle, rig.delay_s, rig.position_s, drag, *cN], dtype=np.float64)


def found(known: RigModel) -> FloatArray:
    rest = [float(getattr(known, name)) for name in NUMBERS[1:]]
    return np.array([float(known.gain_at(np.array(2.0))), *rest])


def judged(
    kinds: Sequence[str], count: int, first: int
) -> Iterator[tuple[FloatArray, FloatArray, float, str]]:
    """Identify rigs; yield errors of NUMBERS, also in standard errors, rms of the own force, misfit."""
    rigs = [draw_other_rig(np.random.default_rng((first, at)), kinds) for at in range(count)]
    targets = [ForceSurface.of_model(load_builtin(name), SPEEDS_mm_s, 0.05) for name in BUTTONS]
    surfaces = [identification_surface(targets[at % 2]) for at in range(count)]
    records = zip(*(presses_of(rigs, surfaces, v, first) for v in SPEEDS_mm_s), strict=True)
    x = np.linspace(0.2, TRAVEL_mm - 0.2, 200)
    for rig, presses in zip(rigs, records, strict=True):
        known, true = identify(presses, TRAVEL_mm), truth(rig)
        missed = found(known) - true
        error = np.array([known.error[name] for name in NUMBERS])
        own = known.own_at(x) - rig.own_cN(x)
        scale = np.array([100 / true[0], 1e3, 1e3, 1, 1, 1, 100 / true[6], 1])
        yield scale * missed, missed / error, float(np.sqrt(np.mean(own**2))), known.misfit


def main() -> None:
    count, first = (int(a) for a in sys.argv[1:3]) if len(sys.argv) > 2 else (RIGS, FIRST_SEED)
    head = "gain, % | delay, ms | position lag, ms | drag, N s/m | friction, cN | weight, cN"
    head += " | mass, % | play, cN"
    print(f"| {count} rigs of each kind, simulated | {head} | own force, cN | misfit reported |")
    print("|" + "---|" * 11)
    for name, kinds in GROUPS.items():
        missed, ratios, own, said = (
            list(column) for column in zip(*judged(kinds, count, first), strict=True)
        )
        size, rms = np.median(np.abs(missed), axis=0), np.sqrt(np.mean(np.square(ratios), axis=0))
        cells = " | ".join(f"{a:.2f} ({z:.1f})" for a, z in zip(size, rms, strict=True))
        print(f"| {name} | {cells} | {np.median(own):.2f} | {sum(map(bool, said))} |", flush=True)


if __name__ == "__main__":
    main()
