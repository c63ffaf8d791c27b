"""What the log of a timing session must hold, for verification."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from fdvv.errors import ModelError
from fdvv_people.study.files.person_check import SessionReading
from fdvv_people.timing.plan.events import RoundKept
from fdvv_people.timing.plan.session import TimingState


def _rounds(records: Sequence[dict[str, Any]]) -> int:
    return sum(RoundKept.word in record for record in records)


def _lacks(records: Sequence[dict[str, Any]]) -> Iterator[str]:
    """Return what a session that is done lacks: trials that were neither scored nor given up."""
    try:
        happened = [TimingState.event_of(record) for record in records]
    except ModelError as error:
        yield str(error)
        return
    over = {getattr(one, "number", -1) for one in happened if one.word in ("scored", "failed", "skipped")}
    left = [trial for one in happened for trial in getattr(one, "trials", ()) if trial.number not in over]
    if left:
        yield f"lacks the scores of {len(left)} trials, and the person was done"


READING = SessionReading(_rounds, _lacks)
