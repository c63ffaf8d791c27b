"""How fast do people tap on programs and on buttons, and which of the presses are theirs? Simulated.

Run as ``python -m benchmarks.tapping [PEOPLE]`` (default 12). Three tables, about two minutes:

- what a tapping study of simulated people scores, by how many strokes a second a finger makes at most.
  Presses of the key are counted, then the strokes that closed it, as they were made and as they are found
  from the presses alone (`fdvv_people.task.tapping.strokes_Hz`);
- what each button does under a finger that leans on it and makes no stroke at all;
- which taps of a hand on a keyboard the twin's finger follows in the studio, and with what delay.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.program.library import load_shipped
from fdvv.program.program import Program
from fdvv.twin.gesture import depth_m
from fdvv.units import FloatArray, N_from_cN
from fdvv_people.optimize.people.groups import TAPPERS
from fdvv_people.optimize.people.press_simulator import PressSimulator
from fdvv_people.optimize.people.simulate import simulate_task
from fdvv_people.optimize.people.user import SimulatedUser, draw_users
from fdvv_people.study.timing.people import MOST_STROKES
from fdvv_people.task.tapping import RapidTapping, strokes_Hz
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.press import LiveEventKind, LivePress
from fdvv_studio.live.press_subject import PressSubject, model_subject, program_subject

BUTTONS = ("fast-tapping", "rapid-trigger", "mx-red", "mx-clear")
SEED = 900
TRIAL_s = 10
LEANS_cN = range(20, 160, 10)
LEAN_s = 2.0
HANDS = ((4.0, 0.1), (6.0, 0.08), (8.0, 0.05), (10.0, 0.04), (12.0, 0.025))
"""Taps a second, and how long each is held."""
TAPS = 60


def opened(name: str) -> FDVVModel | Program:
    return load_builtin(name) if name in builtin_names() else load_shipped(name)


def tapped(name: str, user: SimulatedUser, rig: str) -> tuple[float, float, float]:
    """Return presses, strokes that closed the key, and strokes as found from the presses, a second."""
    rounds = simulate_task(RapidTapping(MOST_STROKES * TRIAL_s), opened(name), user, SEED, rig=rig)
    first = [press.activations_s[0] for press in rounds if press.activations_s]
    within = [
        press for press in rounds if press.activations_s and press.activations_s[-1] < first[0] + TRIAL_s
    ]
    presses = RapidTapping().scores(within)["rate_Hz"].value
    strokes = (len(within) - 1) / (within[-1].activations_s[0] - first[0])
    return presses, strokes, strokes_Hz(within)


def rates(people: int) -> None:
    """Print the rates of people by their limit, and on rigs of real parts."""
    print(
        "limit of strokes (1/s) | rig | button | presses (1/s), SD of people | strokes made | strokes found"
    )
    drawn = draw_users(people, SEED, TAPPERS)
    limits = {"none": 0.0, "5": 5.0, "6": 6.0, "7": 7.0}
    groups = {name: [replace(one, strokes_Hz=limit) for one in drawn] for name, limit in limits.items()}
    rows = [
        ("5.1 to 7.0, drawn", "ideal", list(drawn)),
        *((name, "ideal", one) for name, one in groups.items()),
    ]
    rows += [("5.1 to 7.0, drawn", rig, list(drawn)) for rig in ("paper", "light")]
    for limit, rig, users in rows:
        for name in BUTTONS:
            found = np.array([tapped(name, user, rig) for user in users])
            presses, strokes, guessed = found.mean(axis=0)
            spread = found[:, 0].std(ddof=1)
            print(f"{limit} | {rig} | {name} | {presses:.2f}, {spread:.2f} | {strokes:.2f} | {guessed:.2f}")


def leant_Hz(name: str, force_cN: float) -> tuple[float, float]:
    """Return presses a second under a finger that holds its referent still, and the mean force on the cap.

    force_cN : the finger's on a cap at the key's usual place, 1 mm deep.
    """
    bench = PressSimulator(opened(name), SimulatedUser())
    random = np.random.default_rng(SEED)
    usual = bench.draw(random)
    end_m = 1e-3 + depth_m(bench.finger, N_from_cN(force_cN), usual.stiffness_N_m)
    rig = bench.settled(random, bench.ticks_in(LEAN_s))
    rig.press(replace(usual, end_m=end_m, dwell_s=2 * LEAN_s))
    ticks = rig.advance(bench.ticks_in(LEAN_s))
    half = ticks.key.size // 2
    key = ticks.key[half:] > 0
    return float((key[1:] & ~key[:-1]).sum() / (LEAN_s / 2)), float(ticks.force_cN[half:].mean())


def leaning() -> None:
    """Print what each button does under a finger that only leans on it."""
    print("\nbutton | finger's force at 1 mm (cN): presses (1/s), mean force on the cap (cN)")
    for name in BUTTONS:
        found = ((force_cN, *leant_Hz(name, force_cN)) for force_cN in LEANS_cN)
        cells = (f"{force}: {rate:.0f}, {mean_cN:.0f}" for force, rate, mean_cN in found)
        print(f"{name} | {'; '.join(cells)}")


def followed(
    hand: BinaryFinger, subject: PressSubject, rate_Hz: float, hold_s: float
) -> Iterator[FloatArray]:
    """Yield the delays of the key after each tap, s; the hand's times differ by up to a tenth."""
    press, random = LivePress(subject, SEED), np.random.default_rng(SEED)
    hand.up(press)
    press.advance(0.5)
    downs_s, keys_s = list[float](), list[float]()
    for _ in range(TAPS):
        downs_s.append(press.time_s)
        for move, time_s in ((hand.down, hold_s), (hand.up, 1 / rate_Hz - hold_s)):
            move(press)
            events = press.advance(time_s * random.uniform(0.9, 1.1))[1]
            keys_s += [event.t_s for event in events if event.kind is LiveEventKind.ACTUATION]
    keys = np.array(keys_s)
    for start_s, end_s in pairwise([*downs_s, np.inf]):
        yield keys[(keys >= start_s) & (keys < end_s)] - start_s


def following() -> None:
    """Print which taps the twin's finger follows."""
    print("\nfinger | button | taps (1/s), held (ms) | answered once (%) | delay (ms), SD")
    for name in BUTTONS:
        button = opened(name)
        subject = program_subject(button) if isinstance(button, Program) else model_subject(button)
        for what, hand in (
            ("whole presses", BinaryFinger.of(subject)),
            ("tapping", BinaryFinger.tapping(subject)),
        ):
            for rate_Hz, hold_s in HANDS:
                delays = list(followed(hand, subject, rate_Hz, hold_s))
                first_ms = 1e3 * np.array([one[0] for one in delays if one.size])
                delay = f"{np.median(first_ms):.1f}, {first_ms.std():.1f}" if first_ms.size else "–"
                once = 100 * np.mean([one.size == 1 for one in delays])
                print(f"{what} | {name} | {rate_Hz:.0f}, {1e3 * hold_s:.0f} | {once:.0f} | {delay}")


def main(people: int = 12) -> None:
    """Print all of it."""
    print("simulated")
    rates(people)
    leaning()
    following()


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:2]))
