"""What is pressed live: a model or a program on a simulated rig, ready to run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cache

import numpy as np

from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.method import Tuning
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import MODEL_SUFFIX, builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.program.button import button_program
from fdvv.program.check import require_accepted
from fdvv.program.compensate import commands, loop_targets
from fdvv.program.compile import compile_program
from fdvv.program.condition import When
from fdvv.program.program import Program, Signal
from fdvv.program.surface import Limits
from fdvv.program.surface import Surface as ProgramSurface
from fdvv.protocol.tables import ForceLoopGains, Settings
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.program_render import tuning_with
from fdvv.rendering.tuning import settings_with
from fdvv.twin.files import FIRST_RIG, load_finger, load_rig
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv.twin.settings import cell_of, settings_of
from fdvv.units import FloatArray, cN_from_N
from fdvv_studio.library.catalog import BUTTONS, Catalog
from fdvv_studio.live.press_trace import PressTrace, synthetic_traces
from fdvv_studio.project.programs import ProgramCatalog

IDEAL_RIG = "ideal"
PRESS_RIGS = (FIRST_RIG, "light", "paper")
"""Shipped rigs that one may choose between; intended renders on the ideal one."""
TABLES_RIG = "paper"
"""Renders what was learned without a force loop, where nothing says on which rig: as in earlier versions."""

TEACHER = "mx-clear"
"""The button whose presses identify a rig."""

TAUGHT_mm_s, RENDERED_mm_s = (50.0, 100.0, 150.0, 200.0), (10.0, 50.0, 100.0, 150.0, 200.0)
"""The first are the paper's; the others add a slow press, since a hand on the page may creep (assumed)."""
STEP_mm = 0.02  # a clicky switch falls within 50 um (docs/explanation/library.md): a coarser step blunts it


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
    description : one sentence for people: how this button is rendered.
    image, settings, rig, finger : what runs. loop : gains of its force loop; None where that is open.
    travel_mm : displacement at the bottom stop.
    actuation_mm, reset_mm : where a plain button's key goes down and up; None of a program.
    marks : places of the stroke, those two or the places of a program's transitions.
    states : names by the number that the firmware tells.
    signals : what the vibration board plays, by slot.
    press, release : the force as it is meant in the start state.
    has_timers : it does something by time alone, with nobody at it.
    """

    name: str
    mode: PressMode
    rig_name: str
    description: str
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
    loop: ForceLoopGains | None = None
    has_timers: bool = False

    @property
    def displacement_mm(self) -> FloatArray:
        """Return places from the top to the stop, (n,)."""
        return np.linspace(0.0, self.travel_mm, 1 + max(2, round(self.travel_mm / STEP_mm)))

    def target_cN(self, velocity_mm_s: float) -> tuple[FloatArray, FloatArray]:
        """Return press and release as they are meant in a press at a speed, (n,) each."""
        press, release = (
            surface.force_along_cN(self.displacement_mm, velocity_mm_s)
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
    learned = compensate_for_rig(_pressable(model), name) if mode is PressMode.COMPENSATED else None
    return _of_model(model, mode, name, rig, learned, _description(mode, name))


def rig_subject(model: FDVVModel, learned: CompensationResult, rig_name: str) -> PressSubject:
    """Make a model ready as a rig was compensated for it. Raises InputError as model_subject does.

    What was learned with the force loop is rendered on FIRST_RIG if the named rig has no load cell.
    """
    if learned.outcome.tuning.loop and not load_rig(rig_name).has_cell:
        rig_name = FIRST_RIG
    description = f"on the simulated rig {rig_name!r}, by an actuation learned before"
    mode = PressMode.COMPENSATED
    return _of_model(model, mode, *_rig(mode, rig_name), learned, description)


def _pressable(model: FDVVModel) -> FDVVModel:
    if not model.of(Stroke.PRESS):
        raise InputError(model.name, "curves", "it has no press to feel", "merge one into it")
    return model


def _of_model(
    model: FDVVModel,
    mode: PressMode,
    rig_name: str,
    rig: Rig,
    learned: CompensationResult | None,
    description: str,
) -> PressSubject:
    program = button_program(_pressable(model), learned.surface if learned else None)
    tuning = learned.outcome.tuning if learned else Tuning()
    subject = _subject(program, mode, rig_name, rig, tuning, description, learned is not None)
    meant = button_program(model)
    down, up = (state.transitions[0].when.value for state in meant.states)
    marks = (PressMark("actuation", down), PressMark("reset", up))
    press, release = _surfaces(meant)
    return replace(subject, actuation_mm=down, reset_mm=up, marks=marks, press=press, release=release)


def program_subject(
    program: Program, mode: PressMode = PressMode.INTENDED, rig_name: str = PRESS_RIGS[0]
) -> PressSubject:
    """Make a program ready to be pressed. Raises InputError on an unknown rig or a program that is refused.

    Compensated, its rig looks ahead and pushes against its own forces, and its tables are this rig's
    commands; with a load cell they are the targets of its force loop.
    """
    require_accepted(program)
    name, rig = _rig(mode, rig_name)
    description = _description(mode, name, program=True)
    if mode is not PressMode.COMPENSATED:
        return _subject(program, mode, name, rig, Tuning(), description)
    known, cell = identify_shipped_rig(name), cell_of(rig)
    gains = force_loop_gains(known.rig, cell, rig.controller.tick_s) if cell else None
    tuning = tuning_with(known, program.travel_mm, gains)
    made = loop_targets(program) if cell else commands(program, known, rig_limits(rig).force_cN)
    subject = _subject(made, mode, name, rig, tuning, description, learned=True)
    press, release = _surfaces(program)
    return replace(subject, press=press, release=release)


@cache
def identify_shipped_rig(rig_name: str) -> LearnedRig:
    """Return a shipped rig identified from simulated presses on TEACHER, 4 or 16; once per process."""
    device = TwinDevice(load_rig(rig_name), load_finger("paper"), seed=1)
    # the loop's errors are left as they are, what it learns on one button is not carried to another
    law = RigAware(rounds=0) if device.load_cell else RigAware()
    learned = compensate(device, load_builtin(TEACHER), TAUGHT_mm_s, law).learned_rig
    assert learned is not None  # the method keeps one
    return learned


def compensate_for_rig(model: FDVVModel, rig_name: str) -> CompensationResult:
    """Compensate a model for a shipped rig known before, without a press. Raises InputError, DeviceError."""
    law = RigAware(rounds=0, learned_rig=identify_shipped_rig(rig_name))
    return compensate(TwinDevice(load_rig(rig_name)), model, RENDERED_mm_s, law)


def _rig(mode: PressMode, rig_name: str) -> tuple[str, Rig]:
    if rig_name not in PRESS_RIGS:
        remedy = f"use one of: {', '.join(PRESS_RIGS)}"
        raise InputError("rig", "name", f"none is called {rig_name!r}", remedy)
    name = IDEAL_RIG if mode is PressMode.INTENDED else rig_name
    return name, load_rig(name)


def rig_limits(rig: Rig, learned: bool = False) -> Limits:
    """Return what a program is compiled with for this rig; learned forces carry the weight already."""
    mover = rig.mover
    weight_cN = 0.0 if learned else float(cN_from_N(mover.mass_kg * mover.gravity_m_s2))
    return Limits(settings=settings_of(rig), mass_kg=mover.mass_kg, weight_cN=weight_cN)


def _subject(
    program: Program,
    mode: PressMode,
    rig_name: str,
    rig: Rig,
    tuning: Tuning,
    description: str,
    learned: bool = False,
) -> PressSubject:
    try:
        settings = settings_with(settings_of(rig), tuning)
    except ModelError as error:
        raise InputError(program.name, "rig", str(error), "choose another rig") from error
    return PressSubject(
        program.name,
        mode,
        rig_name,
        description,
        compile_program(program, rig_limits(rig, learned)).image,
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
        tuning.loop,
        _has_timers(program),
    )


def _surfaces(program: Program) -> tuple[ProgramSurface, ProgramSurface]:
    start = program.state(program.start)
    return program.surface(start.press), program.surface(start.release)


def _has_timers(program: Program) -> bool:
    ways = (way for state in program.states for way in state.transitions)
    waits = any(When.AFTER in {condition.when for condition in way.conditions} for way in ways)
    return waits or any(state.repeat_ms or state.bias_ms for state in program.states)


def _marks(program: Program) -> tuple[PressMark, ...]:
    return tuple(
        PressMark(f"{state.name} → {way.to}", way.when.value)
        for state in program.states
        for way in state.transitions
        if way.when.when in (When.DEEPER_THAN, When.SHALLOWER_THAN)
    )


def _description(mode: PressMode, rig_name: str, program: bool = False) -> str:
    if mode is PressMode.INTENDED:
        parts = "a simulated rig of perfect parts (cap of 1 g, no weight, no friction)"
        return f"as intended: {parts}; vibrations are heard, not felt"
    if mode is PressMode.RENDERED:
        return f"on the simulated rig {rig_name!r}, not compensated: its own forces come on top"
    if load_rig(rig_name).has_cell:
        how = "which holds the force at the finger with its loop of 10 kHz"
        return f"on the simulated rig {rig_name!r}, {how}; identified from presses on {TEACHER}"
    if program:
        return f"on the simulated rig {rig_name!r}, which looks ahead and pushes against its own forces"
    return f"on the simulated rig {rig_name!r}, compensated after 16 presses on {TEACHER}"


TRY = {
    "shipped:button": "Press it as any key: compare the others with this one.",
    "shipped:dwell-ticks": "Hold it at the bottom and count the ticks with your finger.",
    "shipped:fast-tapping": "Push past 1 mm and let it take over: it drops, kicks back and is ready again.",
    "shipped:multi-level": "Sink slowly and stop at each click: three key levels lie on the way.",
    "shipped:non-newtonian": "Press gently, then hit it: the faster, the stiffer.",
    "shipped:rapid-trigger": "Stay deep and waggle by a few tenths of a millimetre: up and down each time.",
    "shipped:returning-later": "Press once and let go: it stays down for a second and a half.",
}
"""What to do with each shipped program, in one line."""


@dataclass(frozen=True)
class PressChoice:
    """Something to press: its id, its name for people, and what to try."""

    id: str
    name: str
    hint: str


def button_choices(shelf: Catalog) -> tuple[PressChoice, ...]:
    """List the built-in buttons and the person's own."""
    files = (shelf.project / BUTTONS).glob(f"*{MODEL_SUFFIX}")
    own = sorted(path.name.removesuffix(MODEL_SUFFIX) for path in files)
    return (
        *(PressChoice(f"builtin:{name}", name, "built-in") for name in builtin_names()),
        *(PressChoice(f"own:{name}", name, "your own") for name in own),
    )


def program_choices(shelf: ProgramCatalog) -> tuple[PressChoice, ...]:
    """List the shipped programs and the person's own, but for files that cannot be read."""
    return tuple(
        PressChoice(entry.id, entry.name, TRY.get(entry.id, entry.summary))
        for entry in shelf.entries()
        if not entry.problem
    )


def trace_by_name(name: str) -> PressTrace:
    """Return a shipped trace by its name. Raises InputError."""
    for trace in synthetic_traces():
        if trace.name == name:
            return trace
    raise InputError("trace", name, "no such trace", "choose one from the list")
