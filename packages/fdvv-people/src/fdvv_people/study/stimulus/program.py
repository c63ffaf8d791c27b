"""All labels of a trial in one program: a device changes between them by host events of one length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fdvv.compensation.method import UNTUNED, Tuning
from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.program.button import button_program
from fdvv.program.compile import compile_program
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import Program, Signal, State, Velocity, VibrationEvent
from fdvv.program.render_vibration import converter
from fdvv.program.surface import Limits, Surface, flat
from fdvv.vibration.exciter import KnownExciter
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.renderer import stimulus_actuation, stimulus_model

IntArray = npt.NDArray[np.int64]
REST_cN, REST_FADE_ms = 40.0, 50
"""Force that brings the cap up between two labels."""
LABELS = 7
"""Most labels that the states and surfaces of a device can hold."""
REST = "rest"
GOES_TO_REST = Transition(REST, Condition(When.HOST_EVENT, 0))


@dataclass(frozen=True, eq=False)
class TrialProgram:
    """The labels of a trial as a device holds them.

    Attributes
    ----------
    labels : in the order of their names. models : what each is meant to feel like.
    image : the program. tuning : under which it is rendered, the same for all labels.
    """

    labels: tuple[str, ...]
    models: tuple[FDVVModel, ...]
    image: bytes
    tuning: Tuning

    def event(self, label: str) -> int:
        """Return the number of the host event that leads from rest to a label; 0 leads back."""
        return 1 + self.labels.index(label)

    def places(self, state: IntArray) -> IntArray:
        """Return the label that each state that the device reports belongs to, by place; -1 at rest."""
        # state 0 is rest; every label has two states after it: key up, key down
        return np.where(state == 0, -1, (state - 1) // 2)


def trial_program(
    labels: Mapping[str, Stimulus], folder: Path, limits: Limits, exciter: KnownExciter | None = None
) -> TrialProgram:
    """Write the labels of a trial into one program. Raises InputError if a device cannot hold them together.

    exciter : if it is known, vibrations are played through its inverse.
    """
    names = tuple(sorted(labels))
    parts = [_part(labels[name], folder, limits.weight_cN, place) for place, name in enumerate(names)]
    tuning = _one_tuning([part.tuning for part in parts])
    try:
        joined = _joined(parts, limits.weight_cN)
    except ModelError as error:
        raise InputError("trial", "labels", str(error), "choose other buttons") from error
    convert = converter(exciter) if exciter else None
    image = compile_program(joined, replace(limits, weight_cN=0.0), convert).image
    return TrialProgram(names, tuple(part.model for part in parts), image, tuning)


@dataclass(frozen=True, eq=False)
class _Part:
    """One label of a program: its own button's program under names of its own."""

    model: FDVVModel
    tuning: Tuning
    states: tuple[State, ...]
    surfaces: tuple[Surface, ...]
    signals: tuple[Signal, ...]
    vibrations: tuple[VibrationEvent, ...]


def _part(stimulus: Stimulus, folder: Path, weight_cN: float, place: int) -> _Part:
    model = stimulus_model(stimulus, folder)
    learned = stimulus_actuation(stimulus, folder, model) if stimulus.actuation else None
    program = button_program(model, learned.surface if learned else None)
    tuning = learned.outcome.tuning if learned else UNTUNED
    # what was learned on the rig carries the cap's weight already
    carried_cN = 0.0 if learned else weight_cN
    press, release = (
        _carried(surface, f"{place} {stroke}", carried_cN)
        for surface, stroke in zip(program.surfaces, Stroke, strict=True)
    )
    source = Velocity.ANNOUNCED if tuning.paced else Velocity.DECIDED
    states = tuple(
        replace(
            state,
            name=f"{place} {state.name}",
            press=press.name,
            release=release.name,
            transitions=(GOES_TO_REST, *(replace(t, to=f"{place} {t.to}") for t in state.transitions)),
            velocity=source,
        )
        for state in program.states
    )
    signals = tuple(replace(one, name=f"{place} {one.name}") for one in program.signals)
    events = tuple(
        replace(one, signal=f"{place} {one.signal}", states=tuple(state.name for state in states))
        for one in program.vibrations
    )
    return _Part(model, tuning, states, (press, release), signals, events)


def _carried(surface: Surface, name: str, weight_cN: float) -> Surface:
    rows = tuple(tuple(force + weight_cN for force in row) for row in surface.force_cN)
    return replace(surface, name=name, force_cN=rows)


def _joined(parts: list[_Part], weight_cN: float) -> Program:
    """Put the parts behind a state of rest. ModelError if their travels differ."""
    travels = {part.model.travel_mm for part in parts}
    if len(travels) > 1:
        found = ", ".join(f"{travel:g}" for travel in sorted(travels))
        raise ModelError(f"their travels differ ({found} mm): the stop would be heard to move")
    if len(parts) > LABELS:
        raise ModelError(f"{len(parts)} of them, a device holds {LABELS} at once")
    transitions = tuple(
        Transition(part.states[0].name, Condition(When.HOST_EVENT, 1 + place))
        for place, part in enumerate(parts)
    )
    rest = State(REST, REST, REST, transitions, fade_ms=REST_FADE_ms)
    return Program(
        "trial",
        travels.pop(),
        REST,
        (rest, *(state for part in parts for state in part.states)),
        (flat(REST, REST_cN + weight_cN), *(surface for part in parts for surface in part.surfaces)),
        tuple(signal for part in parts for signal in part.signals),
        tuple(event for part in parts for event in part.vibrations),
    )


def _one_tuning(tunings: list[Tuning]) -> Tuning:
    bare = {replace(tuning, paced=False) for tuning in tunings}
    if len(bare) > 1:
        reason = "they were learned under different tunings, which a device cannot change between two presses"
        raise InputError("trial", "actuations", reason, "learn all of them on the rig with one method")
    return bare.pop()
