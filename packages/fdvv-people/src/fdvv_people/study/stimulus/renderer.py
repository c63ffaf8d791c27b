"""Render the stimuli of a trial: the interface, equally long switches, and a stimulus on the twin."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Protocol

import numpy as np

from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model.file import builtin_names, load_builtin, load_model
from fdvv.model.magnify import magnify
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.actuation_file import load_actuation
from fdvv.rendering.compensate import CompensationResult
from fdvv.rendering.probe import fd_only
from fdvv.twin.interactive import InteractiveTicks
from fdvv_people.study.files.layout import study_file
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.plan.trial import Rendered
from fdvv_people.study.stimulus.evidence import RenderingEvidence, fault_name
from fdvv_studio.live.press import LiveEvent, LiveEventKind, LivePress, PACE_mm_s
from fdvv_studio.live.press_subject import IDEAL_RIG, TABLES_RIG, PressSubject, model_subject, rig_subject

WORK_s = 0.05
"""Before the end of a switch, when its second half begins, which takes some milliseconds."""

CLOCK_s = 1e-6  # above the rounding of a clock's differences; at 0 a switch on time could take twice as long


class StimulusRenderer(Protocol):
    """Renders labels, one at a time, and records what was physically rendered.

    Errors are DeviceError in one line: the force is zero then, and the record can still be read. To be used
    from one thread at a time.
    """

    @property
    def simulated(self) -> bool:
        """Whether the rig is a simulated one; says nothing of who presses."""

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Prepare the stimulus of each label, and clear the record; no label is shown.

        Raises InputError on a stimulus that cannot be rendered, DeviceError.
        """

    def show(self, label: str) -> None:
        """Render a label from now on; takes equally long, whichever it is and whichever was before.

        Raises InputError on a label that was not prepared, DeviceError.
        """

    def rendered(self) -> tuple[Rendered, ...]:
        """Return the record since prepare(), one for every label, in the order of their names."""

    def close(self) -> None:
        """Fall to zero force and release the rig; idempotent."""


class ConstantTimeSwitch:
    """Makes every switch between labels take equally long, whatever is done in it.

    switch_s : from request to end; where the work alone takes longer, the next whole multiple of it.
    clock, sleep : of time.
    """

    def __init__(
        self,
        switch_s: float,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.switch_s, self._clock, self._sleep = switch_s, clock, sleep
        self._work_s = min(WORK_s, switch_s / 4)

    def make(self, before: Callable[[], None], after: Callable[[], None] = lambda: None) -> None:
        """Do the first at once, the second near the end of the time; an error does not shorten it."""
        began_s = self._clock()
        try:
            before()
            self._wait(began_s, self.switch_s - self._work_s)
            after()
        finally:
            worked_s = self._clock() - began_s
            late = worked_s > self.switch_s + CLOCK_s
            whole = math.ceil(worked_s / self.switch_s) if late and self.switch_s else 1
            self._wait(began_s, whole * self.switch_s)

    def _wait(self, began_s: float, until_s: float) -> None:
        self._sleep(max(0.0, began_s + until_s - self._clock()))


def stimulus_model(stimulus: Stimulus, folder: Path) -> FDVVModel:
    """Return the model that a stimulus intends: its button, reduced to FD if it says so, grown in its ratios.

    folder : of the study; a button that is not built in is a file in it or in its ``buttons``.
    Raises InputError.
    """
    if stimulus.button in builtin_names():
        model = load_builtin(stimulus.button)
    else:
        model = load_model(study_file(folder, stimulus.button))
    model = fd_only(model) if stimulus.rendered == "FD" else model
    try:
        return _magnify(model, stimulus.force_ratio, stimulus.snap_ratio, stimulus.vibration_ratio)
    except ModelError as error:
        remedy = "choose another button, or leave this dimension out"
        raise InputError(stimulus.name, stimulus.button, str(error), remedy) from error


_magnify = lru_cache(maxsize=256)(magnify)


def check_label(label: str, labels: Mapping[str, object]) -> None:
    """Raise InputError on a label that was not prepared."""
    if label not in labels:
        known = ", ".join(sorted(labels)) or "none"
        raise InputError("label", label, "is none of this trial", f"use one of: {known}")


@dataclass(frozen=True, eq=False)
class PreparedStimulus:
    """A stimulus prepared on the twin. Simulated.

    Attributes
    ----------
    name : of the stimulus. model : that is intended. subject : what runs.
    audible : its vibrations reach the finger, or on the ideal rig, which has no exciter, the ear.
    """

    name: str
    model: FDVVModel
    subject: PressSubject
    audible: bool


def prepare_stimulus(
    stimulus: Stimulus, folder: Path, rig_name: str = TABLES_RIG, model: FDVVModel | None = None
) -> PreparedStimulus:
    """Prepare a stimulus: rendered ideally, or with its actuation on the named rig. Raises InputError.

    model : of `stimulus_model`, if it is known.
    """
    model = model or stimulus_model(stimulus, folder)
    if not stimulus.actuation:
        subject = _ideal(model)
    else:
        learned = stimulus_actuation(stimulus, folder, model)
        subject = rig_subject(model, learned, rig_name)
    return PreparedStimulus(stimulus.name, model, subject, _audible(subject))


_ideal = lru_cache(maxsize=256)(model_subject)


def stimulus_actuation(stimulus: Stimulus, folder: Path, model: FDVVModel) -> CompensationResult:
    """Return the compensation of a rig for a stimulus, grown in the stimulus's ratios.

    What compensation added stays as it was learned; only the model's own part of the force grows.
    Raises InputError.
    """
    learned = load_actuation(study_file(folder, stimulus.actuation))
    if abs(learned.travel_mm - model.travel_mm) > 1e-6:
        reason = f"was learned for a travel of {learned.travel_mm:g} mm, {model.name} has {model.travel_mm:g}"
        raise InputError(stimulus.actuation, "$.travel_mm", reason, "learn it again for this button")
    if stimulus == stimulus.unchanged:
        return learned
    surface = learned.surface
    step_mm = float(surface.displacement_mm[1] - surface.displacement_mm[0])
    before, after = (
        ForceSurface.of_model(one, surface.velocity_mm_s, step_mm)
        for one in (stimulus_model(stimulus.unchanged, folder), model)
    )
    if after.press_cN.shape != surface.press_cN.shape:
        reason = "its places are none that a ratio can be put on"
        raise InputError(stimulus.actuation, "$.displacement_mm", reason, "learn it again for this button")
    scaled = replace(
        surface,
        press_cN=surface.press_cN + after.press_cN - before.press_cN,
        release_cN=surface.release_cN + after.release_cN - before.release_cN,
    )
    return replace(learned, outcome=replace(learned.outcome, surface=scaled))


class EvidenceRenderer:
    """What renderers share: evidence of every label, and why the renderer has ended.

    Attributes
    ----------
    problem : in one line why the renderer has ended; "" while it has not.
    """

    def __init__(self) -> None:
        self.problem = ""
        self._evidence: dict[str, RenderingEvidence] = {}
        # evidence is taken in the thread of a rig, and read in another
        self._lock = Lock()

    def rendered(self) -> tuple[Rendered, ...]:
        """Return the record since prepare(); never fails, so that a fault is kept as well."""
        with self._lock:
            return tuple(found.rendered() for found in self._evidence.values())

    def _check(self) -> None:
        if self.problem:
            raise DeviceError(self.problem)


class TwinLabels(EvidenceRenderer):
    """The labels of a trial on the twin.

    rig_name : shipped rig for stimuli with an actuation; without one the ideal rig renders. seed : of
    everything random.
    """

    simulated = True

    def __init__(self, folder: Path, rig_name: str, seed: int) -> None:
        super().__init__()
        self._folder, self._rig_name = folder, rig_name
        self._random = np.random.default_rng(seed)
        self._prepared: dict[str, PreparedStimulus] = {}
        self._live: dict[str, LivePress] = {}
        self._pace_mm_s = 0.0

    def _prepare(self, labels: Mapping[str, Stimulus]) -> None:
        found = {
            name: prepare_stimulus(labels[name], self._folder, self._rig_name) for name in sorted(labels)
        }
        with self._lock:
            self._prepared = found
            self._evidence = {name: RenderingEvidence(name, of.name, of.model) for name, of in found.items()}

    def _announce(self, press: LivePress) -> None:
        """Announce the speed of the last press, on whichever label, for the next one."""
        if self._pace_mm_s:
            press.rig.announce(float(np.clip(self._pace_mm_s, *PACE_mm_s)))

    def _keep(
        self, label: str, press: LivePress, columns: InteractiveTicks, events: Sequence[LiveEvent]
    ) -> str:
        """Record what the rig did; on a fault, or a warning, end its force and return its name in one line.

        No number goes with the name: force and place of a fault could reveal what a label hides.
        """
        for event in events:
            if event.kind is LiveEventKind.PRESSED:
                self._pace_mm_s = event.velocity_mm_s
        heard = sum(event.kind is LiveEventKind.VIBRATION for event in events)
        with self._lock:
            evidence = self._evidence[label]
            evidence.take(columns.t_s, columns.displacement_mm, columns.force_cN)
            evidence.played(self._prepared[label].audible * heard)
            found = press.fault()
            if not found.faults:
                return ""
            evidence.failed(found.fault)
        press.rig.core.disarm()
        return f"the twin fell to zero force: {fault_name(found.fault)}"


def _audible(subject: PressSubject) -> bool:
    exciter = subject.rig.exciter
    shakes = exciter.fitted == "yes" and exciter.drive_V * exciter.motor_N_A > 0
    return subject.rig_name == IDEAL_RIG or shakes
