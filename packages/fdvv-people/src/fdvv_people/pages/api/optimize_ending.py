"""How a run ends, as its page shows it: its retest, what that found, which compromise it recommends."""

from __future__ import annotations

from typing import Literal

from fdvv_people.optimize.run.ending import FinalMean, ending_sentences, final_means
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.verdict import Kind, Retest, at_bound, retest_of, verdict_kind, verdict_sentence
from fdvv_studio.studio.contract import Message


class OptimizeRetest(Message):
    """The start and the recommended design, played again blind, beside rivals if there are any.

    done, total : trials, or comparisons. open : number of the trial under way. at_bound : values of the
    recommended design that are the "least" or the "most" allowed. sentence, kind, found : what was found;
    None before its end, found also where nothing was to be retested. rivals : names of what is played too.
    ending : sentences on them. means : of all that was played; empty before the end.
    """

    done: int
    total: int
    open: int | None
    at_bound: dict[str, Literal["least", "most"]]
    sentence: str | None
    kind: Kind | None
    found: Retest | None
    rivals: list[str]
    ending: list[str]
    means: list[FinalMean]


def compromise(session: Optimization) -> int | None:
    """Return the number of the recommended trial of the front."""
    if not session.setup.several or not session.searched:
        return None
    found = session.recommended()
    return next((one.number for one in session.front().trials if one.design == found), None)


def retest_state(session: Optimization) -> OptimizeRetest:
    retests = session.retests
    open_ = next((one.number for one in retests if one.is_open), None)
    best = session.recommended() if session.searched else None
    return OptimizeRetest(
        sum(not one.is_open for one in retests),
        len(retests) + session.retest_left,
        open_,
        at_bound(session.space, best, session.start) if best else {},
        verdict_sentence(session),
        verdict_kind(session),
        retest_of(session) if session.finished else None,
        [one.name for one in session.setup.rivals if one.design is None or one.design != session.start],
        list(ending_sentences(session)),
        list(final_means(session)) if session.finished else [],
    )
