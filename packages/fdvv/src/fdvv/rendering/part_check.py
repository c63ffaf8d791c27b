"""The check of a rig's parts before anything is learned on it, at no more than 30 cN.

First a small force grows and falls with nobody pressing: does the cap go the way that it is pushed, and come
to lie where the stop was set? Then a person presses once on a table of small forces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fdvv.compensation.parts.facts import FEWEST_ticks, PressFacts
from fdvv.compensation.parts.guard import KNOWN_gain_error, PartGuard
from fdvv.compensation.parts.rules import (
    COIL,
    FORCE,
    MOVER,
    PLACE_RULES,
    DEEP_mm,
    EXACT_mm,
    LOW_mm,
    MOVED_mm,
    force_silent,
    frozen_fault,
    limiter_fault,
    part_at_fault,
    was_touched,
)
from fdvv.device.contract import PressError
from fdvv.device.remote import Remote, watch
from fdvv.device.telemetry import TickColumns
from fdvv.errors import DeviceError, PartFault, PartFaultError
from fdvv.model.surface import ForceSurface
from fdvv.program.force_ramp import force_ramp_image
from fdvv.protocol.tables import Fault
from fdvv.units import FloatArray

CHECK_cN = 30.0
"""No command exceeds it until the check has passed."""
PUSH_cN, WAVE_cN, WAVE_mm = 29.0, 9.0, 1.6
"""Largest command of ramp and table; half the depth of the table's waves, and their length."""
END_mm, FADE_mm = 0.4, 0.2
"""So near the stops the table lifts the cap as well as it can."""
CHECK_mm_s, STEP_mm = 50.0, 0.05
RAMP_s, HOLD_s, REST_s, LAST_s = 0.25, 0.15, 0.35, 0.03
TRIES = 2
"""Presses that the check asks for at most."""


@dataclass(frozen=True)
class PartsChecked:
    """What a check that passed could not see; empty if it saw everything.

    unseen : parts, each with the reason in brackets.
    """

    unseen: tuple[str, ...] = ()

    def __str__(self) -> str:
        seen = "the rig's parts were checked at 30 cN and are sound"
        return f"{seen}; not seen: {', '.join(self.unseen)}" if self.unseen else seen


def check_parts(
    device: Remote, guard: PartGuard, ask: Callable[[float, float], None] = lambda _speed, _travel: None
) -> PartsChecked:
    """Check the parts of a rig; what the press shows teaches the guard.

    ask : called before each press, with speed and travel. Raises PartFaultError on a part at fault,
    DeviceError if nobody presses, and as the device does.
    """
    ramp = _Ramp.of(device, guard.travel_mm)
    if fault := ramp.fault(guard.travel_mm):
        raise PartFaultError(fault)
    device.upload(check_surface(guard.travel_mm, _most_cN(device)), guard.travel_mm)
    for _ in range(TRIES):
        ask(CHECK_mm_s, guard.travel_mm)
        facts = _press(device, guard)
        if facts is not None and (fault := _at_fault(facts, guard)):
            raise PartFaultError(fault)
        if facts is not None and (was_touched(facts) or not guard.has_force):
            return PartsChecked(_unseen(guard, ramp))
    if facts is not None and (silent := force_silent(facts)):
        raise PartFaultError(silent)
    raise DeviceError(
        f"{device.info().name}: no press was felt in {TRIES} tries; press the cap down to the stop and let go"
    )


def _most_cN(device: Remote) -> float:
    return min(PUSH_cN, device.info().force_limit_cN)


def check_surface(travel_mm: float, most_cN: float = PUSH_cN) -> ForceSurface:
    """Return a table of most_cN, which lifts the cap, and varies down to 11/29 of it amid the press."""
    x = np.linspace(0.0, travel_mm, max(2, round(travel_mm / STEP_mm) + 1))
    within = np.clip((np.minimum(x, travel_mm - x) - END_mm) / FADE_mm, 0.0, 1.0)
    wave = WAVE_cN * (1 - np.cos(2 * np.pi * (x - END_mm) / WAVE_mm))
    rows = (PUSH_cN - within * wave, np.full(x.size, PUSH_cN))
    tables = [np.array([row], dtype=np.float64) * most_cN / PUSH_cN for row in rows]
    return ForceSurface(x, np.array([CHECK_mm_s]), tables[0], tables[1])


def _press(device: Remote, guard: PartGuard) -> PressFacts | None:
    """Have someone press; a record of nobody pressing counts too, a fault of the board raises."""
    try:
        return guard.facts(device.press(CHECK_mm_s))
    except PressError as error:
        return guard.facts(error.press) if error.press else None
    except DeviceError:
        raise_part(device)
        raise


def confirm(device: Remote, fault: PartFault) -> PartFault:
    """Return a fault of the mover as it is, or the position sensor's: a place that is read has noise.

    With the force loop closed a record holds the loop's estimate of the place instead.
    """
    if fault.part != MOVER:
        return fault
    place = _watch(device, REST_s).displacement_mm
    if place.size < FEWEST_ticks or np.ptp(place) > EXACT_mm:
        return fault
    return frozen_fault(float(place[0]), "while the finger pushed it")


def raise_part(device: Remote) -> None:
    """Raise PartFaultError if the board found a part of its rig at fault."""
    report = device.fault()
    if report.fault is not Fault.NONE and report.part_fault:
        raise PartFaultError(report.part_fault)


def _at_fault(facts: PressFacts, guard: PartGuard) -> PartFault | None:
    """Judge all but how strong the coil is: small forces teach that, the next press decides."""
    if fault := part_at_fault(facts):
        return fault
    guard.learn_facts(facts)
    return None


def _unseen(guard: PartGuard, ramp: _Ramp) -> tuple[str, ...]:
    if not guard.has_force:
        is_lifted = () if ramp.is_lifted else (f"{COIL} (30 cN do not move the cap)",)
        none = "the settings have no force sensor"
        return (*is_lifted, f"how strong the {COIL} is, {MOVER}, {FORCE} ({none})")
    if guard.balance.gain[1] <= KNOWN_gain_error:
        return ()
    return (f"how strong the {COIL} is (30 cN do not hold the cap up)",)


@dataclass(frozen=True)
class _Ramp:
    """Where the cap lay under a force up and under one down; all ticks of both, and of the rests before.

    free : it lay still while there was no force, so nobody moved it.
    """

    up_mm: float
    down_mm: float
    free: bool
    facts: PressFacts

    @classmethod
    def of(cls, device: Remote, travel_mm: float) -> _Ramp:
        most_cN = _most_cN(device)
        _load(device, travel_mm, most_cN)
        rest = _watch(device, REST_s)
        up, after = _arm_and_watch(device), _watch(device, REST_s)
        _load(device, travel_mm, -most_cN)
        down = _arm_and_watch(device)
        up_mm, down_mm = (_last_mm(device, columns) for columns in (up, down))
        whole = [np.concatenate([getattr(c, name) for c in (rest, up, after, down)]) for name in COLUMNS]
        tick_s = device.settings().tick_us * 1e-6
        felt = whole[2] if device.settings().force_gain_q14 else None
        facts = PressFacts(tick_s, whole[0], whole[1], felt, travel_mm)
        return cls(up_mm, down_mm, _lies(rest) and _lies(after), facts)

    @property
    def is_lifted(self) -> bool:
        return self.free and self.down_mm - self.up_mm > MOVED_mm

    def fault(self, travel_mm: float) -> PartFault | None:
        if fault := part_at_fault(self.facts, PLACE_RULES):
            return fault
        if self.free and self.up_mm - self.down_mm > MOVED_mm:
            seen = f"the coil pushes the other way: {PUSH_cN:.0f} cN up took the cap down"
            return PartFault(COIL, seen, "exchange its two wires")
        # a cap that came down again lies on the stop
        stop_mm = self.down_mm if self.is_lifted else travel_mm
        if not -LOW_mm < stop_mm - travel_mm < DEEP_mm:
            return limiter_fault(stop_mm, travel_mm)
        return None


COLUMNS = ("displacement_mm", "commanded_cN", "force_cN")


def _load(device: Remote, travel_mm: float, force_cN: float) -> None:
    device.upload_program(force_ramp_image(device.settings(), travel_mm, 0.0, force_cN, RAMP_s))


def _watch(device: Remote, span_s: float) -> TickColumns:
    pieces = list(watch(device, span_s))
    raise_part(device)
    columns = {name: np.concatenate([getattr(p, name) for p in pieces]) for name in vars(pieces[0])}
    return TickColumns(**columns)


def _arm_and_watch(device: Remote) -> TickColumns:
    try:
        device.client.arm()
        return _watch(device, RAMP_s + HOLD_s)
    except DeviceError as error:
        if not isinstance(error, PartFaultError):
            raise_part(device)
        raise
    finally:
        device.stop()


def _lies(columns: TickColumns) -> bool:
    """Return whether the cap stayed where it was in the later half of a rest, after it fell."""
    later = columns.displacement_mm[columns.displacement_mm.size // 2 :]
    return bool(later.size and np.ptp(later) < MOVED_mm / 2)


def _last_mm(device: Remote, columns: TickColumns) -> float:
    place: FloatArray = columns.displacement_mm
    if place.size < FEWEST_ticks:
        raise DeviceError(f"{device.info().name}: no telemetry arrived; look at the cable of the board")
    return float(np.median(place[-max(1, round(LAST_s / (device.settings().tick_us * 1e-6))) :]))
