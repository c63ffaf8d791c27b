"""What else a known rig gives: buttons without a press, statics, FD against FDVV. Simulated; minutes.

Run as ``python -m benchmarks.rendering_reuse [rigs]``. Rigs and people as in benchmarks.rendering, on the
paper's parts with a 4 kHz loop, and with current drive and a mover of 12 g. Held-out presses, true
displacement; median (5-95 %) over rigs of the mean error in cN.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.drawn_rigs import (
    CURRENT,
    FIRST_SEED,
    JUDGE,
    Case,
    LIGHT_12_g,
    LOOP_4_kHz,
    Options,
    SPEEDS_mm_s,
    run_all,
    spread,
)
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.model.model import FDVVModel
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.probe import fd_only, probe
from fdvv.twin.finger import Finger, stage_finger
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray

RIGS = 20
PARTS: dict[str, tuple[Options, ...]] = {
    "paper's parts": (LOOP_4_kHz,),
    "current drive and 12 g": (LOOP_4_kHz, CURRENT, LIGHT_12_g),
}
EDIT_RATIO = 1.15
STATIC_mm_s = 0.5


def stiffer(model: FDVVModel) -> FDVVModel:
    """Edit a button as a designer does who wants more force: every control point up by 15 %."""
    curves = [replace(c, control_points_cN=EDIT_RATIO * c.control_points_cN) for c in model.curves]
    return replace(model, name=f"{model.name}, 15 % stiffer", curves=tuple(curves))


def learn(case: Case, model: FDVVModel) -> CompensationResult:
    """Learn a button on an unknown rig."""
    return compensate(TwinDevice(*case.parts(), case.seed), model, SPEEDS_mm_s, RigAware())


def judged(
    rig: Rig, finger: Finger, seed: int, model: FDVVModel, learned: CompensationResult,
    speeds: tuple[float, ...] = SPEEDS_mm_s, presses: int = 4,
) -> FloatArray:  # fmt: skip
    """Return the mean errors of fresh presses, (strokes and speeds,)."""
    device = TwinDevice(rig, finger, seed + JUDGE)
    probed = probe(device, model, learned.surface, speeds, presses, tuning=learned.outcome.tuning)
    return np.array([np.median(curve.mean_errors_cN) for curve in probed.curves])


@dataclass(frozen=True)
class Edited:
    """The learned error, that of the edited curve without a press, and of another button without a press."""

    def __call__(self, case: Case) -> FloatArray:
        (rig, finger), model = case.parts(), case.model
        learned = learn(case, model)
        assert learned.learned_rig is not None
        rows = [judged(rig, finger, case.seed, model, learned)]
        for other in (stiffer(model), replace(case, button="mx-brown").model):
            law = RigAware(rounds=0, learned_rig=learned.learned_rig)
            at_once = compensate(TwinDevice(rig, finger, case.seed), other, SPEEDS_mm_s, law)
            rows.append(judged(rig, finger, case.seed, other, at_once))
        return np.array([row.mean() for row in rows])


@dataclass(frozen=True)
class Static:
    """The error under a linear stage at 0.5 mm/s, press and release, from what faster presses taught."""

    def __call__(self, case: Case) -> FloatArray:
        (rig, finger), model = case.parts(), case.model
        law = RigAware(rounds=0, learned_rig=learn(case, model).learned_rig)
        slow = compensate(TwinDevice(rig, finger, case.seed), model, (STATIC_mm_s,), law)
        return judged(rig, stage_finger(), case.seed, model, slow, (STATIC_mm_s,), 1)


@dataclass(frozen=True)
class Against:
    """FDVV and FD, both compensated alike and judged against the full model: (2, strokes and speeds)."""

    def __call__(self, case: Case) -> FloatArray:
        (rig, finger), model = case.parts(), case.model
        both = [learn(case, one) for one in (model, fd_only(model))]
        return np.array([judged(rig, finger, case.seed, model, learned) for learned in both])


def found(
    work: Callable[[Case], FloatArray], button: str, options: tuple[Options, ...], rigs: int
) -> FloatArray:
    """Run a piece of work on rigs; give what finished, (rigs, ...)."""
    cases = [Case(FIRST_SEED + i, button, options) for i in range(rigs)]
    results = [result for _, result in run_all(work, cases)]
    return np.array([result for result in results if not isinstance(result, str)])


def main() -> None:
    rigs = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    print(f"mean error, cN, median (5-95 %) over {rigs} rigs and people; simulated")
    for name, options in PARTS.items():
        rows = found(Edited(), "mx-clear", options, rigs)
        ratio = spread((rows[:, 1] / rows[:, 0]).tolist()), spread((rows[:, 2] / rows[:, 0]).tolist())
        print(f"\n{name}: mx-clear learned {spread(rows[:, 0].tolist())}, without a press: 15 % stiffer "
              f"{spread(rows[:, 1].tolist())}, ratio {ratio[0]}; mx-brown {spread(rows[:, 2].tolist())}, "
              f"ratio {ratio[1]}", flush=True)  # fmt: skip
        still = found(Static(), "mx-clear", options, rigs)
        print(f"static, stage at {STATIC_mm_s:g} mm/s: press {spread(still[:, 0].tolist())}, "
              f"release {spread(still[:, 1].tolist())}", flush=True)  # fmt: skip
        for button in ("mx-clear", "rubber-dome"):
            table = found(Against(), button, options, rigs)
            print(f"{button}: FDVV | FD, and on how many of {len(table)} rigs FDVV is closer")
            for at in range(table.shape[2]):
                stroke = "press" if at < len(SPEEDS_mm_s) else "release"
                ours, flat = table[:, 0, at], table[:, 1, at]
                cells = f"{spread(ours.tolist())} | {spread(flat.tolist())} | {int((ours < flat).sum())}"
                print(f"| {stroke} {SPEEDS_mm_s[at % 4]:g} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
