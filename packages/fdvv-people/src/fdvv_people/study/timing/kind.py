"""The studies that time presses: what they are, of what `StudyKind` asks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from fdvv.device.open import is_manual
from fdvv_people.study.kind import Account, Refusal, StudyKind
from fdvv_people.study.plan.sitting import SittingState
from fdvv_people.study.timing.buttons import button_problems
from fdvv_people.study.timing.events import TimingStarted
from fdvv_people.study.timing.plan import DAY_s, TimingPlan
from fdvv_people.study.timing.plan_check import plan_problems
from fdvv_people.study.timing.schedule import SEED, draw_validation, drawn_seed, faces_of
from fdvv_people.study.timing.state import TimingState

if TYPE_CHECKING:
    from fdvv.report.report import Section
    from fdvv_people.study.admin.progress import PersonProgress
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.files.opened import OpenedPerson
    from fdvv_people.study.files.people import Person, Schedule
    from fdvv_people.study.plan.trial import StudyTrial
    from fdvv_people.study.simulation.sessions import SimulatedSession, Simulation
    from fdvv_people.study.timing.people import SimulatedTimer
    from fdvv_people.study.timing.progress import TimedProgress
    from fdvv_people.study.timing.scores import TimingScores

ASKS = "is for studies that ask about what is rendered"
BETWEEN_s = 10.0
"""Between two trials (assumed)."""
ROUND_s = {"easy": 2.8, "hard": 2.3}
"""What a press takes: the bullet's way, the dark before it, and the time in which a late press counts."""


class TimingStudies(StudyKind[TimingPlan]):
    """Studies that time presses: training, a gap, a validation."""

    format: ClassVar[str] = "fdvv-timing"
    plan = TimingPlan
    described: ClassVar[str] = "a timing study"
    gave: ClassVar[str] = "how they did"
    proxy_data: ClassVar[str] = "scores of the simulated people"
    unsealed: ClassVar[str] = " of validation"
    state: ClassVar[type[SittingState[Any]]] = TimingState
    refusals: ClassVar[Mapping[str, Refusal]] = {
        "preview": Refusal("preview", ASKS, "see what it comes to: fdvv study check"),
        "power": Refusal("power", ASKS, "simulate it, and read its intervals: fdvv study simulate"),
        "jnds": Refusal("study", "a timing study measures no JND", "name one of kind thresholds"),
    }

    def problems(self, plan: TimingPlan) -> tuple[str, ...]:
        return plan_problems(plan)

    def unfit(self, plan: TimingPlan, folder: Path) -> Iterable[str]:
        return button_problems(plan, folder)

    def account(self, plan: TimingPlan, folder: Path) -> Account:
        problems = plan_problems(plan) or tuple(button_problems(plan, folder))
        return Account(problems) if problems else Account((), (), _text(plan), _sections(plan))

    def device_problems(self, plan: TimingPlan, folder: Path, device: str) -> Iterable[str]:
        del plan, folder
        return () if is_manual(device) else ("is pressed by no person",)

    def draw(self, study: Study, place: int, simulated: bool) -> tuple[StudyTrial, ...]:
        what = f"orders of conditions, {study.fingerprint}"
        # simulated people have nothing to be blind to
        secret = what if simulated or study.run_key is None else study.run_key.mark(what)
        return draw_validation(study.plan, place, secret)

    def start(self, study: Study, person: Person, schedule: Schedule, at_s: float) -> TimingStarted:
        faces, seed = faces_of(study.plan, person.place, schedule.trials), drawn_seed(schedule.key, SEED)
        return TimingStarted(at_s, person.name, person.language, seed, faces, person.simulated)

    def progress(self, about: PersonProgress, state: TimingState | None, now_s: float) -> TimedProgress:
        from fdvv_people.study.timing.progress import timed_progress

        return timed_progress(about, state, now_s)

    def at_it(self, people: Sequence[PersonProgress], done: int) -> str:
        del done
        phases = [getattr(one, "phase", "") for one in people]
        counts = {
            "wait": phases.count("waiting"),
            "due to come back": phases.count("due") + phases.count("overdue"),
        }
        return "".join(f", {count} {what}" for what, count in counts.items() if count)

    def verdict(self, study: Study) -> tuple[str, bool | None] | None:
        from fdvv_people.study.timing.analyse import analyse_timing
        from fdvv_people.study.timing.report import capitalised
        from fdvv_people.study.timing.scores import unsealed_scores
        from fdvv_people.study.timing.sentences import verdict_sentence

        found = analyse_timing(unsealed_scores(study))
        return None if study.plan.claim is None else (capitalised(verdict_sentence(found)), found.holds)

    def unseal(self, plan: TimingPlan, people: Sequence[OpenedPerson], folder: Path) -> TimingScores:
        from fdvv_people.study.timing.unseal import unseal_timing

        return unseal_timing(plan, people, folder)

    def draw_simulated(self, study: Study, number: int, simulation: Simulation) -> SimulatedTimer:
        from fdvv_people.study.timing.people import draw_timer

        return draw_timer(study.plan, number, simulation.seed, simulation.rig)

    def session_row(self, session: SimulatedSession) -> Mapping[str, object]:
        one = session
        counts = {"trials": one.trials, "rounds": one.count, "breaks": one.breaks}
        return {"person": one.person, **counts, "days": one.time_s / DAY_s}

    def report(self, study: Study, origin: str) -> str:
        from fdvv_people.study.files.layout import UNSEALED
        from fdvv_people.study.timing.analyse import analyse_timing
        from fdvv_people.study.timing.report import timing_html
        from fdvv_people.study.timing.scores import unsealed_scores

        return timing_html(analyse_timing(unsealed_scores(study)), study.folder / UNSEALED, origin)


def _text(plan: TimingPlan) -> str:
    trials = plan.trials - plan.training_trials
    minutes = f"about {_minutes(plan, trials):.0f} minutes (assumed)"
    text = f"{trials} trial{'s' * (trials != 1)} of validation a person, {minutes}"
    if plan.training:
        before = (
            f"{plan.training_trials} of training, about {_minutes(plan, plan.training_trials):.0f} minutes"
        )
        text += f", {plan.gap_days:g} days after {before}"
    return f"{text}; {plan.people} people"


def _minutes(plan: TimingPlan, trials: int) -> float:
    """Return how long trials take, breaks between them included."""
    round_s = sum(plan.round_s(level) for level in plan.all_levels) / len(plan.all_levels)
    minutes = trials * (plan.trial_rounds * round_s + BETWEEN_s) / 60.0
    breaks = int(minutes / plan.break_every_min) if plan.break_every_min else 0
    return minutes + breaks * plan.break_min


def _pressing_min(plan: TimingPlan) -> float:
    if plan.tapping:
        return plan.trials * plan.tap_s / 60.0
    return sum(plan.trials / len(plan.levels) * plan.presses * ROUND_s[level] for level in plan.levels) / 60.0


def _sections(plan: TimingPlan) -> tuple[Section, ...]:
    """Return what a plan comes to for one person, and what is compared."""
    from fdvv.report.report import Section, Table

    rounds = f"{plan.tap_s} s of tapping" if plan.tapping else f"{plan.presses} presses"
    rows = [
        ("training", str(plan.training_trials), rounds),
        ("validation", str(plan.trials - plan.training_trials), rounds),
    ]
    gap = f" {plan.gap_days:g} days lie between the two." if plan.training else ""
    times = f"About {_pressing_min(plan):.0f} minutes of pressing in all, without breaks.{gap}"
    each = [(one.name, one.kind, one.button, one.code) for one in plan.conditions]
    return (
        Section("One person", (times,), tables=(Table(("Part", "Trials", "A trial"), tuple(rows)),)),
        Section("Compared", (), tables=(Table(("Name", "Kind", "Button", "Key"), tuple(each)),)),
    )


KIND = TimingStudies()
