"""Does one ordinary press tell that a rig has changed? Simulated; some minutes.

Run as ``python -m benchmarks.drift``, or with the first and the last seed. MX Clear; rigs as in
``benchmarks.identify``, identified from four presses; then one press each at four speeds of the same rig, and
one at 100 mm/s of a rig with one change.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace

from fdvv.compensation.identification.drift import detect_drift
from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.twin import TwinDevice
from fdvv.errors import FitError, ModelError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.twin.rig import Rig
from tests.support.rig_truth import draw_fast_rig, rig_truth

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
SEEDS = range(300, 320)


def doubled_drag(rig: Rig) -> Rig:
    drag = rig.mover.viscous_N_s_m + max(0.5, rig_truth(rig).drag_N_s_m)
    return replace(rig, mover=replace(rig.mover, viscous_N_s_m=drag))


def weaker(rig: Rig) -> Rig:
    scale = 0.92 * (1 + rig.controller.gain_error_ratio) - 1
    return replace(rig, controller=replace(rig.controller, gain_error_ratio=scale))


def rougher(rig: Rig) -> Rig:
    return replace(rig, mover=replace(rig.mover, coulomb_N=rig.mover.coulomb_N + 0.05))


def heavier(rig: Rig) -> Rig:
    mass = rig.mover.mass_kg + 0.008
    gravity = rig.mover.gravity_m_s2 * rig.mover.mass_kg / mass
    return replace(rig, mover=replace(rig.mover, mass_kg=mass, gravity_m_s2=gravity))


def later(rig: Rig) -> Rig:
    sensor = rig.position_sensor
    return replace(rig, position_sensor=replace(sensor, bandwidth_Hz=0.5 * sensor.bandwidth_Hz))


CHANGES: dict[str, tuple[Callable[[Rig], Rig], str, tuple[float, ...]]] = {
    "nothing": (lambda rig: rig, "", SPEEDS_mm_s),
    "drag doubled, at least 0.5 N s/m more": (doubled_drag, "drag rose", (100.0,)),
    "gain 8 % less": (weaker, "gain fell", (100.0,)),
    "friction 5 cN more": (rougher, "friction rose", (100.0,)),
    "mass 8 g more, weight as before": (heavier, "mass rose", (100.0,)),
    "position sensor half as fast": (later, "position lag rose", (100.0,)),
}
"""What is done to the rig, what should be said, at which speeds."""


def said(seed: int, drive: str) -> dict[str, list[str]]:
    """Return what is said of one rig, by the change; nothing of one that cannot be pressed."""
    rig, finger = draw_fast_rig(seed, drive)
    button = load_builtin("mx-clear")
    target = ForceSurface.of_model(button, SPEEDS_mm_s, 0.05)
    found: dict[str, list[str]] = {name: [] for name in CHANGES}
    try:
        device = TwinDevice(rig, finger, seed)
        device.upload(identification_surface(target), button.travel_mm)
        known = identify([device.press(v) for v in SPEEDS_mm_s], button.travel_mm)
        for name, (change, _, speeds) in CHANGES.items():
            device = TwinDevice(change(rig), finger, seed + 7000)
            device.upload(identification_surface(target, ripple_cN=0.0), button.travel_mm)
            found[name] = [verdict_by(known, device.press(v), button.travel_mm) for v in speeds]
    except ModelError:
        pass
    return found


def verdict_by(known: RigModel, press: Press, travel_mm: float) -> str:
    """Return what is said of one press; also why nothing can be."""
    try:
        return detect_drift(known, press, travel_mm)
    except FitError as error:
        return str(error)


def main() -> None:
    first, last = (int(a) for a in sys.argv[1:3]) if len(sys.argv) > 2 else (SEEDS[0], SEEDS[-1])
    print("| changed, simulated | presses | said nothing | named first | named otherwise |")
    print("|---|---|---|---|---|")
    results = [said(seed, drive) for seed in range(first, last + 1) for drive in ("voltage", "current")]
    for name, (_, wanted, _) in CHANGES.items():
        texts = [text for one in results for text in one[name]]
        silent = sum(not text for text in texts)
        named = sum(bool(wanted) and text.startswith(wanted) for text in texts)
        print(f"| {name} | {len(texts)} | {silent} | {named} | {len(texts) - silent - named} |")


if __name__ == "__main__":
    main()
