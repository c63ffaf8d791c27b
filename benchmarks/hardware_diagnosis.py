"""Does the self-test name the part that is wrong? Every fault on rigs drawn at random. Simulated.

``python -m benchmarks.hardware_diagnosis [rigs] [first seed] [sound rigs] [workers]``
Bounds were set on seeds below 1000. A drawn rig is what its builder has the settings for; what was built
is off by what parts and hands leave.
"""

from __future__ import annotations

import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import replace

import numpy as np

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.errors import ModelError
from fdvv.twin.draw import draw_rig
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv_rig.selftest.diagnosis import Diagnosis, diagnose
from fdvv_rig.selftest.faults import RIG_FAULTS
from fdvv_rig.selftest.measure import measure_rig
from fdvv_rig.selftest.operator import SOUND, SimulatedOperator

FIRST_SEED = 2000
RIGS = 4
SOUND_RIGS = 100
NONE = "none"


def parts(seed: int) -> tuple[Rig, Rig]:
    """Draw a rig with a force sensor in its cap, and what its builder made of it.

    A coil too weak for the settings cannot be run at all: the next draw counts.
    """
    random = np.random.default_rng(seed)
    while True:
        rig = draw_rig(random)
        exact = replace(rig.controller, gain_error_ratio=0.0)
        rig = replace(rig, keycap_sensor=replace(rig.keycap_sensor, kind="force"), controller=exact)
        built = as_built(rig, random)
        with suppress(ModelError):
            settings_of(rig)
            return rig, built


def as_built(rig: Rig, random: np.random.Generator) -> Rig:
    """Return the rig with what remains off: coil, supply, stop and force sensor, within what hands leave."""
    coil, servo, cap = rig.coil, rig.servo, rig.keycap_sensor

    def off(ratio: float) -> float:
        return 1 + random.uniform(-ratio, ratio)

    coil = replace(
        coil,
        force_constant_N_A=coil.force_constant_N_A * off(0.1),
        resistance_ohm=coil.resistance_ohm * off(0.05),
        supply_V=coil.supply_V * off(0.03),
    )
    servo = replace(
        servo,
        pulse_us_mm=servo.pulse_us_mm * off(0.02),
        pulse_zero_us=servo.pulse_zero_us + random.uniform(-10, 10),
    )
    return replace(
        rig, coil=coil, servo=servo, keycap_sensor=replace(cap, full_scale_N=cap.full_scale_N * off(0.05))
    )


def tested(case: tuple[int, str]) -> tuple[str, str, str, str]:
    """Test one rig with one fault; give fault, part that is wrong, part that was named, and the evidence."""
    seed, name = case
    rig, built = parts(seed)
    fault = RIG_FAULTS.get(name, SOUND)
    hands = SimulatedOperator(rig, seed, fault, built)
    device = LinkedDevice(LibraryBoard(), hands)
    try:
        found: Diagnosis = diagnose(measure_rig(device, hands))
    finally:
        device.close()
    wrong = found.wrong
    named = wrong.part if wrong else (NONE if found.passed else "unfinished")
    return name, fault.part or NONE, named, f"seed {seed}: {wrong.evidence if wrong else ''}"


def main(rigs: int = RIGS, first: int = FIRST_SEED, sound: int = SOUND_RIGS, workers: int = 2) -> None:
    cases = [(first + i, NONE) for i in range(sound)]
    cases += [(first + i, name) for i in range(rigs) for name in RIG_FAULTS]
    table: Counter[tuple[str, str]] = Counter()
    mistakes: list[str] = []
    with ProcessPoolExecutor(workers) as pool:
        for done, (name, part, named, seen) in enumerate(pool.map(tested, cases), start=1):
            table[name, named] += 1
            print(f"{done} of {len(cases)}, {len(mistakes)} wrong", file=sys.stderr, end="\r")
            if named != part:
                mistakes.append(f"  {name}: named {named}; {seen}")
    print("simulated; fault: part named (times)")
    for name in [NONE, *RIG_FAULTS]:
        row = {named: n for (fault, named), n in sorted(table.items()) if fault == name}
        print(f"  {name:18} {', '.join(f'{named} {n}' for named, n in row.items())}")
    right = sum(n for (name, named), n in table.items() if name != NONE and named == RIG_FAULTS[name].part)
    tried = rigs * len(RIG_FAULTS)
    alarms = sound - table[NONE, NONE]
    print(f"right part named: {right} of {tried} ({100 * right / tried:.1f} %)")
    print(f"false alarms: {alarms} of {sound} sound rigs ({100 * alarms / sound:.1f} %)")
    print("\n".join(mistakes))


if __name__ == "__main__":
    main(*(int(arg) for arg in sys.argv[1:]))
