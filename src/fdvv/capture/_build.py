"""From what a reader found to checked cycles: repair, split, put in order."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fdvv.capture import _repair
from fdvv.capture._contact import mean_velocity_mm_s, switching_mm
from fdvv.capture._record import Notes, RawCycle, Reading, Track
from fdvv.capture._split import hand_over_turn, orient, split_run
from fdvv.capture._text import LEAST_SAMPLES, refusal
from fdvv.capture._types import Cycle, ForceFile
from fdvv.model import MeasuredCurve, Stroke

LEAST_TRAVEL_mm = 0.02
"""Below four steps of the finest bench nothing was pressed."""


def build(source: Path, reading: Reading, notes: Notes) -> ForceFile:
    """Make the checked file of a reading; raises InputError if no stroke is left."""
    cycles: list[Cycle] = []
    for raw in reading.cycles:
        cycles += [_cycle(part, notes) for part in split_run(_clean(raw, notes), notes)]
    cycles = [cycle for cycle in cycles if cycle.press or cycle.release]
    if not cycles:
        why = notes.sentences[-1] if notes.sentences else "the displacement never changes"
        raise refusal(source, "whole file", f"no stroke in it: {why}")
    return ForceFile(reading.name, reading.format, tuple(cycles), notes.lines())


def _clean(raw: RawCycle, notes: Notes) -> RawCycle:
    """Take from each track what cannot be, before anything is measured on it."""
    return replace(
        raw,
        run=_possible(raw.run, notes),
        press=_possible(raw.press, notes),
        release=_possible(raw.release, notes),
    )


def _possible(track: Track | None, notes: Notes) -> Track | None:
    if track is None or track.x_mm.size == 0:
        return None
    track = _repair.drop_impossible(track, notes)
    if track.x_mm.size >= 3:
        track = _repair.drop_stray_positions(track, notes)
    return track if _long_enough(track, notes) else None


def _long_enough(track: Track, notes: Notes) -> bool:
    if track.x_mm.size < LEAST_SAMPLES:
        notes.say(f"{track.where}: only {track.x_mm.size} usable samples; it was left out")
        return False
    if np.ptp(track.x_mm) < LEAST_TRAVEL_mm:
        notes.say(
            f"{track.where}: the displacement stays within {np.ptp(track.x_mm):.3g} mm; it was left out"
        )
        return False
    return True


def _cycle(raw: RawCycle, notes: Notes) -> Cycle:
    """Repair both strokes of a split cycle and make it a record."""
    raw = _repair.mend_slip(hand_over_turn(_orient_pair(raw, notes), notes), notes)
    actuation = switching_mm(raw.press, Stroke.PRESS, notes)
    reset = switching_mm(raw.release, Stroke.RELEASE, notes)
    return Cycle(
        _curve(raw.press, Stroke.PRESS, raw.velocity_mm_s, notes),
        _curve(raw.release, Stroke.RELEASE, raw.velocity_mm_s, notes),
        raw.actuation_mm if actuation is None else actuation,
        raw.reset_mm if reset is None else reset,
        raw.label,
    )


def _orient_pair(raw: RawCycle, notes: Notes) -> RawCycle:
    return replace(
        raw,
        press=None if raw.press is None else orient(raw.press, notes),
        release=None if raw.release is None else orient(raw.release, notes),
    )


def _curve(track: Track | None, stroke: Stroke, velocity: float | None, notes: Notes) -> MeasuredCurve | None:
    if track is None or not _long_enough(track, notes):
        return None
    track = _repair.drop_lost_tare(_repair.drop_spikes(track, notes), notes)
    if stroke is Stroke.PRESS:
        track = _repair.drop_stuck_probe(track, notes)
    if not _long_enough(track, notes):
        return None
    _repair.tell_jumps(track, notes)
    speed = mean_velocity_mm_s(track) if velocity is None else velocity
    return MeasuredCurve(*_repair.rising(track, notes), stroke, speed)
