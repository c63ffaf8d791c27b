"""Does a rig of any size render a button as well as the default one? Simulated; hours for all seeds.

    python -m benchmarks.any_size                 # seeds 500 to 519: a rig and a person each
    python -m benchmarks.any_size 3               # the first three
    python -m benchmarks.any_size 2 700           # two from 700 on, which were used for development

Rigs of 0.5, 2, 10 and 50 N at full duty, at ticks of 4000, 1000, 250 and 50 us, beside the twin's default rig
(15 N, 1000 us) in the same run. The rig files of SIZES say what a builder would choose: supply, coil, mover,
force limit; every uncertain number is then multiplied by its draw for the default rig over its default,
while the force at full duty stays. The default rig is drawn in the same way.

All are identified and learned by the method rig-aware (four presses at 50, 100, 150 and 200 mm/s, three more
each) and judged on fresh presses in true displacement. Of the sized rigs a builder knows mass and weight to
a quarter and dry friction to a half, as the file says (--prior). The heavy mover of 50 N is judged with a
load cell and a current drive too, where the force loop holds the force; a loop of 250 Hz to 100 mm/s too,
over the default rig's error there.

The button is MX Clear, its forces multiplied so that its largest is at most 60 % of the rig's force limit:
0.27 N of a rig of 0.5 N, as it is on the others. An error is the mean of |rendered - intended| over the
curve, in per cent of the button's force range; a cell is the median over curves and seeds, and its ratio to
the default rig's.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.compensation.identification.rig_model import Plausible, Prior
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.errors import FdvvError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.twin.draw import draw_around, draw_finger
from fdvv.twin.rig import Rig

SEEDS, FIRST_SEED = 20, 500
SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
SLOW_mm_s, SLOW = SPEEDS_mm_s[:2], ", to 100 mm/s"
PROBES = 4
TICKS_us = (4000, 1000, 250, 50)
BUTTON, FULL_ratio = "mx-clear", 0.6


@dataclass(frozen=True)
class Size:
    """What a builder chooses for a rig of this force; friction and drag of a bushing of its size."""

    full_N: float
    supply_V: float
    force_constant_N_A: float
    mass_kg: float
    coulomb_N: float
    viscous_N_s_m: float
    limit_N: float


SIZES = (
    Size(0.5, 3.0, 1.0, 0.004, 0.005, 0.04, 0.45),
    Size(2.0, 5.0, 1.5, 0.008, 0.010, 0.10, 1.8),
    Size(10.0, 12.0, 3.0, 0.016, 0.025, 0.25, 4.4),
    Size(50.0, 48.0, 8.0, 0.060, 0.080, 0.60, 5.0),
)


def sized_rig(size: Size, tick_us: int) -> Rig:
    """Return the rig file of a size, at a tick."""
    rig, tick_s = Rig(), tick_us / 1e6
    ohm = size.force_constant_N_A * size.supply_V / size.full_N
    coil = replace(
        rig.coil,
        supply_V=size.supply_V,
        force_constant_N_A=size.force_constant_N_A,
        resistance_ohm=ohm,
        bridge_ohm=0.07 * ohm,
        source_ohm=0.03 * ohm,
        inductance_H=5e-4 * ohm,
        reluctance_H_m=0.016 * ohm,
    )
    parts: dict[str, Any] = {n: getattr(size, n) for n in ("mass_kg", "coulomb_N", "viscous_N_s_m")}
    reads = min(25, max(1, tick_us // 10))
    control = replace(
        rig.controller,
        tick_s=tick_s,
        compute_s=max(1e-5, min(3e-4, 1e-5 * round(0.3 * tick_us / 10))),
        force_limit_N=size.limit_N,
        slew_N=5.0,
        velocity_scale=1.2,
    )
    return replace(
        rig,
        coil=coil,
        mover=replace(rig.mover, **parts),
        controller=control,
        exciter=replace(rig.exciter, fitted="no"),
        position_sensor=replace(rig.position_sensor, reads=reads, burst_s=min(2.5e-4, 0.6 * tick_s)),
    )


def with_cell(rig: Rig) -> Rig:
    """Return a rig with the load cell and the kind of drive of the recommended one."""
    coil = replace(rig.coil, drive="current", current_loop_s=5e-5)
    return replace(rig, coil=coil, load_cell=replace(rig.load_cell, fitted="yes"))


def scaled_button(limit_N: float) -> FDVVModel:
    """Return the button, weaker where its largest force is beyond FULL_ratio of the rig's limit."""
    model = load_builtin(BUTTON)
    grid = np.linspace(0.0, model.travel_mm, 200)
    largest_cN = max(
        float(np.abs(model.force_cN(grid, v, stroke)).max()) for v in SPEEDS_mm_s for stroke in Stroke
    )
    size = min(1.0, 100 * FULL_ratio * limit_N / largest_cN)
    curves = tuple(replace(c, control_points_cN=size * c.control_points_cN) for c in model.curves)
    return replace(model, curves=curves, vibrations=())


def known_of(rig: Rig) -> Prior:
    """Return what a builder knows of a rig from its file."""
    mover = rig.mover
    mass_g, friction_cN = 1e3 * mover.mass_kg, 100 * mover.coulomb_N
    weight_cN = 100 * mover.mass_kg * mover.gravity_m_s2
    return Prior(
        ranges={
            "mass_g": Plausible(mass_g, 0.25 * mass_g, 0.1),
            "weight_cN": Plausible(weight_cN, 0.25 * weight_cN),
            "friction_cN": Plausible(friction_cN, 0.5 * friction_cN, 0.0),
        }
    )


def judged(
    rig: Rig, seed: int, known: Prior | None = None, speeds_mm_s: Sequence[float] = SPEEDS_mm_s
) -> list[float]:
    """Return the error of every curve in per cent of the button's force range."""
    random = np.random.default_rng((seed, 41))
    built, finger = draw_around(rig, random), draw_finger(random)
    model = scaled_button(rig.controller.force_limit_N)
    learned = compensate(TwinDevice(built, finger, seed), model, speeds_mm_s, RigAware(prior=known))
    fresh = TwinDevice(built, finger, seed + 1_000_000)
    about: dict[str, Any] = {"method": learned.method, "tuning": learned.outcome.tuning}
    found = probe(fresh, model, learned.surface, speeds_mm_s, PROBES, **about)
    return [100 * float(np.median(c.mean_errors_cN)) / np.ptp(c.target_cN) for c in found.curves]


def main() -> None:
    count, first = (int(a) for a in (*sys.argv[1:3], *(str(SEEDS), str(FIRST_SEED))[len(sys.argv) - 1 :])[:2])
    rigs = {"default": Rig()} | {
        f"{size.full_N:g} N, {tick} us": sized_rig(size, tick) for size in SIZES for tick in TICKS_us
    }
    rigs |= {name + SLOW: rig for name, rig in rigs.items() if name == "default" or " 4000 us" in name}
    rigs |= {f"{name}, load cell": with_cell(rigs[name]) for name in ("50 N, 1000 us", "50 N, 250 us")}
    print(f"| {count} rigs and people each from seed {first}, simulated | error, % | ratio | failed |")
    print("|---|---|---|---|")
    usual: dict[bool, float] = {}
    for name, rig in rigs.items():
        errors, failed, why, begun_s = [], 0, "", time.monotonic()
        for seed in range(first, first + count):
            try:
                known = None if name == "default" else known_of(rig)
                errors += judged(rig, seed, known, SLOW_mm_s if SLOW in name else SPEEDS_mm_s)
            except FdvvError as error:
                failed, why = failed + 1, str(error)
        found = float(np.median(errors)) if errors else float("nan")
        ratio = found / usual.setdefault(SLOW in name, found)
        print(
            f"| {name} | {found:.2f} | {ratio:.2f} | {failed}{': ' * bool(why)}{why[:150]} |"
            f" <!-- {time.monotonic() - begun_s:.0f} s -->",
            flush=True,
        )


if __name__ == "__main__":
    main()
