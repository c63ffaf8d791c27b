"""The shipped programs by name, with their parameters.

Buttons that no mechanism has, each over a base model: the five of the paper, and rapid trigger.
Button Simulation and Design via FDVV Models (CHI 2020), "Prototyping Innovative Buttons". What
each does is promised in its docstring and tested in tests/program/test_ideas.py.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path

from fdvv.errors import InputError
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Mode
from fdvv.program.button import (
    HOLD_mm,
    NEAR_BOTTOM_mm,
    button_program,
    check_ranges,
    key_points_mm,
    vibrations_of,
)
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.file import PROGRAM_SUFFIX, load_program, program_from_json
from fdvv.program.motion import Motion
from fdvv.program.program import Program, Signal, State, Velocity, VibrationEvent
from fdvv.program.surface import (
    Limits,
    RETURNING_cN,
    STEP_mm,
    Surface,
    flat,
    of_model,
    raised,
    returning,
    scaled,
)

BASE = "mx-red"
"""Base of the shipped programs by default: linear, so that nothing distracts."""


def _surfaces(base: FDVVModel) -> tuple[Surface, Surface]:
    return of_model(base, Stroke.PRESS), of_model(base, Stroke.RELEASE)


def _deeper(place_mm: float, to: str, signal: str | None = None) -> Transition:
    return Transition(to, Condition(When.DEEPER_THAN, round(place_mm, 4)), signal=signal)


def _shallower(place_mm: float, to: str) -> Transition:
    return Transition(to, Condition(When.SHALLOWER_THAN, round(place_mm, 4)))


def _after(time_ms: int, to: str) -> Transition:
    return Transition(to, Condition(When.AFTER, time_ms))


def _tick(name: str, frequency_Hz: float, amplitude_m_s2: float = 6.0) -> Signal:
    """Make a click of 12 ms that has died away by its end."""
    return Signal(name, 0.012, (Mode(frequency_Hz, amplitude_m_s2, 250.0),))


def _snaps(base: FDVVModel, *states: str) -> tuple[tuple[Signal, ...], tuple[VibrationEvent, ...]]:
    signals, events = vibrations_of(base)
    return signals, tuple(replace(event, states=states) for event in events)


def fast_tapping(
    base: FDVVModel,
    trigger_mm: float = 1.0,
    pull_cN: float = 30.0,
    push_cN: float = 120.0,
    drop_ms: int = 60,
) -> Program:
    """Drop to the bottom once a press is detected, and return by itself: for very fast tapping.

    Below trigger_mm the cap is pulled down with pull_cN, key 1, until it is 0.3 mm above the bottom or
    drop_ms are over; then it is pushed up with push_cN, key 0, and armed again at half of trigger_mm.
    """
    press, release = _surfaces(base)
    signals, events = _snaps(base, "ready")
    bottom_mm = base.travel_mm - NEAR_BOTTOM_mm
    dropped = (_deeper(bottom_mm, "returning"), _after(drop_ms, "returning"))
    states = (
        State("ready", press.name, release.name, (_deeper(trigger_mm, "dropping"),)),
        State("dropping", "pull", "pull", dropped, key=1),
        State("returning", "push", "push", (_shallower(trigger_mm / 2, "ready"),)),
    )
    surfaces = (press, release, flat("pull", -pull_cN), flat("push", push_cN))
    summary = f"Pressed {trigger_mm:g} mm deep it drops to the bottom and comes back by itself."
    return Program("fast-tapping", base.travel_mm, "ready", states, surfaces, signals, events, summary)


def non_newtonian(
    base: FDVVModel, soft_ratio: float = 0.6, stiffening_per_m_s: float = 5.0, fastest_mm_s: float = 300.0
) -> Program:
    """Be soft when pressed gently and stiff when pressed fast, at every instant of the press.

    The base's slowest press times (soft_ratio + stiffening_per_m_s * speed), the speed being found anew at
    every tick and held from fastest_mm_s on. The release is the base's times soft_ratio at any speed, so that
    the speed cannot push the cap up. Key 1 between the base's actuation and reset.
    """
    slow_press, slow_release = (of_model(base, s, velocity_mm_s=_slowest(base, s)) for s in Stroke)
    stiff_ratio = soft_ratio + stiffening_per_m_s * fastest_mm_s / 1000
    press = scaled(slow_press, "press", {0.0: soft_ratio, fastest_mm_s: stiff_ratio})
    release = scaled(slow_release, "release", {0.0: soft_ratio})
    actuation_mm, reset_mm = key_points_mm(base)
    signals, events = _snaps(base)
    both = (press.name, release.name)
    states = (
        State("up", *both, (_deeper(actuation_mm, "down"),), velocity=Velocity.CONTINUOUS),
        State("down", *both, (_shallower(reset_mm, "up"),), key=1, velocity=Velocity.CONTINUOUS),
    )
    summary = "Soft when pressed gently, stiff when pressed fast."
    return Program("non-newtonian", base.travel_mm, "up", states, (press, release), signals, events, summary)


def _slowest(base: FDVVModel, stroke: Stroke) -> tuple[float, ...]:
    serving = stroke if base.of(stroke) else Stroke.PRESS
    return base.velocities_mm_s(serving)[:1]


def multi_level(
    base: FDVVModel, levels: int = 3, detent_cN: float = 25.0, detent_mm: float = 0.32
) -> Program:
    """Divide the stroke into depths that can be distinguished, each with its key level.

    Level k of `levels` begins at k / (levels + 1) of the travel, to 0.02 mm. Before it, the press is raised
    by up to detent_cN within detent_mm; on reaching it, a click of its own pitch is felt, 140 Hz and 40 Hz
    more per level. The key is the level; it is left 0.1 mm above where it begins. The release has no detents.
    """
    press, release = _surfaces(base)
    starts_mm = [STEP_mm * round(base.travel_mm * k / (levels + 1) / STEP_mm) for k in range(1, levels + 1)]
    bumps = [
        point
        for start in starts_mm
        for point in ((start - detent_mm, 0.0), (start - detent_mm / 2, detent_cN), (start, 0.0))
    ]
    states = []
    for level in range(levels + 1):
        ways = []
        if level < levels:
            ways.append(_deeper(starts_mm[level], f"level {level + 1}", f"click {level + 1}"))
        if level > 0:
            ways.append(_shallower(starts_mm[level - 1] - 0.1, f"level {level - 1}"))
        states.append(State(f"level {level}", "detents", release.name, tuple(ways), key=level))
    clicks = tuple(_tick(f"click {k}", 100.0 + 40.0 * k) for k in range(1, levels + 1))
    surfaces = (raised(press, "detents", bumps), release)
    summary = f"{levels} levels, marked by detents and clicks, each reported as a key level."
    return Program("multi-level", base.travel_mm, "level 0", tuple(states), surfaces, clicks, (), summary)


def dwell_ticks(base: FDVVModel, period_ms: int = 250, bottom_mm: float = 0.3) -> Program:
    """Tick while the press dwells at the bottom, so that shots can be counted with the finger.

    Within bottom_mm of the bottom the key is 2 and a tick of 12 ms is felt at once and every period_ms; it
    ends when the cap has come back by 0.2 mm more. Otherwise the base, key 1 between actuation and reset.
    """
    actuation_mm, reset_mm = key_points_mm(base)
    press, release = _surfaces(base)
    signals, events = _snaps(base)
    edge_mm = base.travel_mm - bottom_mm
    left = (_shallower(edge_mm - HOLD_mm, "down"),)
    both = (press.name, release.name)
    states = (
        State("up", *both, (_deeper(actuation_mm, "down"),)),
        State("down", *both, (_deeper(edge_mm, "dwelling"), _shallower(reset_mm, "up")), key=1),
        State("dwelling", *both, left, 2, enter_signal="tick", repeat_signal="tick", repeat_ms=period_ms),
    )
    summary = f"Ticks every {period_ms} ms while held at the bottom."
    sounds = (*signals, _tick("tick", 200.0))
    return Program("dwell-ticks", base.travel_mm, "up", states, (press, release), sounds, events, summary)


def returning_later(
    base: FDVVModel, cooldown_ms: int = 1500, event: int = 0, sunk_cN: float = 15.0, fade_ms: int = 80
) -> Program:
    """Stay down after a press until the cooldown is over, then come back and be ready: a button with a pause.

    From the base's actuation on the cap is held down with sunk_cN, key 1, for cooldown_ms or until host event
    `event`. Then the base's force returns within fade_ms, key 0, and the button is armed again at half the
    actuation depth.
    """
    actuation_mm, _ = key_points_mm(base)
    press, release = _surfaces(base)
    signals, events = _snaps(base, "ready", "returning")
    both = (press.name, release.name)
    back = Transition("returning", Condition(When.HOST_EVENT, event))
    states = (
        State("ready", *both, (_deeper(actuation_mm, "spent"),)),
        State("spent", "sunk", "sunk", (back, _after(cooldown_ms, "returning")), key=1),
        State("returning", *both, (_shallower(actuation_mm / 2, "ready"),), fade_ms=fade_ms),
    )
    surfaces = (press, release, flat("sunk", -sunk_cN))
    summary = f"Once pressed it stays down for {cooldown_ms} ms, or until the host lets it go."
    return Program("returning-later", base.travel_mm, "ready", states, surfaces, signals, events, summary)


def rapid_trigger(
    base: FDVVModel,
    press_mm: float = 0.15,
    release_mm: float = 0.15,
    top_dead_mm: float = 0.3,
    bottom_dead_mm: float = 0.2,
) -> Program:
    """Go down after any fall of press_mm and up after any rise of release_mm, wherever in the stroke.

    All four in steps of 0.01 mm; top_dead_mm is 0.3 or, unless it is set, as deep as the cap of a weak base
    may bounce. Falls and rises count from the highest and the deepest point since the key
    last changed. Above top_dead_mm the key is always up; within bottom_dead_mm of the bottom it is always
    down. The feel is the base's.
    """
    names = ("press_mm", "release_mm", "top_dead_mm", "bottom_dead_mm")
    for name, value in zip(names, (press_mm, release_mm, top_dead_mm, bottom_dead_mm), strict=True):
        if abs(value * 100 - round(value * 100)) > 1e-6:
            raise InputError(name, "value", f"goes in steps of 0.01, got {value:g}", "round it")
    press, release = _surfaces(base)
    signals, events = _snaps(base)
    both = (press.name, release.name)
    bottom_mm = round(base.travel_mm - bottom_dead_mm, 4)
    fall = Transition("down", Condition(When.FALLEN_BY, press_mm), Condition(When.DEEPER_THAN, top_dead_mm))
    rise = Transition("up", Condition(When.RISEN_BY, release_mm), Condition(When.SHALLOWER_THAN, bottom_mm))
    states = (
        State("up", *both, (_deeper(bottom_mm, "down"), fall)),
        State("down", *both, (_shallower(top_dead_mm, "up"), rise), key=1),
    )
    summary = f"Down after {press_mm:g} mm of fall, up after {release_mm:g} mm of rise, anywhere."
    return Program("rapid-trigger", base.travel_mm, "up", states, (press, release), signals, events, summary)


@dataclass(frozen=True)
class Parameter:
    """A number that a shipped program takes; its unit is the last part of its name."""

    name: str
    default: float


@dataclass(frozen=True)
class Recipe:
    """A shipped program before it is made.

    Attributes
    ----------
    name : what `make` calls it.
    summary : what it does, one line.
    details : its promises, and what its parameters mean.
    parameters : with their defaults.
    """

    name: str
    summary: str
    details: str
    parameters: tuple[Parameter, ...]


def _button(base: FDVVModel) -> Program:
    """Be the base itself, with its key report and its vibrations.

    Key 1 between the base's actuation and reset.
    """
    return button_program(base)


MAKERS: dict[str, Callable[..., Program]] = {
    "button": _button,
    "dwell-ticks": dwell_ticks,
    "fast-tapping": fast_tapping,
    "multi-level": multi_level,
    "non-newtonian": non_newtonian,
    "rapid-trigger": rapid_trigger,
    "returning-later": returning_later,
}


def programs() -> tuple[Recipe, ...]:
    """List the shipped programs, sorted by name."""
    return tuple(_recipe(name) for name in sorted(MAKERS))


def _recipe(name: str) -> Recipe:
    text = inspect.getdoc(MAKERS[name]) or ""
    summary, _, details = text.partition("\n\n")
    parameters = list(inspect.signature(MAKERS[name]).parameters.values())[1:]
    return Recipe(name, summary, details, tuple(Parameter(p.name, p.default) for p in parameters))


def make(name: str, base: FDVVModel | str | None = None, /, **parameters: float) -> Program:
    """Make a shipped program.

    base : the model it extends, or the name of a built-in; mx-red by default.
    parameters : those of the program; the others have their defaults.
    Forces of the base that would not bring the cap back against friction are raised; the description says so.
    Raises InputError for an unknown name or parameter, or a value out of range. The result is not checked.
    """
    if name not in MAKERS:
        remedy = f"use one of: {', '.join(sorted(MAKERS))}"
        raise InputError("program", "name", f"none is called {name!r}", remedy)
    known = {p.name: p.default for p in _recipe(name).parameters}
    for parameter, value in parameters.items():
        if parameter not in known:
            remedy = f"use one of: {', '.join(known) or 'none'}"
            raise InputError(f"program {name!r}", "parameter", f"none is called {parameter!r}", remedy)
        if isinstance(known[parameter], int):
            if value != int(value):
                reason = f"must be a whole number, got {value:g}"
                raise InputError(f"program {name!r}", parameter, reason, "round it")
            parameters[parameter] = int(value)
    model = load_builtin(base or BASE) if base is None or isinstance(base, str) else base
    check_ranges(name, model, **(known | parameters))
    made = _returning(MAKERS[name](model, **parameters))
    if name == "rapid-trigger" and "top_dead_mm" not in parameters:
        deeper_mm = _bounce_mm(made)
        if deeper_mm > known["top_dead_mm"]:
            return make(name, model, **parameters, top_dead_mm=deeper_mm)
    return made


def _returning(program: Program) -> Program:
    """Raise the forces that would not bring the cap back, and say by how much; surfaces that pull stay."""
    surfaces = tuple(returning(s) if s.table_cN.max() > RETURNING_cN else s for s in program.surfaces)
    pairs = zip(surfaces, program.surfaces, strict=True)
    raised_cN = max(float((new.table_cN - old.table_cN).max()) for new, old in pairs)
    if raised_cN <= 0:
        return program
    said = (
        f"Forces below {force_text(RETURNING_cN)} are raised to it, by up to {raised_cN:.1f}, to bring the "
        "cap back."
    )
    return replace(program, surfaces=surfaces, description=f"{program.description} {said}")


def _bounce_mm(program: Program) -> float:
    """Return how deep a cap may bounce from the top in the start state, to 0.01 mm, upward."""
    limits = Limits()
    motion = Motion(program, limits, limits.grid_error_cN)
    start = [state.name for state in program.states].index(program.start)
    return math.ceil(100 * float(motion.cells.edges_mm[motion.top_cells(start).stop])) / 100


def load_shipped(name: str) -> Program:
    """Read a shipped program as it is made with the default base and parameters, from its file."""
    folder = resources.files("fdvv.program").joinpath("library")
    known = sorted(
        f.name.removesuffix(PROGRAM_SUFFIX) for f in folder.iterdir() if f.name.endswith(PROGRAM_SUFFIX)
    )
    if name not in known:
        raise InputError("program", "name", f"none is called {name!r}", f"use one of: {', '.join(known)}")
    return program_from_json(folder.joinpath(name + PROGRAM_SUFFIX).read_bytes(), name + PROGRAM_SUFFIX)


def names_program(spec: str) -> bool:
    """Return whether spec names a program: a shipped one, or a file of that ending."""
    return spec.endswith(PROGRAM_SUFFIX) or spec in MAKERS


def open_program(spec: str) -> Program:
    """Return the program that spec names: a shipped one, or a *.fdvv-program.json file. Raises InputError."""
    if spec in MAKERS:
        return load_shipped(spec)
    if not spec or not Path(spec).is_file():
        remedy = f"name a *{PROGRAM_SUFFIX} or one of {', '.join(sorted(MAKERS))}"
        raise InputError(spec or "''", "argument", "no such file or shipped program", remedy)
    return load_program(spec)
