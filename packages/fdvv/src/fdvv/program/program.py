"""A program in a designer's units: states, transitions, surfaces, signals and vibration events."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from enum import StrEnum
from itertools import islice
from typing import Annotated

import numpy as np
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv.program.condition import Name, Transition
from fdvv.program.surface import Surface, check_name
from fdvv.protocol.tables import Stroke as Direction
from fdvv.protocol.tables import VelocitySource

TRAVEL_mm = (0.2, 20.0)
LARGEST = {"key": 255, "repeat_ms": 65_535, "fade_ms": 2000, "bias_ms": 65_535}
"""Of the whole numbers of a state."""
LISTED = 16
"""Number of known names that an error lists; a device holds no more states or surfaces."""


class Velocity(StrEnum):
    """Velocity that chooses the row of a surface: announced, measured once per press, or all the time."""

    ANNOUNCED = "announced"
    DECIDED = "decided"
    CONTINUOUS = "continuous"

    @property
    def code(self) -> VelocitySource:
        """Its number on the device."""
        return VelocitySource[self.name]


class During(StrEnum):
    """The stroke in which a vibration is played."""

    PRESS = "press"
    RELEASE = "release"
    EITHER = "either"

    @property
    def code(self) -> Direction:
        """Return its number on the device."""
        return Direction[self.name]


@dataclass(frozen=True)
class Signal:
    """A short vibration of the cap, without a place.

    Attributes
    ----------
    name : how states, transitions and events refer to it.
    duration_s : length; silence after it.
    modes : damped sinusoids that add up to the cap's acceleration.
    """

    name: Name
    duration_s: Annotated[float, Meta(gt=0)]
    modes: Annotated[tuple[Mode, ...], Meta(min_length=1)]

    def __post_init__(self) -> None:
        check_name(self.name)
        object.__setattr__(self, "modes", tuple(self.modes))
        self.vibration()

    def vibration(self) -> Vibration:
        """Return it as the model room's vibration, at displacement 0; raises ModelError."""
        return Vibration(Stroke.PRESS, None, 0.0, self.duration_s, self.modes)


@dataclass(frozen=True)
class VibrationEvent:
    """A signal felt at a displacement, once per stroke; the device starts it early by its board's latency.

    Attributes
    ----------
    signal : name of what is played.
    at_mm : where it is to be felt.
    stroke : in which direction.
    slowest_mm_s : it is played only at or above this velocity; None: no bound.
    fastest_mm_s : it is played only below this velocity; None: no bound.
    states : names of the states in which it is played; none named: in all.
    """

    signal: Name
    at_mm: float
    stroke: During = During.PRESS
    slowest_mm_s: float | None = None
    fastest_mm_s: float | None = None
    states: tuple[Name, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", During(self.stroke))
        object.__setattr__(self, "states", tuple(self.states))
        if not (np.isfinite(self.at_mm) and -2 <= self.at_mm <= TRAVEL_mm[1]):
            raise ModelError(f"at_mm must be -2 to {TRAVEL_mm[1]}, got {self.at_mm}")
        for bound in (self.slowest_mm_s, self.fastest_mm_s):
            if bound is not None and not 0 <= bound <= 4000:
                raise ModelError(f"velocities of a vibration are 0 to 4000 mm/s, got {bound}")
        if (self.slowest_mm_s or 0.0) >= (4000.0 if self.fastest_mm_s is None else self.fastest_mm_s):
            raise ModelError(f"no velocity is {self.slowest_mm_s} mm/s or more and below {self.fastest_mm_s}")


@dataclass(frozen=True)
class State:
    """What is felt and reported until a transition leads on.

    Attributes
    ----------
    name : how transitions refer to it.
    press : name of the surface looked up while the cap goes down.
    release : name of the surface looked up while it comes up.
    transitions : tried in this order at every tick; the first that holds is taken.
    key : reported to the host: 0 up, else the level that is down.
    velocity : which velocity chooses the row of the surfaces.
    enter_signal : played on entering, or None.
    repeat_signal : played again and again in the state, or None.
    repeat_ms : its period; 0 with none.
    fade_ms : time in which the force moves from the last state's to this one's.
    bias_cN : added to the surface's force.
    bias_end_cN : what the bias has become after bias_ms.
    bias_ms : time over which the bias changes; 0: it does not.
    """

    name: Name
    press: Name
    release: Name
    transitions: tuple[Transition, ...] = ()
    key: Annotated[int, Meta(ge=0, le=LARGEST["key"])] = 0
    velocity: Velocity = Velocity.DECIDED
    enter_signal: Name | None = None
    repeat_signal: Name | None = None
    repeat_ms: Annotated[int, Meta(ge=0, le=LARGEST["repeat_ms"])] = 0
    fade_ms: Annotated[int, Meta(ge=0, le=LARGEST["fade_ms"])] = 0
    bias_cN: float = 0.0
    bias_end_cN: float = 0.0
    bias_ms: Annotated[int, Meta(ge=0, le=LARGEST["bias_ms"])] = 0

    def __post_init__(self) -> None:
        check_name(self.name)
        object.__setattr__(self, "transitions", tuple(self.transitions))
        object.__setattr__(self, "velocity", Velocity(self.velocity))
        for field, high in LARGEST.items():
            value = getattr(self, field)
            if not 0 <= value <= high or value != int(value):
                wrong = f"{field} must be a whole number to {high}, got {value}"
                raise ModelError(f"state {self.name!r}: {wrong}")
        if (self.repeat_signal is None) != (self.repeat_ms == 0):
            raise ModelError(f"state {self.name!r}: repeat_signal and repeat_ms go together")
        if not np.isfinite([self.bias_cN, self.bias_end_cN]).all():
            raise ModelError(f"state {self.name!r}: a bias must be finite")
        if self.bias_ms == 0 and self.bias_end_cN != 0:
            raise ModelError(f"state {self.name!r}: bias_end_cN needs bias_ms, the time to get there")

    def biases_cN(self) -> tuple[float, float]:
        """Return the least and the greatest bias while in the state."""
        end = self.bias_end_cN if self.bias_ms else self.bias_cN
        return min(self.bias_cN, end), max(self.bias_cN, end)


@dataclass(frozen=True)
class Program:
    """A button as a machine of states.

    Attributes
    ----------
    name : short, as a file would be called.
    travel_mm : where the bottom stop is set.
    start : name of the state entered first.
    states, surfaces, signals : no two of one name; every name referred to exists.
    vibrations : signals tied to displacements.
    description : what the button does, for people.

    Raises ModelError on anything else. What a device can render and whether the button comes back is for
    `check_program`.
    """

    name: Name
    travel_mm: Annotated[float, Meta(gt=0)]
    start: Name
    states: Annotated[tuple[State, ...], Meta(min_length=1)]
    surfaces: Annotated[tuple[Surface, ...], Meta(min_length=1)]
    signals: tuple[Signal, ...] = ()
    vibrations: tuple[VibrationEvent, ...] = ()
    description: str = ""

    def __post_init__(self) -> None:
        check_name(self.name)
        for field in ("states", "surfaces", "signals", "vibrations"):
            object.__setattr__(self, field, tuple(getattr(self, field)))
        low, high = TRAVEL_mm
        if not low <= self.travel_mm <= high:
            raise ModelError(f"travel_mm must be {low} to {high}, got {self.travel_mm}")
        states = _names([s.name for s in self.states], "state")
        surfaces = _names([s.name for s in self.surfaces], "surface")
        signals = _names([s.name for s in self.signals], "signal")
        _check_known(self.start, states, "state", "start")
        for state in self.states:
            _check_state(state, states, surfaces, signals)
        for i, event in enumerate(self.vibrations):
            _check_known(event.signal, signals, "signal", f"vibration {i + 1}")
            for name in event.states:
                _check_known(name, states, "state", f"vibration {i + 1}")

    def state(self, name: str) -> State:
        return next(state for state in self.states if state.name == name)

    def surface(self, name: str) -> Surface:
        return next(surface for surface in self.surfaces if surface.name == name)


def _names(names: Iterable[str], what: str) -> Collection[str]:
    counts = Counter(names)
    twice = [name for name, count in counts.items() if count > 1]
    if twice:
        raise ModelError(f"two {what}s are called {min(twice)!r}")
    return counts


def _check_known(name: str, known: Collection[str], what: str, place: str) -> None:
    if name not in known:
        listed = ", ".join(map(repr, islice(known, LISTED))) or "none"
        listed += f" and {len(known) - LISTED} more" if len(known) > LISTED else ""
        raise ModelError(f"{place}: no {what} is called {name!r}; there is {listed}")


def _check_state(
    state: State, states: Collection[str], surfaces: Collection[str], signals: Collection[str]
) -> None:
    place = f"state {state.name!r}"
    for name in (state.press, state.release):
        _check_known(name, surfaces, "surface", place)
    for signal in (state.enter_signal, state.repeat_signal):
        if signal is not None:
            _check_known(signal, signals, "signal", place)
    for i, transition in enumerate(state.transitions):
        _check_known(transition.to, states, "state", f"{place}, transition {i + 1}")
        if transition.signal is not None:
            _check_known(transition.signal, signals, "signal", f"{place}, transition {i + 1}")
