"""Check whether a rig can run a program: its demands, endless loops, and whether the cap returns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import partial

import numpy as np

from fdvv.errors import InputError
from fdvv.force_text import force_number, force_text
from fdvv.program.compile import compile_program
from fdvv.program.condition import When
from fdvv.program.program import Program, State
from fdvv.program.reachability import find_hang
from fdvv.program.return_analysis import ReturnAnalysis
from fdvv.program.surface import Limits, Surface

FASTEST_PRESS_mm_s = 300.0
"""Speed at which a surface's slope is held against the rig's slew; fingers seldom press faster."""


class Severity(StrEnum):
    """Whether a finding forbids the program."""

    REFUSED = "refused"
    WARNING = "warning"


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong or doubtful, and what to do about it.

    state : name of the state it is about; empty for the whole program. place : where in it.
    """

    severity: Severity
    state: str
    place: str
    reason: str
    remedy: str

    def __str__(self) -> str:
        where = f"state {self.state!r}, " if self.state else ""
        return f"{where}{self.place}: {self.reason}"


@dataclass(frozen=True)
class Report:
    """What a check found.

    Attributes
    ----------
    findings : refusals first.
    return_s : bound of the time from leaving the cap to the start state at the top; None if unproven.
    stiffness_cN_mm : steepest slope of any surface in use.
    rise_K : how much warmer the coil ends if the strongest force at the bottom is held for ever.
    """

    findings: tuple[Finding, ...]
    return_s: float | None
    stiffness_cN_mm: float
    rise_K: float

    @property
    def refused(self) -> tuple[Finding, ...]:
        return tuple(f for f in self.findings if f.severity is Severity.REFUSED)

    @property
    def warnings(self) -> tuple[Finding, ...]:
        return tuple(f for f in self.findings if f.severity is Severity.WARNING)


def check_program(program: Program, limits: Limits | None = None) -> Report:
    """Check a program against a rig.

    Refused: what does not compile, forces beyond the limit, forces that must change faster than the rig can
    (but for the contact step at the top), a travel beyond the stop, states that cannot be reached, vibrations
    repeated before they end, a hold at the bottom that overheats the coil, states that follow each other for
    ever without motion, and a program whose cap is not proven to come back. Warnings: stiffness that may
    buzz, a hold that derates, transitions beyond the travel.
    docs/explanation/programs.md says what is proven.
    """
    limits = limits or Limits()
    refusal, margin_cN = _try_compile(program, limits)
    returning = ReturnAnalysis(program, limits, margin_cN)
    rests = [_force_at_bottom_cN(program, state, limits) for state in program.states]
    findings = [
        *refusal,
        *_travel(program, limits),
        *(f for state in program.states for f in _state(program, state, limits)),
        *(f for state, force in zip(program.states, rests, strict=True) for f in _heat(state, force, limits)),
        *_unreachable(program),
        *_hang(program),
        *(_refused(*hazard) for hazard in returning.hazards()),
    ]
    findings.sort(key=lambda f: f.severity is Severity.WARNING)
    proven = not any(f.severity is Severity.REFUSED for f in findings)
    used = [program.surface(name) for s in program.states for name in (s.press, s.release)]
    return Report(
        tuple(findings),
        returning.return_s() if proven else None,
        max(_slope_cN_mm(surface, limits)[0] for surface in used),
        max(limits.rise_K(force) for force in rests),
    )


def require_accepted(program: Program, limits: Limits | None = None) -> Report:
    """Check a program; raise InputError with the first reason if it is refused."""
    report = check_program(program, limits)
    if report.refused:
        first = report.refused[0]
        place = f"state {first.state!r}, {first.place}" if first.state else first.place
        remedy = f"{first.remedy}; fdvv program check lists everything"
        raise InputError(f"program {program.name!r}", place, first.reason, remedy)
    return report


_refused = partial(Finding, Severity.REFUSED)
_warning = partial(Finding, Severity.WARNING)


def _try_compile(program: Program, limits: Limits) -> tuple[list[Finding], float]:
    """Return the refusal to compile, and how far the image's forces are from the program's."""
    try:
        compiled = compile_program(program, limits)
    except InputError as error:
        return [_refused("", error.place, error.reason, error.remedy)], limits.worst_grid_error_cN
    return [], max(compiled.grid_error_cN.values()) + compiled.rounding_cN


def _travel(program: Program, limits: Limits) -> Iterator[Finding]:
    if program.travel_mm > limits.largest_travel_mm:
        reason = f"{program.travel_mm:g} mm, the rig's stop reaches {limits.largest_travel_mm:g}"
        yield _refused("", "travel", reason, "shorten it")


def _state(program: Program, state: State, limits: Limits) -> Iterator[Finding]:
    for name in dict.fromkeys((state.press, state.release)):
        yield from _surface(state, program.surface(name), limits)
    if state.bias_ms:
        slew_cN_s = 1000 * abs(state.bias_end_cN - state.bias_cN) / state.bias_ms
        if slew_cN_s > limits.slew_cN_s:
            reason = (
                f"{force_text(slew_cN_s, '.3g', per='/s')}, the rig's force changes by "
                f"{force_number(limits.slew_cN_s, '.3g')}"
            )
            yield _refused(state.name, "bias", reason, "make bias_ms longer")
    for signal in program.signals:
        if signal.name == state.repeat_signal and state.repeat_ms < 1000 * signal.duration_s:
            reason = f"every {state.repeat_ms} ms, it lasts {1000 * signal.duration_s:g} ms"
            remedy = "make repeat_ms longer or the signal shorter"
            yield _refused(state.name, f"repeated signal {signal.name!r}", reason, remedy)
    for i, transition in enumerate(state.transitions):
        when = transition.when
        if when.when is When.DEEPER_THAN and when.value >= program.travel_mm:
            reason = f"{when}, the travel ends at {program.travel_mm:g} mm"
            yield _warning(state.name, f"transition {i + 1}", reason, "move it up")


def _surface(state: State, surface: Surface, limits: Limits) -> Iterator[Finding]:
    place = f"surface {surface.name!r}"
    low, high = state.biases_cN()
    table = surface.table_cN
    ends = (float(table.min()) + low + limits.weight_cN, float(table.max()) + high + limits.weight_cN)
    strongest_cN = max(map(abs, ends))
    if strongest_cN > limits.force_cN:
        reason = (
            f"{force_text(strongest_cN, '.4g')}, weight included, the rig gives "
            f"{force_number(limits.force_cN)}"
        )
        yield _refused(state.name, place, reason, "weaken it")
    slope_cN_mm, at_mm = _slope_cN_mm(surface, limits)
    slew_cN_s = slope_cN_mm * FASTEST_PRESS_mm_s
    where = f"{place} at {at_mm:.2f} mm"
    if slew_cN_s > limits.slew_cN_s:
        change = (
            f"{force_text(slope_cN_mm, '.0f', per='/mm')} at {FASTEST_PRESS_mm_s:g} mm/s is "
            f"{force_text(slew_cN_s, '.3g', per='/s')}"
        )
        reason = f"{change}, the rig's force changes by {force_number(limits.slew_cN_s, '.3g')}"
        yield _refused(state.name, where, reason, "make the step there wider or lower")
    elif slope_cN_mm > limits.stiffness_cN_mm:
        reason = (
            f"{force_text(slope_cN_mm, '.0f', per='/mm')}, a held cap may buzz above "
            f"{force_number(limits.stiffness_cN_mm, '.0f')}"
        )
        yield _warning(state.name, where, reason, "make the step there wider or lower")


def _slope_cN_mm(surface: Surface, limits: Limits) -> tuple[float, float]:
    """Return the steepest slope of a surface below the top, up or down, and where it begins.

    Above it the cap rests against its stop, and the contact step of a real button is as steep as it is.
    """
    slopes = np.abs(np.diff(surface.table_cN, axis=1) / np.diff(surface.displacement_mm))
    slopes[:, np.array(surface.displacement_mm[1:]) <= limits.top_mm] = 0.0
    column = int(np.argmax(slopes.max(axis=0)))
    return float(slopes.max()), surface.displacement_mm[column]


def _force_at_bottom_cN(program: Program, state: State, limits: Limits) -> float:
    """Return the strongest force, weight included, that a state holds against a finger at the bottom."""
    bottom = np.array([program.travel_mm])
    forces = [
        float(surface.row_cN(row, bottom)[0]) + bias + limits.weight_cN
        for surface in (program.surface(state.press), program.surface(state.release))
        for row in range(len(surface.velocity_mm_s))
        for bias in state.biases_cN()
    ]
    return max(forces, key=abs)


def _heat(state: State, force_cN: float, limits: Limits) -> Iterator[Finding]:
    rise_K = limits.rise_K(force_cN)
    reason = f"{force_text(force_cN, '.0f')} held warms the coil by {rise_K:.0f} K"
    if rise_K > limits.settings.heat_limit_K:
        reason += f", the rig stops at {limits.settings.heat_limit_K}"
        yield _refused(state.name, "at the bottom", reason, "weaken the force there")
    elif rise_K > limits.settings.derate_start_K:
        reason += f", above {limits.settings.derate_start_K} the rig weakens it"
        yield _warning(state.name, "at the bottom", reason, "weaken the force there")


def _unreachable(program: Program) -> Iterator[Finding]:
    reached, new = {program.start}, [program.start]
    while new:
        fresh = {t.to for t in program.state(new.pop()).transitions} - reached
        reached |= fresh
        new += fresh
    for state in program.states:
        if state.name not in reached:
            remedy = "add a transition to it, or remove it"
            yield _refused(state.name, "whole state", "no way leads to it", remedy)


def _hang(program: Program) -> Iterator[Finding]:
    hang = find_hang(program)
    if hang:
        cycle, stillness = hang
        place = f"at {stillness.displacement_mm:.2f} mm"
        reason = f"without any motion it goes {' → '.join(cycle)} for ever"
        yield _refused(cycle[0], place, reason, "move two of their conditions apart, or add an after_ms")
