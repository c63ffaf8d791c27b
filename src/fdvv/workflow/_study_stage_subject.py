"""A stimulus on the twin: what is meant, and what runs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.model import FDVVModel, ForceSurface
from fdvv.study import Stimulus
from fdvv.twin import LedTicks
from fdvv.workflow._actuation_file import load_actuation
from fdvv.workflow._compensate import CompensationResult
from fdvv.workflow._live_event import LiveEvent, LiveEventKind
from fdvv.workflow._live_press import LivePress, PACE_mm_s
from fdvv.workflow._press_subject import IDEAL_RIG, PRESS_RIGS, PressSubject, learned_subject, model_subject
from fdvv.workflow._study_files import study_file
from fdvv.workflow._study_stage import stimulus_model
from fdvv.workflow._study_stage_evidence import StageEvidence, fault_name


@dataclass(frozen=True, eq=False)
class StagedStimulus:
    """A stimulus ready to be pressed on the twin. Simulated.

    Attributes
    ----------
    name : of the stimulus. model : what it is meant to feel like. subject : what runs.
    audible : its vibrations reach the finger, or on the ideal rig, which has no exciter, the ear.
    """

    name: str
    model: FDVVModel
    subject: PressSubject
    audible: bool


def staged(
    stimulus: Stimulus, folder: Path, rig_name: str = PRESS_RIGS[0], model: FDVVModel | None = None
) -> StagedStimulus:
    """Make a stimulus ready: ideally, or with its actuation on the rig that is named. Raises InputError.

    model : what `stimulus_model` gave of it, if that was asked for before.
    """
    model = model or stimulus_model(stimulus, folder)
    if not stimulus.actuation:
        subject = _ideal(model)
    else:
        learned = stimulus_actuation(stimulus, folder, model)
        subject = learned_subject(model, learned, rig_name)
    return StagedStimulus(stimulus.name, model, subject, _audible(subject))


@lru_cache(maxsize=256)
def _ideal(model: FDVVModel) -> PressSubject:
    return model_subject(model)


def stimulus_actuation(stimulus: Stimulus, folder: Path, model: FDVVModel) -> CompensationResult:
    """Give what a rig was compensated with for a stimulus, its forces in the stimulus's ratio.

    What compensation added stays as it was learned; only the model's own part of the force is multiplied.
    Raises InputError.
    """
    learned = load_actuation(study_file(folder, stimulus.actuation))
    if abs(learned.travel_mm - model.travel_mm) > 1e-6:
        reason = f"was learned for a travel of {learned.travel_mm:g} mm, {model.name} has {model.travel_mm:g}"
        raise InputError(stimulus.actuation, "$.travel_mm", reason, "learn it again for this button")
    if stimulus.force_ratio == 1.0:
        return learned
    surface = learned.surface
    step_mm = float(surface.displacement_mm[1] - surface.displacement_mm[0])
    own = ForceSurface.of_model(model, surface.velocity_mm_s, step_mm)
    part = 1 - 1 / stimulus.force_ratio
    if own.press_cN.shape != surface.press_cN.shape:
        reason = "its places are none that a force ratio can be put on"
        raise InputError(stimulus.actuation, "$.displacement_mm", reason, "learn it again for this button")
    scaled = replace(
        surface,
        press_cN=surface.press_cN + part * own.press_cN,
        release_cN=surface.release_cN + part * own.release_cN,
    )
    return replace(learned, outcome=replace(learned.outcome, surface=scaled))


def keep(
    evidence: StageEvidence,
    of: StagedStimulus,
    press: LivePress,
    columns: LedTicks,
    events: tuple[LiveEvent, ...],
) -> str:
    """Keep what the rig did; if it found a fault, a warning among them, end its force and name it.

    No number goes with the name: force and place of a fault could tell which label hid what.
    """
    evidence.take(columns.t_s, columns.displacement_mm, columns.force_cN)
    evidence.played(of.audible * sum(event.kind is LiveEventKind.VIBRATION for event in events))
    found = press.fault()
    if not found.faults:
        return ""
    evidence.failed(found.fault)
    press.rig.core.disarm()
    return f"the twin fell to zero force: {fault_name(found.fault)}"


def announce(press: LivePress, velocity_mm_s: float) -> None:
    """Have the next press expected at the speed of the last one, whatever that was on; 0: none was."""
    if velocity_mm_s:
        press.rig.announce(float(np.clip(velocity_mm_s, *PACE_mm_s)))


def _audible(subject: PressSubject) -> bool:
    exciter = subject.rig.exciter
    shakes = exciter.fitted == "yes" and exciter.drive_V * exciter.motor_N_A > 0
    return subject.rig_name == IDEAL_RIG or shakes
