"""What is pressed live: a model or a program on a simulated rig, ready to run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cache

import numpy as np

from fdvv.compensate import RigAware, RigMemory, Tuning, tuning_of
from fdvv.device import TwinDevice
from fdvv.errors import InputError, ModelError
from fdvv.model import FDVVModel, Stroke, load_builtin
from fdvv.program import Limits, Program, Signal, When, button_program, compile_program, require_accepted
from fdvv.program import Surface as ProgramSurface
from fdvv.protocol import Settings
from fdvv.twin import Finger, Rig, load_finger, load_rig, settings_of
from fdvv.units import FloatArray, cN_from_N
from fdvv.workflow._compensate import CompensationResult, compensate
from fdvv.workflow._tuning import settings_with

IDEAL_RIG = "ideal"
PRESS_RIGS = ("paper", "light")
"""Shipped rigs that one may choose between; what is felt as intended is felt on the ideal one."""
TEACHER = "mx-clear"
"""The button whose presses teach a rig what every other one is compensated with."""
TAUGHT_mm_s, RENDERED_mm_s = (50.0, 100.0, 150.0, 200.0), (10.0, 50.0, 100.0, 150.0, 200.0)
STEP_mm = 0.02


class PressMode(StrEnum):
    """How a button is brought to the finger.

    intended : on a rig of perfect parts, so that the finger feels the model's own force.
    compensated : on a real rig's parts, by what its firmware and a table make of a rig known before.
    rendered : on the same rig by the model's own force, which the rig's own forces come on top of.
    """

    INTENDED = "intended"
    COMPENSATED = "compensated"
    RENDERED = "rendered"


@dataclass(frozen=True)
class PressMark:
    """A place in the stroke that a reader wants to see: what happens there, and where (mm)."""

    label: str
    place_mm: float


@dataclass(frozen=True, eq=False)
class PressSubject:
    """What a live press runs: an image on a rig, and what may be known of it beforehand. Simulated.

    Attributes
    ----------
    name, mode, rig_name : what is pressed, how, on which shipped rig.
    told : one sentence for the page: what is between this button and the finger.
    image, settings, rig, finger : what runs.
    travel_mm : where the bottom stop stands.
    actuation_mm, reset_mm : where a plain button's key goes down and up; None of a program.
    marks : places of the stroke, those two or the places of a program's transitions.
    states : names by the number that the firmware tells.
    signals : what the vibration board plays, by slot.
    press, release : the force as it is meant in the start state.
    """

    name: str
    mode: PressMode
    rig_name: str
    told: str
    image: bytes
    settings: Settings
    rig: Rig
    finger: Finger
    travel_mm: float
    actuation_mm: float | None
    reset_mm: float | None
    marks: tuple[PressMark, ...]
    states: tuple[str, ...]
    signals: tuple[Signal, ...]
    press: ProgramSurface
    release: ProgramSurface

    @property
    def displacement_mm(self) -> FloatArray:
        """Give places from the top to the stop, (n,)."""
        return np.linspace(0.0, self.travel_mm, 1 + max(2, round(self.travel_mm / STEP_mm)))

    def meant_cN(self, velocity_mm_s: float) -> tuple[FloatArray, FloatArray]:
        """Give press and release as they are meant in a press at a speed, (n,) each."""
        places = self.displacement_mm.tolist()
        press, release = (
            np.array([surface.force_at_cN(place, velocity_mm_s) for place in places])
            for surface in (self.press, self.release)
        )
        return press, release


def model_subject(
    model: FDVVModel, mode: PressMode = PressMode.INTENDED, rig_name: str = PRESS_RIGS[0]
) -> PressSubject:
    """Make a model ready to be pressed. Raises InputError on an unknown rig or a model without a press.

    rig_name : one of PRESS_RIGS; what is intended is felt on the ideal rig whatever is named.
    """
    name, rig = _rig(mode, rig_name)
    learned = known_rendering(_pressable(model), name) if mode is PressMode.COMPENSATED else None
    return _of_model(model, mode, name, rig, learned)


def learned_subject(model: FDVVModel, learned: CompensationResult, rig_name: str) -> PressSubject:
    """Make a model ready as a rig was compensated for it. Raises InputError as model_subject does."""
    mode = PressMode.COMPENSATED
    subject = _of_model(model, mode, *_rig(mode, rig_name), learned)
    return replace(subject, told=f"on the simulated rig {rig_name!r}, by an actuation learned before")


def _pressable(model: FDVVModel) -> FDVVModel:
    if not model.of(Stroke.PRESS):
        raise InputError(model.name, "curves", "it has no press to feel", "merge one into it")
    return model


def _of_model(
    model: FDVVModel, mode: PressMode, rig_name: str, rig: Rig, learned: CompensationResult | None
) -> PressSubject:
    program = button_program(_pressable(model), learned.surface if learned else None)
    limits = rig_limits(rig, learned is not None)
    tuning = learned.outcome.tuning if learned else Tuning()
    meant = button_program(model)
    down, up = (state.transitions[0].when.value for state in meant.states)
    subject = _subject(program, mode, rig_name, rig, limits, tuning, _told(mode, rig_name))
    marks = (PressMark("actuation", down), PressMark("reset", up))
    press, release = _surfaces(meant)
    return replace(subject, actuation_mm=down, reset_mm=up, marks=marks, press=press, release=release)


def program_subject(
    program: Program, mode: PressMode = PressMode.INTENDED, rig_name: str = PRESS_RIGS[0]
) -> PressSubject:
    """Make a program ready to be pressed. Raises InputError on an unknown rig or a program that is refused.

    Compensated, its rig looks ahead and pushes against its own forces; its tables are the program's own.
    """
    require_accepted(program)
    name, rig = _rig(mode, rig_name)
    tuning = Tuning()
    if mode is PressMode.COMPENSATED:
        law = RigAware()
        known = rig_memory(name).known
        tuning = tuning_of(known, program.travel_mm, law.bandwidth_Hz, law.friction_mm_s)
    told = _told(mode, name, program=True)
    return _subject(program, mode, name, rig, rig_limits(rig), tuning, told)


@cache
def rig_memory(rig_name: str) -> RigMemory:
    """Give what a shipped rig teaches in 16 simulated presses on TEACHER; learned once per process."""
    device = TwinDevice(load_rig(rig_name), load_finger("paper"), seed=1)
    memory = compensate(device, load_builtin(TEACHER), TAUGHT_mm_s, RigAware()).memory
    assert memory is not None  # the method keeps one
    return memory


def known_rendering(model: FDVVModel, rig_name: str) -> CompensationResult:
    """Compensate a model for a shipped rig known before, without a press. Raises InputError, DeviceError."""
    law = RigAware(rounds=0, memory=rig_memory(rig_name))
    return compensate(TwinDevice(load_rig(rig_name)), model, RENDERED_mm_s, law)


def _rig(mode: PressMode, rig_name: str) -> tuple[str, Rig]:
    if rig_name not in PRESS_RIGS:
        remedy = f"use one of: {', '.join(PRESS_RIGS)}"
        raise InputError("rig", "name", f"none is called {rig_name!r}", remedy)
    name = IDEAL_RIG if mode is PressMode.INTENDED else rig_name
    return name, load_rig(name)


def rig_limits(rig: Rig, learned: bool = False) -> Limits:
    """Give what a program is compiled with for this rig; learned forces carry the weight already."""
    mover = rig.mover
    weight_cN = 0.0 if learned else float(cN_from_N(mover.mass_kg * mover.gravity_m_s2))
    return Limits(settings=settings_of(rig), mass_kg=mover.mass_kg, weight_cN=weight_cN)


def _subject(
    program: Program, mode: PressMode, rig_name: str, rig: Rig, limits: Limits, tuning: Tuning, told: str
) -> PressSubject:
    try:
        settings = settings_with(settings_of(rig), tuning)
    except ModelError as error:
        raise InputError(program.name, "rig", str(error), "choose another rig") from error
    return PressSubject(
        program.name,
        mode,
        rig_name,
        told,
        compile_program(program, limits).image,
        settings,
        rig,
        load_finger("paper"),
        program.travel_mm,
        None,
        None,
        _marks(program),
        tuple(state.name for state in program.states),
        program.signals,
        *_surfaces(program),
    )


def _surfaces(program: Program) -> tuple[ProgramSurface, ProgramSurface]:
    """Give press and release of the start state."""
    start = program.state(program.start)
    return program.surface(start.press), program.surface(start.release)


def _marks(program: Program) -> tuple[PressMark, ...]:
    """Give the places at which states change."""
    return tuple(
        PressMark(f"{state.name} → {way.to}", way.when.value)
        for state in program.states
        for way in state.transitions
        if way.when.when in (When.DEEPER_THAN, When.SHALLOWER_THAN)
    )


def _told(mode: PressMode, rig_name: str, program: bool = False) -> str:
    if mode is PressMode.INTENDED:
        return (
            "as intended: a simulated rig of perfect parts (cap of 1 g, no weight, no friction); vibrations "
            "are heard, not felt"
        )
    if mode is PressMode.RENDERED:
        return f"on the simulated rig {rig_name!r}, not compensated: its own forces come on top"
    if program:
        return f"on the simulated rig {rig_name!r}, which looks ahead and pushes against its own forces"
    return f"on the simulated rig {rig_name!r}, compensated from what 16 presses on {TEACHER} taught of it"
