"""One trial while it runs: its stimuli, the renderer that may be lost, what is observed, what is sealed."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from itertools import islice
from typing import TypeVar

import msgspec
import numpy as np

from fdvv.errors import DeviceError, ModelError
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.plan.plan import Stimulus, StudyPlan, Thresholds
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.plan.staircase import staircase_state
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.plan.threshold_trials import grown_stimulus, replayed_change
from fdvv_people.study.plan.trial import Rendered, StudyTrial, TrialAnswer
from fdvv_people.study.stimulus.renderer import StimulusRenderer
from fdvv_people.thresholds.belief import Change

GONE = "the device went away; connect it again: the trial goes on"
"""All that is reported: the reason could reveal what was rendered, and is sealed."""

SEALED_BYTES = 16_384
"""Of every trial: its length does not show how many presses or faults there were."""

Result = TypeVar("Result")
# a label's names and faults, and the two numbers of a press, take no more than so many bytes as JSON
_LABEL_BYTES, _PRESS_BYTES = 1_200, 22
# that holds because numbers, faults and their lengths are bounded
_LARGEST, _FAULTS, _FAULT = 99_999.0, 6, 40


def trial_stimuli(plan: StudyPlan, trial: StudyTrial) -> dict[str, Stimulus]:
    """Return the stimulus of each label, in the labels' order; X too where it is rendered. **Secret.**

    The comparison of a staircase, its second stimulus, is stronger by the trial's ratio; where thresholds are
    measured, by its change.
    """
    item = next((item for item in plan.items if item.name == trial.item), None)
    if item is None:
        raise ModelError(f"the plan has no item {trial.item}")
    named = {stimulus.name: stimulus for stimulus in item.stimuli}
    if plan.staircase:
        second = item.stimuli[1]
        ratio = second.force_ratio * (1.0 + trial.ratio)
        named[second.name] = msgspec.structs.replace(second, force_ratio=ratio)
    if plan.thresholds:
        named[item.stimuli[1].name] = grown_stimulus(item.stimuli[1], trial.change)
    found = {label: named[name] for label, name in trial.labels.items()}
    reference = task_of(plan.kind).shown_reference(item)
    if reference and "X" not in found:
        found["X"] = reference
    return dict(sorted(found.items()))


def staircase_ratio(
    plan: StudyPlan, schedule: Sequence[StudyTrial], state: SessionState, number: int
) -> float | None:
    """Return the ratio that the staircase of a trial has reached, None where it has ended, with its answer.

    Of other kinds of trials it is as drawn. A staircase is replayed: ratios are not logged, they follow from
    the answers.
    """
    trial = schedule[number]
    if plan.staircase is None or trial.practice:
        return trial.ratio
    history: list[tuple[float, bool]] = []
    for one in schedule:
        answered = state.answers.get(one.number)
        if answered and not one.practice and (one.item, one.round) == (trial.item, trial.round):
            ratio = staircase_state(plan.staircase, history).ratio
            assert ratio is not None
            history.append((ratio, answered.answer.choice == one.correct))
    return staircase_state(plan.staircase, history).ratio


def trial_due(
    plan: StudyPlan, schedule: Sequence[StudyTrial], state: SessionState, number: int
) -> StudyTrial | None:
    """Return a trial with what the answers so far make of it; None where its staircase has ended."""
    trial = schedule[number]
    if plan.thresholds and not trial.practice:
        return msgspec.structs.replace(trial, change=_change(plan.thresholds, schedule, state, trial))
    ratio = staircase_ratio(plan, schedule, state, number)
    return None if ratio is None else msgspec.structs.replace(trial, ratio=ratio)


def has_ended(plan: StudyPlan, schedule: Sequence[StudyTrial], state: SessionState, number: int) -> bool:
    """Return whether a trial's staircase has ended."""
    return plan.staircase is not None and staircase_ratio(plan, schedule, state, number) is None


def _change(
    rule: Thresholds, schedule: Sequence[StudyTrial], state: SessionState, trial: StudyTrial
) -> Change:
    answers = []
    for one in schedule:
        answered = state.answers.get(one.number)
        if answered and not one.practice and one.item == trial.item:
            answers.append(answered.answer.choice == one.correct)
    return replayed_change(rule, answers)


def sealed_bytes(trial: SealedTrial) -> bytes:
    """Return a trial as exactly SEALED_BYTES. ModelError where it has too many labels for that.

    Of very many presses as many as fit are kept, evenly spaced: their median error decides whether a trial
    counts.
    """
    room = SEALED_BYTES // max(1, len(trial.rendered)) - _LABEL_BYTES
    kept = tuple(_short(one, max(1, room // _PRESS_BYTES)) for one in trial.rendered)
    text = msgspec.json.encode(msgspec.structs.replace(trial, rendered=kept))
    if len(text) > SEALED_BYTES:
        raise ModelError(f"a trial of {len(trial.rendered)} renderings is too much to be sealed")
    # blanks at the end of JSON mean nothing
    return text.ljust(SEALED_BYTES)


def _short(one: Rendered, presses: int) -> Rendered:
    count = len(one.error_cN)
    even = np.unique(np.linspace(0, count - 1, min(count, presses)).astype(int)).tolist()
    # other letters than those of ASCII need more bytes than one
    plain = ("".join(c if c.isascii() and c.isprintable() else "?" for c in text) for text in one.faults)
    faults = tuple(text[:_FAULT] for text in islice(plain, _FAULTS))
    return msgspec.structs.replace(
        one,
        error_cN=tuple(_number(one.error_cN[i]) for i in even),
        velocity_mm_s=tuple(_number(one.velocity_mm_s[i]) for i in even if i < len(one.velocity_mm_s)),
        faults=faults,
    )


def _number(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(min(value, _LARGEST), 3)


class RendererLostError(Exception):
    """The renderer cannot be used any more; its text is **secret**."""


class ReconnectableRenderer:
    """A renderer that may be lost; from then on its methods raise RendererLostError."""

    def __init__(self, plan: StudyPlan, renderer: StimulusRenderer) -> None:
        self._plan = plan
        self._renderer: StimulusRenderer | None = renderer

    def require(self) -> StimulusRenderer:
        """Return the renderer. DeviceError where there is none."""
        if self._renderer is None:
            raise DeviceError(GONE)
        return self._renderer

    def prepare(self, trial: StudyTrial) -> None:
        stimuli = trial_stimuli(self._plan, trial)
        self._use(lambda renderer: renderer.prepare(stimuli))

    def show(self, label: str) -> None:
        self._use(lambda renderer: renderer.show(label))

    def evidence(self, trial: StudyTrial) -> SealedTrial:
        """Return what was rendered in a trial; that it was lost, where the renderer is lost now."""
        try:
            rendered = self._use(lambda renderer: renderer.rendered())
        except RendererLostError as error:
            return self.lost(trial, str(error))
        return SealedTrial(trial.number, trial.ratio, rendered, trial.change)

    def lost(self, trial: StudyTrial, reason: str) -> SealedTrial:
        """Return the record of a trial whose renderer was lost, with the reason."""
        faults = ("device lost", reason)
        stimuli = trial_stimuli(self._plan, trial).items()
        rendered = tuple(Rendered(label, one.name, faults=faults) for label, one in stimuli)
        return SealedTrial(trial.number, trial.ratio, rendered, trial.change)

    def replace(self, renderer: StimulusRenderer) -> None:
        self.drop()
        self._renderer = renderer

    def drop(self) -> None:
        """Close the renderer; idempotent."""
        if self._renderer is not None:
            # what is gone cannot be closed in order
            with contextlib.suppress(DeviceError, OSError):
                self._renderer.close()
        self._renderer = None

    def _use(self, work: Callable[[StimulusRenderer], Result]) -> Result:
        if self._renderer is None:
            raise RendererLostError("it went away before")
        try:
            return work(self._renderer)
        except DeviceError as error:
            self.drop()
            raise RendererLostError(str(error)) from None


class TrialWatch:
    """Observes one trial after the other. clock : wall time in seconds."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._shown_s = clock()
        self._switches: list[tuple[float, str]] = []

    @property
    def felt(self) -> bool:
        """Whether any label was rendered since the trial was shown."""
        return bool(self._switches)

    def begin(self) -> None:
        self._shown_s, self._switches = self._clock(), []

    def gone_to(self, label: str) -> None:
        self._switches.append((self._since_s(), label))

    def whole(self, answer: TrialAnswer, evidence: SealedTrial) -> TrialAnswer:
        """Return an answer with what it lacks filled in: switches, presses, time."""
        return msgspec.structs.replace(
            answer,
            switches=answer.switches or tuple(self._switches),
            presses=answer.presses or {one.label: one.presses for one in evidence.rendered},
            time_s=round(answer.time_s or self._since_s(), 2),
        )

    def _since_s(self) -> float:
        return round(self._clock() - self._shown_s, 2)
