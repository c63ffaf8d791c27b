"""The presses of a person in a task, each on the disk before the next: people cannot repeat them.

``rounds.jsonl`` in an optimisation's folder is a journal (see `fdvv.eventlog`) with the records
``{"begun": {…}}`` each time a trial is begun, ``{"round": {…}}`` for every round and ``{"rated": {…}}`` for
the answers to a questionnaire. A trial that was broken off and begun again keeps its rounds, but only those
of its last beginning count.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_bodies
from fdvv_people.task.task import TaskPress

ROUNDS = "rounds.jsonl"


class ClockSource(StrEnum):
    """Whose clock target and activations are on.

    page : the browser's; what its screen shows and its keys tell is late by delays, measured or stated.
    key : the target is on the page's, whose screen shows it; the key is a device's, joined with that.
    device : a device's own, which shows the target and feels the button.
    """

    PAGE = "page"
    KEY = "key"
    DEVICE = "device"


class RoundTiming(Struct, frozen=True, forbid_unknown_fields=True):
    """How the times of a round were measured, ms.

    Attributes
    ----------
    source : whose clock.
    display_ms, input_ms : from drawing to light, from finger to the browser's event; taken into account.
        A device's key is on its own clock: 0, and the error is the bound of that clock.
    display_error_ms, input_error_ms : how far they may be off, alike in all rounds.
    clock_ms, clock_error_ms : the server's clock less the source's, and its bound; None where not known.
    transport_ms : from the browser's event to the simulated finger; taken out.
    frame_ms : between two pictures of the screen.
    hand : what the person pressed: "key", "mouse", "touch", "pen"; "analog", a key that reports its depth;
        "button" of a device.
    """

    source: ClockSource
    display_ms: float
    display_error_ms: float
    input_ms: float
    input_error_ms: float
    clock_ms: float | None
    clock_error_ms: float | None
    transport_ms: float | None
    frame_ms: float | None
    hand: str


class TaskRound(Struct, frozen=True, forbid_unknown_fields=True):
    """One round: what counts, how it was timed, when it was (UTC).

    Attributes
    ----------
    trial, attempt : which trial, and how often it had been begun; number : of the round, from 1.
    target_s : when the target was seen. activations_s : when the key went down. On timing.source's clock.
    """

    trial: int
    attempt: int
    number: int
    target_s: float
    activations_s: tuple[float, ...]
    timing: RoundTiming
    made: str

    @property
    def press(self) -> TaskPress:
        """Return it as tasks score it."""
        return TaskPress(self.target_s, self.activations_s)


class TrialBegun(Struct, frozen=True):
    """A trial was begun for the given time, from 1, at a time (UTC)."""

    trial: int
    attempt: int
    made: str = ""


class TrialRated(Struct, frozen=True, forbid_unknown_fields=True):
    """The answers to the questionnaire after a trial.

    Attributes
    ----------
    trial, attempt : which trial, and how often it had been begun. made : when (UTC).
    answers : to the items of `fdvv_people.task.questionnaire`, in their order, from 1 to 7.
    """

    trial: int
    attempt: int
    answers: tuple[int, ...]
    made: str


KIND = JournalKind(
    {"begun": TrialBegun, "round": TaskRound, "rated": TrialRated},
    "move the file away; finished trials are in the ledger",
)


class KeptRounds:
    """The rounds of an optimisation in memory: which there are, and which of them count."""

    def __init__(self) -> None:
        self._attempts: dict[int, int] = {}
        self._rounds: list[TaskRound] = []

    def counting(self, trial: int) -> tuple[TaskRound, ...]:
        """Return the rounds of a trial since it was begun last."""
        attempt = self._attempts.get(trial, 0)
        return tuple(one for one in self._rounds if one.trial == trial and one.attempt == attempt)

    @property
    def all(self) -> tuple[TaskRound, ...]:
        """Return every round there ever was, those that do not count among them."""
        return tuple(self._rounds)

    def _put(self, _key: str, body: TrialBegun | TaskRound | TrialRated) -> None:
        if isinstance(body, TrialBegun):
            self._attempts[body.trial] = body.attempt
        elif isinstance(body, TaskRound):
            self._rounds.append(body)


def read_rounds(folder: Path) -> KeptRounds:
    """Read the rounds of an optimisation, none where nobody has played; no lock is taken.

    folder : of the optimisation. Raises InputError on a journal that is damaged, OSError.
    """
    found, path = KeptRounds(), folder / ROUNDS
    for key, body, _ in read_bodies(path, KIND) if path.exists() else ():
        found._put(key, body)
    return found


class TaskRounds(KeptRounds):
    """The rounds of an optimisation, in memory and on file, for one process at a time.

    Parameters
    ----------
    folder : of the optimisation.

    Raises InputError on a journal that is damaged or at work elsewhere, OSError.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self.path = folder / ROUNDS
        busy = InputError(
            self.path.name, "whole file", "another fdvv works on it", "close the other one first"
        )
        self._journal = Journal.resume(self.path, KIND, busy, self._put)

    def begin(self, trial: int) -> int:
        """Begin a trial, or begin it again; return how often it was."""
        begun = TrialBegun(trial, self._attempts.get(trial, 0) + 1, _now())
        self._write("begun", begun)
        return begun.attempt

    def add(
        self, trial: int, target_s: float, activations_s: tuple[float, ...], timing: RoundTiming
    ) -> TaskRound:
        """Write the next round of a trial that was begun to the disk."""
        number = len(self.counting(trial)) + 1
        attempt = self._attempts[trial]
        found = TaskRound(trial, attempt, number, target_s, activations_s, timing, _now())
        self._write("round", found)
        return found

    def rate(self, trial: int, answers: Sequence[int]) -> None:
        """Write the answers to a trial's questionnaire to the disk."""
        self._write("rated", TrialRated(trial, self._attempts[trial], tuple(answers), _now()))

    def _write(self, key: str, body: TrialBegun | TaskRound | TrialRated) -> None:
        self._journal.write({key: msgspec.to_builtins(body)})
        self._put(key, body)

    def close(self) -> None:
        self._journal.close()


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
