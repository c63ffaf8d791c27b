"""A model's program: the plain button, with its key report and its vibrations."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from fdvv.model import FDVVModel, ForceSurface, Stroke, Vibration
from fdvv.program._compile import Compiled, compile_program
from fdvv.program._condition import Condition, Transition, When
from fdvv.program._limits import Limits
from fdvv.program._program import During, Program, Signal, State, VibrationEvent
from fdvv.program._surface import of_model, of_surface

ACTUATION_ratio = 0.5
"""Where a model of unknown actuation is taken to act, of its travel."""
HYSTERESIS_mm = 0.1
"""How far above its actuation a model of unknown reset, or one with both at one place, is taken to reset."""


def key_points_mm(model: FDVVModel) -> tuple[float, float]:
    """Give where the key goes down and where it comes up, the latter always above."""
    actuation_mm = model.actuation_mm
    if actuation_mm is None:
        actuation_mm = ACTUATION_ratio * model.travel_mm
    reset_mm = model.reset_mm
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
    signals, events = vibrations_of(model)
    return Program(
        model.name,
        model.travel_mm,
        "up",
        (
            State("up", press.name, release.name, (down,)),
            State("down", press.name, release.name, (up,), key=1),
        ),
        (press, release),
        signals,
        events,
        f"The button {model.name} as its model tells.",
    )


def compile_button(
    model: FDVVModel, surface: ForceSurface | None = None, limits: Limits | None = None
) -> Compiled:
    """Compile a model, or what was learned for it, as button_program writes it. Raises InputError.

    Learned forces carry the weight already, whatever the limits say.
    """
    limits = limits or Limits()
    return compile_program(
        button_program(model, surface), replace(limits, weight_cN=0.0) if surface else limits
    )


def vibrations_of(model: FDVVModel) -> tuple[tuple[Signal, ...], tuple[VibrationEvent, ...]]:
    """Give a model's vibrations as signals and events; equal signals are told once."""
    signals: list[Signal] = []
    events: list[VibrationEvent] = []
    for stroke in Stroke:
        found = sorted(
            (v for v in model.vibrations if v.stroke is stroke), key=lambda v: v.velocity_mm_s or 0.0
        )
        edges = [None, *_halfway(found), None]
        for i, vibration in enumerate(found):
            name = _signal_of(vibration, signals)
            events.append(
                VibrationEvent(name, vibration.onset_mm, During(str(stroke)), edges[i], edges[i + 1])
            )
    return tuple(signals), tuple(events)


def _halfway(vibrations: list[Vibration]) -> list[float]:
    """Give the velocities at which the nearest vibration changes."""
    speeds = [v.velocity_mm_s or 0.0 for v in vibrations]
    return [(slow + fast) / 2 for slow, fast in pairwise(speeds)]


def _signal_of(vibration: Vibration, signals: list[Signal]) -> str:
    fresh = Signal(f"snap {len(signals) + 1}", vibration.duration_s, vibration.modes)
    for known in signals:
        if replace(known, name=fresh.name) == fresh:
            return known.name
    signals.append(fresh)
    return fresh.name
