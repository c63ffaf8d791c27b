"""Is a part that breaks named within two presses, and is nothing named on a sound rig? Simulated.

Run as ``python -m benchmarks.rig_faults [first seed] [rigs] [sound sessions] [family]``; by default 500, and
10 and 100 of each family: a quarter of an hour on one core. Rigs and people are drawn: like the recommended
one with its load cell, and of the paper's parts with a force sensor in the cap. Rigs that the firmware
refuses are drawn anew, and faults are planted where the sound session comes to its end. Twelve faults are
planted in the plant behind the real firmware core, each from the start and from a press in mid-session on
where both make sense; then a whole session of learning is run. It counts as named if the session ends with
that part's name at the second press from the fault's begin on, the check's own press included. Seeds from
700 on were used to tune.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import count

from benchmarks.drawn_rigs import BUTTONS, Case, SPEEDS_mm_s
from benchmarks.force_loop import DESIGNS, RECOMMENDED, parts
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.linked import LinkedDevice
from fdvv.errors import FdvvError, ModelError, PartFaultError
from fdvv.model.file import load_builtin
from fdvv.rendering.compensate import compensate
from fdvv.rendering.part_check import CHECK_cN
from fdvv.rendering.session_run import Guide, PressDone
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from tests.support.rig_faults import PLANTED, PlantedPerson, WatchedBoard

FIRST, RIGS, SOUND = 500, 10, 100
WITHIN, SHOWN = 2, 20
FAMILIES = ("load cell", "force sensor in the cap")
LATE = 4
"""Mid-session faults begin at this press or up to three later, the check's own counted."""


def drawn(seed: int, family: str) -> tuple[Rig, Finger]:
    """Draw a rig and a person. ModelError if the firmware cannot hold the rig."""
    cell = family == FAMILIES[0]
    rig, finger = parts(Case(seed, BUTTONS[seed % len(BUTTONS)], DESIGNS[RECOMMENDED] if cell else ()), cell)
    if not cell:
        rig = replace(rig, keycap_sensor=replace(rig.keycap_sensor, kind="force"))
    return rig, finger


@dataclass(frozen=True)
class Outcome:
    """How a session ended: the part it named, or "-"; presses since the fault began; its text.

    largest_cN : commanded before the check had passed. finished : it came to its end.
    """

    part: str
    presses: int
    text: str
    largest_cN: float
    finished: bool


def session(seed: int, family: str, name: str = "", begins: int = 0) -> Outcome:
    """Run a session of learning on a drawn rig in which a fault begins at a press, from 1; 0: at once."""
    rig, finger = drawn(seed, family)
    board = WatchedBoard()
    person = PlantedPerson(rig, finger, seed, PLANTED.get(name), begins)
    watched = _Watched(board)
    with LinkedDevice(board, person) as device:
        part, text, finished = "-", "", True
        try:
            model = load_builtin(BUTTONS[seed % len(BUTTONS)])
            guide = Guide(lambda _ask: watched.asked())
            compensate(device, model, SPEEDS_mm_s, RigAware(1), watched.done, guide=guide)
        except PartFaultError as error:
            part, text, finished = error.fault.part, str(error), False
        except FdvvError as error:
            text, finished = str(error), False
        watched.asked()
    return Outcome(part, person.presses - max(begins, 1) + 1, text, watched.largest_cN, finished)


class _Watched:
    """Keeps the largest command until the first press of learning is asked for."""

    def __init__(self, board: WatchedBoard) -> None:
        self._board, self._passed = board, False
        self.largest_cN = 0.0

    def asked(self) -> None:
        """Look before each press that is asked for, and at the end: nothing was armed in between."""
        if not self._passed:
            self.largest_cN = self._board.largest_cN

    def done(self, _done: PressDone) -> None:
        self._passed = True


def begins_of(seed: int, name: str) -> Iterator[int]:
    """Yield the presses at which a fault begins: at once, and in mid-session."""
    if not PLANTED[name].begins_late:
        yield 0
    yield LATE + seed % 4


def is_right(outcome: Outcome, name: str) -> bool:
    return outcome.part in PLANTED[name].parts and outcome.presses <= WITHIN


def sound_sessions(first: int, family: str) -> Iterator[tuple[int, Outcome]]:
    """Run sessions on sound rigs, by seed. Rigs that the firmware refuses are left out."""
    for seed in count(first):
        with suppress(ModelError):
            yield seed, session(seed, family)


def judged(family: str, first: int, rigs: int, sound: int) -> None:
    """Print the confusion table of a family, and its false alarms; failures as they come."""
    running = sound_sessions(first, family)
    sessions: dict[int, Outcome] = {}
    while sum(outcome.finished for outcome in sessions.values()) < rigs:
        sessions.update([next(running)])
    seeds = [seed for seed, outcome in sessions.items() if outcome.finished]
    print(f"\n{family}, rigs {seeds}", flush=True)
    outcomes: list[tuple[str, int, int, Outcome]] = []
    for name in PLANTED:
        for seed in seeds:
            for begins in begins_of(seed, name):
                outcome = session(seed, family, name, begins)
                outcomes.append((name, seed, begins, outcome))
                if not is_right(outcome, name):
                    print(f"  {name}, rig {seed} from press {begins}: {outcome}", flush=True)
    print_confusion(outcomes)
    right = sum(is_right(outcome, name) for name, _, _, outcome in outcomes)
    share = 100 * right / len(outcomes)
    print(f"named within {WITHIN} presses on {len(seeds)} rigs: {right} of {len(outcomes)}, {share:.1f} %")
    largest_cN = max(outcome.largest_cN for *_, outcome in outcomes)
    print(f"largest command before the check had passed: {largest_cN:.1f} of {CHECK_cN:.0f} cN", flush=True)
    while len(sessions) < sound:
        sessions.update([next(running)])
        if len(sessions) % SHOWN == 0 or len(sessions) == sound:
            false = [seed for seed, outcome in sessions.items() if outcome.part != "-"]
            print(f"a part named in {len(false)} of {len(sessions)} sound sessions {false}", flush=True)


def print_confusion(outcomes: list[tuple[str, int, int, Outcome]]) -> None:
    """Print what was named of each fault; "late" is the right part after more presses."""
    confusion = {name: Counter[str]() for name in PLANTED}
    for name, _, _, outcome in outcomes:
        late = outcome.part in PLANTED[name].parts and not is_right(outcome, name)
        confusion[name]["late" if late else outcome.part] += 1
    named = sorted({part for row in confusion.values() for part in row})
    print("\n| fault | " + " | ".join(named) + " |")
    print("|---|" + "---|" * len(named))
    for name, row in confusion.items():
        print(f"| {name} | " + " | ".join(str(row[part] or "") for part in named) + " |")


def main() -> None:
    given = [int(text) for text in sys.argv[1:4]]
    first, rigs, sound = (*given, *(FIRST, RIGS, SOUND)[len(given) :])
    for family in FAMILIES:
        if sys.argv[4:] and not family.startswith(sys.argv[4]):
            continue
        judged(family, first, rigs, sound)


if __name__ == "__main__":
    main()
