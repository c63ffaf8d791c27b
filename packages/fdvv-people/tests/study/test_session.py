"""What a participant meets next: nothing is met twice, nothing is left out, breaks are kept."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError, ModelError
from fdvv_people.study.plan.events import (
    BreakEnded,
    PageAnswered,
    ParticipantWithdrew,
    SessionClosed,
    SessionEvent,
    SessionResumed,
    SessionStarted,
    StaircaseConverged,
    TrialAnswered,
    TrialFace,
    TrialInterrupted,
    TrialShown,
    TrialSkipped,
    check_answer,
    checked_page,
    face_of,
    record_of,
)
from fdvv_people.study.plan.plan import Item, Page, Question, Rating, Staircase, Stimulus, StudyPlan
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.plan.trial import EQUAL, StudyTrial, TrialAnswer

STIMULI = (Stimulus(name="FD", button="mx-clear", rendered="FD"), Stimulus(name="FDVV", button="mx-clear"))
PAGES = (
    Page(name="consent", when="consent", title={"en": "Consent"}),
    Page(name="you", when="before", title={"en": "You"}),
    Page(name="end", when="after", title={"en": "Thanks"}),
)


def plan_of(**changes: Any) -> StudyPlan:
    about: dict[str, Any] = {
        "name": "demo",
        "title": {"en": "Demo"},
        "kind": "realism",
        "items": (Item(name="Clear", stimuli=STIMULI), Item(name="Blue", stimuli=STIMULI)),
        "pages": PAGES,
    }
    return StudyPlan(**(about | changes))


def faces(count: int = 4, practice: int = 1) -> tuple[TrialFace, ...]:
    return tuple(
        TrialFace(i, ("Clear", "Blue")[i % 2], i // 2, ("A", "B"), i < practice) for i in range(count)
    )


def started_session(plan: StudyPlan, trials: tuple[TrialFace, ...] | None = None) -> SessionState:
    return SessionState.of(plan, [SessionStarted(0.0, "P01", "en", faces() if trials is None else trials)])


def run(state: SessionState, now_s: float, work_s: float = 1.0) -> tuple[list[Step[TrialFace]], SessionState]:
    """Do every requested step until the session is over, each taking a while; return the steps."""
    steps = []
    while (step := state.step(now_s)).kind not in ("done", "declined", "withdrawn"):
        steps.append(step)
        if step.kind == "break":
            now_s += step.left_s
            state = state.after(BreakEnded(now_s))
        elif step.kind == "page":
            state = state.after(PageAnswered(now_s, step.page))
        else:
            attempt = state.attempts.get(step.number, 0) + 1
            state = state.after(TrialShown(now_s, step.number, attempt))
            now_s += work_s
            state = state.after(TrialAnswered(now_s, step.number, attempt, TrialAnswer("A")))
    return steps, state


def test_pages_come_before_and_after_and_practice_comes_first() -> None:
    steps, state = run(started_session(plan_of()), 0.0)
    assert [(step.kind, step.page or step.number) for step in steps] == [
        ("page", "consent"),
        ("page", "you"),
        ("practice", 0),
        ("trial", 1),
        ("trial", 2),
        ("trial", 3),
        ("page", "end"),
    ]
    assert state.step(9.0).kind == "done"
    assert state.step(9.0).progress == 1.0
    assert [step.progress for step in steps] == sorted(step.progress for step in steps)
    assert [(step.at, step.of) for step in steps[2:6]] == [(1, 1), (1, 3), (2, 3), (3, 3)]


def test_a_break_begins_at_the_first_boundary_after_the_work_and_lasts_to_its_end() -> None:
    plan = plan_of(break_every_min=1.0, break_min=2.0, pages=())
    steps, _ = run(started_session(plan, faces(8, 0)), 100.0, work_s=25.0)
    # 25, 50 and 75 s of work: the third answer is the first at or after a minute
    assert [step.kind for step in steps] == ["trial"] * 3 + ["break"] + ["trial"] * 3 + ["break"] + [
        "trial"
    ] * 2
    assert steps[3].left_s == 120.0


def test_no_break_follows_the_last_trial() -> None:
    plan = plan_of(break_every_min=1.0, break_min=2.0, pages=PAGES[2:])
    steps, _ = run(started_session(plan, faces(3, 0)), 0.0, work_s=25.0)
    assert [step.kind for step in steps] == ["trial"] * 3 + ["page"]


@pytest.mark.parametrize("off", ["break_every_min", "break_min"])
def test_a_plan_may_have_no_breaks(off: str) -> None:
    plan = plan_of(**{"break_every_min": 1.0, "break_min": 2.0, off: 0.0})
    steps, _ = run(started_session(plan), 0.0, work_s=600.0)
    assert "break" not in [step.kind for step in steps]


def resting() -> SessionState:
    plan = plan_of(break_every_min=1.0, break_min=2.0, pages=())
    state = started_session(plan).after(TrialShown(0.0, 0, 1))
    return state.after(TrialAnswered(60.0, 0, 1, TrialAnswer("A")))


def test_a_break_goes_on_while_nobody_runs_the_session() -> None:
    state = resting().after(SessionResumed(100.0, "code"))
    assert state.step(100.0).left_s == 80.0
    assert state.after(SessionClosed(101.0)).after(SessionResumed(1000.0, "code")).step(1000.0).left_s == 0.0
    # a clock that was set back by a day does not make it last a day
    assert state.step(-86_400.0).left_s == 120.0


def worked(*events: SessionEvent) -> SessionState:
    """Work 50 s, let something happen, and work until 10 s after."""
    plan = plan_of(break_every_min=1.0, break_min=2.0, pages=())
    state = (
        started_session(plan).after(TrialShown(0.0, 0, 1)).after(TrialAnswered(50.0, 0, 1, TrialAnswer("A")))
    )
    for event in events:
        state = state.after(event)
    last_s = events[-1].at_s
    state = state.after(TrialShown(last_s, 1, 1))
    return state.after(TrialAnswered(last_s + 10.0, 1, 1, TrialAnswer("A")))


def test_time_away_is_no_work_where_the_session_was_closed_and_a_break_where_it_was_long() -> None:
    assert worked(SessionClosed(50.0), SessionResumed(100.0, "code")).break_since_s == 110.0
    assert worked(SessionClosed(50.0), SessionResumed(99.0, "code")).work_since_s == 49.0
    assert worked(SessionClosed(50.0), SessionResumed(170.0, "code")).break_since_s is None


def test_time_after_a_crash_counts_as_work_for_nobody_knows_better() -> None:
    assert worked(SessionResumed(170.0, "code")).break_since_s == 180.0


def test_a_trial_that_was_shown_and_not_answered_is_met_again() -> None:
    state = started_session(plan_of(pages=())).after(TrialShown(1.0, 0, 1))
    assert not state.step(1.0).again
    for back in (SessionResumed(2.0, "keeper"), TrialInterrupted(2.0, 0)):
        after = state.after(back)
        step = after.step(2.0)
        assert (step.number, step.again) == (0, True)
        with pytest.raises(ModelError):
            after.after(TrialAnswered(3.0, 0, 1, TrialAnswer("A")))
        again = after.after(TrialShown(3.0, 0, 2)).after(TrialAnswered(4.0, 0, 2, TrialAnswer("A")))
        assert again.step(4.0).number == 1


def test_a_trial_is_given_up_only_after_the_device_went_away_in_it_three_times() -> None:
    state = started_session(plan_of(pages=()))
    for attempt in (1, 2, 3):
        with pytest.raises(ModelError, match="given up"):
            state.after(TrialSkipped(1.0, 0))
        state = state.after(TrialShown(1.0, 0, attempt)).after(TrialInterrupted(1.0, 0, felt=True))
    after = state.after(TrialSkipped(1.0, 0))
    assert (after.step(1.0).number, after.trials_left) == (1, state.trials_left - 1)
    assert state.after(TrialInterrupted(1.0, 0)).step(1.0).number == 0


@settings(deadline=None, max_examples=50)
@given(st.lists(st.sampled_from(["go", "crash", "lost", "leave"]), max_size=60))
def test_whatever_happens_every_trial_is_answered_once_and_in_order(happens: list[str]) -> None:
    plan = plan_of(break_every_min=0.2, break_min=0.1)
    state, now_s, order = started_session(plan, faces(6, 2)), 0.0, list[int]()
    for what in [*happens, *["go"] * 60]:
        now_s += 3.0
        step = state.step(now_s)
        events: list[SessionEvent] = []
        if what == "crash":
            events = [SessionResumed(now_s, "code")]
        elif what == "leave":
            events = [SessionClosed(now_s), SessionResumed(now_s + 1.0, "code")]
        elif step.kind == "page":
            events = [PageAnswered(now_s, step.page)]
        elif step.kind == "break":
            events = [] if step.left_s else [BreakEnded(now_s)]
        elif step.kind in ("practice", "trial") and state.open is None:
            events = [TrialShown(now_s, step.number, state.attempts.get(step.number, 0) + 1)]
        elif what == "lost" and state.open is not None:
            events = [TrialInterrupted(now_s, state.open)]
        elif state.open is not None:
            order.append(state.open)
            events = [TrialAnswered(now_s, state.open, state.attempts[state.open], TrialAnswer("A"))]
        for event in events:
            # what is read back from the journal is what was written
            state = state.after(SessionState.event_of(json.loads(json.dumps(record_of(event)))))
        assert state.open is None or state.open not in state.answers
    assert order == [0, 1, 2, 3, 4, 5]
    assert state.step(now_s).kind == "done"


@pytest.mark.parametrize(
    "event",
    [
        SessionStarted(1.0, "P01", "en", faces()),
        PageAnswered(1.0, "you"),
        PageAnswered(1.0, "end"),
        TrialShown(1.0, 0, 1),
        TrialAnswered(1.0, 0, 1, TrialAnswer("A")),
        BreakEnded(1.0),
        TrialInterrupted(1.0, 3),
    ],
)
def test_what_cannot_come_now_is_refused(event: SessionEvent) -> None:
    with pytest.raises(ModelError):
        started_session(plan_of()).after(event)


def test_a_session_begins_with_its_trials() -> None:
    with pytest.raises(ModelError):
        SessionState.of(plan_of(), [SessionClosed(1.0)])


def test_a_trial_of_a_staircase_that_has_ended_is_not_met() -> None:
    trials = tuple(TrialFace(i, "Clear", i // 3, ("A", "B")) for i in range(6))
    plan = plan_of(kind="staircase", staircase=Staircase(), pages=(), break_every_min=1.0, break_min=1.0)
    state = (
        started_session(plan, trials)
        .after(TrialShown(0.0, 0, 1))
        .after(TrialAnswered(90.0, 0, 1, TrialAnswer("A")))
    )
    assert state.step(90.0).kind == "break"
    state = state.after(StaircaseConverged(90.0, "Clear", 0))
    assert state.step(150.0).kind == "break"
    assert state.after(BreakEnded(150.0)).step(150.0).number == 3
    assert state.after(BreakEnded(150.0)).step(150.0).of == 0
    # with nothing left to do there is nothing to rest for
    assert state.after(StaircaseConverged(90.0, "Clear", 1)).step(90.0).kind == "done"


def test_who_does_not_consent_is_out_and_so_is_who_withdraws() -> None:
    state = started_session(plan_of())
    declined = state.after(PageAnswered(1.0, "consent", agreed=False))
    withdrawn = state.after(ParticipantWithdrew(1.0))
    assert declined.step(1.0).kind == "declined"
    assert withdrawn.step(1.0).kind == "withdrawn"
    for over in (declined, withdrawn):
        with pytest.raises(ModelError, match="over"):
            over.after(PageAnswered(2.0, "consent"))


def test_a_record_of_no_event_is_refused() -> None:
    records: list[dict[str, Any]] = [{"peeked": {}}, {"left": {}}, {"left": {"at_s": 1.0, "label": "A"}}]
    for record in records:
        with pytest.raises(ModelError):
            SessionState.event_of(record)


def test_the_face_of_a_trial_tells_its_labels_and_not_what_they_hide() -> None:
    reference = Stimulus(name="real", button="mx-clear")
    plan = plan_of(items=(Item(name="Clear", stimuli=STIMULI, reference=reference),))
    for hidden in ({"A": "FD", "B": "FDVV"}, {"B": "FD", "A": "FDVV"}):
        face = face_of(plan, StudyTrial(0, "Clear", 0, hidden, correct="A", ratio=0.3))
        assert face == TrialFace(0, "Clear", 0, ("X", "A", "B"))
    three = {"A": "a", "B": "b", "C": "c"}
    assert face_of(plan_of(kind="mushra"), StudyTrial(0, "Clear", 0, three)).labels == ("X", "A", "B", "C")
    assert face_of(plan_of(), StudyTrial(0, "Clear", 0, {"A": "FD", "B": "FDVV"})).labels == ("A", "B")


RATED = (Rating(name="realism", question={"en": "How real?"}),)
TRIAL = TrialFace(0, "Clear", 0, ("X", "A", "B"))
GOOD = {"realism": {"A": 3.0, "B": 7.0}}


@pytest.mark.parametrize("choice", ["A", "B", EQUAL])
def test_what_is_asked_may_be_answered(choice: str) -> None:
    check_answer(plan_of(ratings=RATED), TRIAL, TrialAnswer(choice, GOOD, ((0.5, "X"),), {"A": 3}))


@pytest.mark.parametrize(
    "answer",
    [
        TrialAnswer("X", GOOD),
        TrialAnswer("", GOOD),
        TrialAnswer("A"),
        TrialAnswer("A", {"realism": {"A": 3.0}}),
        TrialAnswer("A", {"realism": {"A": 3.0, "B": 7.0, "X": 7.0}}),
        TrialAnswer("A", {"realism": {"A": 0.0, "B": 7.0}}),
        TrialAnswer("A", {"realism": {"A": 8.0, "B": 7.0}}),
        TrialAnswer("A", {"realism": {"A": 2.5, "B": 7.0}}),
        TrialAnswer("A", {"realism": {"A": float("nan"), "B": 7.0}}),
        TrialAnswer("A", GOOD, ((0.5, "C"),)),
        TrialAnswer("A", GOOD, (), {"D": 1}),
    ],
)
def test_what_is_not_asked_may_not_be_answered(answer: TrialAnswer) -> None:
    with pytest.raises(InputError):
        check_answer(plan_of(ratings=RATED), TRIAL, answer)


QUESTIONS = (
    Question(
        name="hand", question={"en": "Hand?"}, choices={"en": ("left", "right"), "de": ("links", "rechts")}
    ),
    Question(name="age", question={"en": "Age?"}, low=18, high=99),
    Question(name="remark", question={"en": "Remarks?"}, required=False),
)
PAGE = Page(name="you", when="before", title={"en": "You"}, questions=QUESTIONS)


def test_a_choice_is_kept_in_the_first_language_and_what_may_be_left_out_is_nothing() -> None:
    plan = plan_of(languages=("en", "de"))
    kept = checked_page(plan.languages, PAGE, {"hand": "rechts", "age": 30})
    assert kept == {"hand": "right", "age": 30.0, "remark": None}


@pytest.mark.parametrize(
    "values",
    [
        {"age": 30},
        {"hand": "both", "age": 30},
        {"hand": "left", "age": 17},
        {"hand": "left", "age": "30"},
        {"hand": "left", "age": float("nan")},
        {"hand": "left", "age": 30, "remark": 3.0},
        {"hand": "left", "age": 30, "remark": "x" * 2001},
        {"hand": "left", "age": 30, "shoe": 44},
    ],
)
def test_what_a_page_does_not_ask_may_not_be_answered(values: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        checked_page(plan_of().languages, PAGE, values)
