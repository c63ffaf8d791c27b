"""Programs of every kind that can be written down, whether or not a device could render them."""

from __future__ import annotations

from hypothesis import strategies as st

from fdvv.model.vibration import Mode
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import During, Program, Signal, State, Velocity, VibrationEvent
from fdvv.program.surface import Surface

PLACES_mm = st.integers(0, 600).map(lambda n: n / 100)
FORCES_cN = st.floats(-400, 400, allow_nan=False).map(lambda f: round(f, 3))
PLAIN = {When.ALWAYS, When.TURNED_TO_PRESS, When.TURNED_TO_RELEASE}


@st.composite
def conditions(draw: st.DrawFn) -> Condition:
    """Draw a condition that an image can hold exactly."""
    when = draw(st.sampled_from(When))
    if when in PLAIN:
        return Condition(when)
    if when in (When.AFTER, When.HOST_EVENT):
        return Condition(when, draw(st.integers(0, 31)))
    if when in (When.FASTER_THAN, When.SLOWER_THAN):
        return Condition(when, draw(st.integers(0, 500)))
    return Condition(when, draw(PLACES_mm))


@st.composite
def surfaces(draw: st.DrawFn, name: str) -> Surface:
    """Draw a surface of few points."""
    places = sorted(draw(st.sets(PLACES_mm, min_size=2, max_size=6)))
    speeds = sorted(draw(st.sets(st.integers(0, 500).map(float), min_size=1, max_size=3)))
    rows = [tuple(draw(FORCES_cN) for _ in places) for _ in speeds]
    return Surface(name, tuple(places), tuple(rows), tuple(speeds))


@st.composite
def programs(draw: st.DrawFn) -> Program:
    """Draw a program of up to four states."""
    names = [f"state {i}" for i in range(draw(st.integers(1, 4)))]
    tables = [draw(surfaces(f"surface {i}")) for i in range(draw(st.integers(1, 3)))]
    signals = [
        Signal(f"signal {i}", 0.01 * (i + 1), (Mode(100.0 + 50 * i, 5.0, 100.0),))
        for i in range(draw(st.integers(0, 2)))
    ]
    played = st.sampled_from([None, *(s.name for s in signals)])
    some = st.sampled_from([t.name for t in tables])
    states = [_state(draw, name, names, some, played) for name in names]
    events = [
        VibrationEvent(
            draw(st.sampled_from(signals)).name,
            draw(PLACES_mm),
            draw(st.sampled_from(During)),
            draw(st.sampled_from([None, 20.0])),
            draw(st.sampled_from([None, 90.5])),
            tuple(draw(st.sets(st.sampled_from(names)))),
        )
        for _ in range(draw(st.integers(0, 2)) if signals else 0)
    ]
    start = draw(st.sampled_from(names))
    return Program("drawn", 6.2, start, tuple(states), tuple(tables), tuple(signals), tuple(events), "ü")


def _state(
    draw: st.DrawFn,
    name: str,
    names: list[str],
    some: st.SearchStrategy[str],
    played: st.SearchStrategy[str | None],
) -> State:
    ways = [
        Transition(
            draw(st.sampled_from(names)),
            draw(conditions()),
            draw(st.none() | conditions().filter(lambda c: c.when is not When.ALWAYS)),
            draw(played),
        )
        for _ in range(draw(st.integers(0, 3)))
    ]
    repeated = draw(played)
    bias_ms = draw(st.sampled_from([0, 100]))
    return State(
        name,
        draw(some),
        draw(some),
        tuple(ways),
        draw(st.integers(0, 255)),
        draw(st.sampled_from(Velocity)),
        draw(played),
        repeated,
        50 if repeated else 0,
        draw(st.sampled_from([0, 20])),
        draw(st.integers(-100, 100)) / 4,
        draw(st.integers(-100, 100)) / 4 if bias_ms else 0.0,
        bias_ms,
    )
