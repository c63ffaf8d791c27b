"""The program of a model: the plain button, with key report and vibrations; ranges of parameters."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from fdvv.errors import InputError
from fdvv.model.curve import Stroke, reading_order
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.model.vibration import Mode
from fdvv.program.compile import Compiled, compile_program
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import During, Program, Signal, State, VibrationEvent
from fdvv.program.surface import Limits, of_model, of_surface

ACTUATION_ratio = 0.5
"""Where a model of unknown actuation is taken to act, of its travel."""
HYSTERESIS_mm = 0.1
"""How far above its actuation a model of unknown reset, or one with both at one place, is taken to reset."""
NEAR_BOTTOM_mm = 0.3
HOLD_mm = 0.2
"""How far a cap must come back before a place counts as left."""
Ranges = dict[str, tuple[float, float]]


def key_points_mm(model: FDVVModel) -> tuple[float, float]:
    """Return where the key goes down and where it comes up, the latter always above."""
    actuation_mm, reset_mm = model.actuation_mm, model.reset_mm
    if actuation_mm is None:
        actuation_mm = ACTUATION_ratio * model.travel_mm
    if reset_mm is None or reset_mm >= actuation_mm:
        reset_mm = actuation_mm - HYSTERESIS_mm
    return actuation_mm, reset_mm


def button_program(model: FDVVModel, surface: ForceSurface | None = None) -> Program:
    """Write a model as a program: states `up` and `down` on the same surfaces, reported as key 0 and 1.

    surface : forces learned by compensation, commanded instead of the model's own.
    The velocity is decided once per press. Each of the model's vibrations is played at the velocities nearest
    to its own. An unknown actuation point is taken at half the travel, and the reset 0.1 mm above where it is
    unknown or not above. Raises ModelError if the model has no press curve.
    """
    actuation_mm, reset_mm = key_points_mm(model)
    press, release = (of_surface(surface, s) if surface else of_model(model, s) for s in Stroke)
    down = Transition("down", Condition(When.DEEPER_THAN, actuation_mm))
    up = Transition("up", Condition(When.SHALLOWER_THAN, reset_mm))
    both = (press.name, release.name)
    states = (State("up", *both, (down,)), State("down", *both, (up,), key=1))
    summary = f"The button {model.name} as its model tells."
    surfaces = (press, release)
    return Program(model.name, model.travel_mm, "up", states, surfaces, *vibrations_of(model), summary)


def compile_button(
    model: FDVVModel, surface: ForceSurface | None = None, limits: Limits | None = None
) -> Compiled:
    """Compile a model, or what was learned for it, as button_program writes it. Raises InputError.

    Learned forces carry the weight already, whatever the limits say.
    """
    limits = limits or Limits()
    bare = replace(limits, weight_cN=0.0) if surface else limits
    return compile_program(button_program(model, surface), bare)


def vibrations_of(model: FDVVModel) -> tuple[tuple[Signal, ...], tuple[VibrationEvent, ...]]:
    """Return a model's vibrations as signals and events; equal signals appear once."""
    signals: dict[tuple[float, tuple[Mode, ...]], Signal] = {}
    events: list[VibrationEvent] = []
    for stroke in Stroke:
        vibrations = sorted((v for v in model.vibrations if v.stroke is stroke), key=reading_order)
        speeds = [v.velocity_mm_s or 0.0 for v in vibrations]
        # a vibration is played at the velocities nearest to its own: from half-way to half-way
        edges = [None, *((slow + fast) / 2 for slow, fast in pairwise(speeds)), None]
        for vibration, (slowest, fastest) in zip(vibrations, pairwise(edges), strict=False):
            fresh = Signal(f"snap {len(signals) + 1}", vibration.duration_s, vibration.modes)
            signal = signals.setdefault((fresh.duration_s, fresh.modes), fresh)
            during = During(str(stroke))
            events.append(VibrationEvent(signal.name, vibration.onset_mm, during, slowest, fastest))
    return tuple(signals.values()), tuple(events)


def ranges(program: str, base: FDVVModel, levels: int = 1, **_: float) -> Ranges:
    """Return the least and the most of each parameter of a shipped program over a base.

    levels : of the program multi-level, whose detents must fit between them.
    """
    half_mm = base.travel_mm / 2 - 0.1
    below_actuation_mm = base.travel_mm - key_points_mm(base)[0]
    by_program: dict[str, Ranges] = {
        "fast-tapping": {
            "trigger_mm": (0.4, base.travel_mm - 2 * NEAR_BOTTOM_mm),
            "pull_cN": (6, 200),
            "push_cN": (20, 300),
            "drop_ms": (5, 1000),
        },
        "non-newtonian": {
            "soft_ratio": (0.1, 1.5),
            "stiffening_per_m_s": (0, 20),
            "fastest_mm_s": (10, 1000),
        },
        "multi-level": {
            "levels": (1, 8),
            "detent_cN": (0, 100),
            "detent_mm": (0.1, base.travel_mm / (levels + 1)),
        },
        "dwell-ticks": {
            "period_ms": (20, 10_000),
            "bottom_mm": (0.05, below_actuation_mm - 2 * HOLD_mm),
        },
        "returning-later": {
            "cooldown_ms": (1, 60_000),
            "event": (0, 31),
            "sunk_cN": (6, 100),
            "fade_ms": (0, 2000),
        },
        "rapid-trigger": dict.fromkeys(
            ("press_mm", "release_mm", "top_dead_mm", "bottom_dead_mm"), (0.01, half_mm)
        ),
    }
    return by_program.get(program, {})


def check_ranges(program: str, base: FDVVModel, **given: float) -> None:
    """Raise InputError for the first parameter that is out of its range."""
    levels = int(given.get("levels", 1))
    for name, (low, high) in ranges(program, base, levels=max(1, levels)).items():
        if not low <= given[name] <= high:
            reason = f"must be {low:g} to {high:g}, got {given[name]:g}"
            raise InputError(name, "value", reason, "choose another")
