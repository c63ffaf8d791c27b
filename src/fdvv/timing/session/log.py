"""A timing session, opened: its state, and every press on the disk before it counts."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.study.files.chained_log import read_chained
from fdvv.study.files.people import SealedTrial
from fdvv.study.files.seal import KeyHolder
from fdvv.study.plan.events import SessionResumed
from fdvv.study.session.log import REMEDY
from fdvv.study.session.logs import SessionLogs
from fdvv.timing.files.study import TimingStudy
from fdvv.timing.plan.events import TimingEvent, TimingStarted, timing_event
from fdvv.timing.plan.plan import TimingPlan
from fdvv.timing.plan.schedule import faces_of
from fdvv.timing.plan.session import ENDS, TimingState, next_timing_step, timing_state

SEED, RANDOM = 0, 1
"""What is drawn of a person's key: the engine's seed, which is no secret, and that of the random design."""


class OpenedTiming:
    """A session that is open: every record is on the disk before it counts. For one process at a time.

    Opening it logs that it starts, or is resumed; nothing is logged of a session that is done. code : the
    person's, or the key holder in its place. InputError, OSError.

    Attributes
    ----------
    conditions : behind the validation's trials, by number. **Secret.** random_seed : of the person's random
        design. **Secret.** state : after all events.
    """

    def __init__(self, study: TimingStudy, name: str, code: str | KeyHolder, at_s: float) -> None:
        schedule = study.schedule(name, code)
        self.conditions = {one.number: next(iter(one.labels.values())) for one in schedule.trials}
        self.random_seed = drawn_seed(schedule.key, RANDOM)
        self._logs = SessionLogs(study, schedule, code)
        try:
            state = _state(self._logs.path, study.plan, self._logs.records)
            if state is None:
                person = study.person(name)
                faces = faces_of(study.plan, person.place, schedule.trials)
                seed = drawn_seed(schedule.key, SEED)
                started = TimingStarted(at_s, name, person.language, seed, faces, person.simulated)
                self.state = timing_state(study.plan, [started])
                self._write(started, self.state)
            else:
                self.state = state
                if next_timing_step(state, at_s).kind not in ENDS:
                    self.add(SessionResumed(at_s, "keeper" if isinstance(code, KeyHolder) else "code"))
        except BaseException:
            self._logs.abandon()
            raise

    def add(self, event: TimingEvent) -> TimingState:
        """Log an event and return the state after it. ModelError where it cannot follow."""
        after = self.state.after(event)
        self._write(event, after)
        self.state = after
        return after

    def _write(self, event: TimingEvent, after: TimingState) -> None:
        self._logs.write(event, sum(map(len, after.rounds.values())))

    def seal(self, trial: SealedTrial) -> None:
        """Log what was behind a code, for the key holder; of several of one number the last counts."""
        self._logs.seal(trial)

    def close(self) -> None:
        """Close the logs; idempotent."""
        self._logs.close()


def drawn_seed(key: str, stream: int) -> int:
    """Return a seed that follows from a person's key, a hexadecimal number, one way."""
    return int(np.random.SeedSequence([int(key, 16), stream]).generate_state(1)[0])


def read_timing(path: Path, plan: TimingPlan) -> TimingState | None:
    """Return the state of a session, while it runs or after; None where it did not start. InputError."""
    return _state(path, plan, read_chained(path).records)


def _state(path: Path, plan: TimingPlan, records: Sequence[dict[str, Any]]) -> TimingState | None:
    try:
        return timing_state(plan, [timing_event(record) for record in records]) if records else None
    except ModelError as error:
        raise InputError(path, "session", str(error), REMEDY) from error
