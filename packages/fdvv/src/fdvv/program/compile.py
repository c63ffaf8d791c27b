"""From a program in a designer's units to the device's image, byte for byte the same every time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.force_text import force_number, force_text
from fdvv.model.vibration import Vibration
from fdvv.program.image import lay_out
from fdvv.program.program import Program, Signal, State
from fdvv.program.surface import Candidates, Grid, Limits, START_um16, Surface, speed_mm_s16
from fdvv.program.synth import POOL_BYTES, ConvertedVibration, slot_of_vibration
from fdvv.protocol.tables import (
    IMAGE_BYTES,
    SLOTS,
    STATES,
    SURFACE_VELOCITIES,
    SURFACES,
    TRANSITIONS,
    VIBRATIONS,
)

Converter = Callable[[Vibration], ConvertedVibration]


@dataclass(frozen=True)
class Compiled:
    """An image and what compiling cost.

    Attributes
    ----------
    image : what a device takes.
    grid_error_cN : per surface, the largest distance between it and the lines between its columns.
    rounding_cN : the largest distance that rounding to 1/64 cN moved a column; at most 1/128.
    columns : per surface, how many displacements it was given.
    vibration_error_ratio : per signal, rms error of the board's waveform over rms of the signal.
    """

    image: bytes
    grid_error_cN: dict[str, float]
    rounding_cN: float
    columns: dict[str, int]
    vibration_error_ratio: dict[str, float]


def compile_program(
    program: Program, limits: Limits | None = None, convert: Converter | None = None
) -> Compiled:
    """Compile a program to an image of protocol/fdvv.toml.

    convert : makes the slot of a signal; None: slot_of_vibration at limits.counts_per_m_s2.

    Every state carries limits.weight_cN. Columns of a surface are evenly spaced: each surface gets the fewest
    that keep it within limits.grid_error_cN of its lines; while the image is too large, that bound is
    doubled, up to limits.worst_grid_error_cN. Raises InputError that names what does not fit, or a force
    beyond the limit.
    """
    limits = limits or Limits()
    for what, count, most in part_counts(program):
        if count > most:
            raise _refuse(program, what, f"{count}, a device holds {most}", "leave some out")
    for surface in program.surfaces:
        _check_surface(program, surface, limits)
    for state in program.states:
        _check_bias(program, state, limits)
    make = convert or partial(slot_of_vibration, counts_per_m_s2=limits.counts_per_m_s2)
    converted = [_convert(program, signal, make) for signal in program.signals]
    _check_waves(program, converted)
    grids, image = _fit(program, [Candidates(s) for s in program.surfaces], converted, limits)
    _check_fit(program, grids, len(image), limits)
    names = [surface.name for surface in program.surfaces]
    return Compiled(
        image,
        {name: grid.error_cN for name, grid in zip(names, grids, strict=True)},
        max(grid.rounding_cN for grid in grids),
        {name: grid.columns for name, grid in zip(names, grids, strict=True)},
        {s.name: c.error_ratio for s, c in zip(program.signals, converted, strict=True)},
    )


def _fit(
    program: Program,
    candidates: Sequence[Candidates],
    converted: Sequence[ConvertedVibration],
    limits: Limits,
) -> tuple[list[Grid], bytes]:
    """Coarsen all grids alike until the image is small enough, or the worst bound is reached."""
    bound_cN = min(limits.grid_error_cN, limits.worst_grid_error_cN)
    while True:
        grids = [candidate.grid(candidate.coarsest(bound_cN)) for candidate in candidates]
        image = lay_out(program, grids, [c.slot for c in converted], limits.weight_cN)
        if len(image) <= IMAGE_BYTES or bound_cN >= limits.worst_grid_error_cN:
            return grids, image
        bound_cN = min(2 * bound_cN, limits.worst_grid_error_cN)


def _refuse(program: Program, place: str, reason: str, remedy: str) -> InputError:
    return InputError(f"program {program.name!r}", place, reason, remedy)


def part_counts(program: Program) -> list[tuple[str, int, int]]:
    """Return what a program is made of: kinds of parts, how many there are, how many a device holds."""
    return [
        ("states", len(program.states), STATES),
        ("transitions", sum(len(s.transitions) for s in program.states), TRANSITIONS),
        ("surfaces", len(program.surfaces), SURFACES),
        ("vibrations", len(program.vibrations), VIBRATIONS),
        ("signals", len(program.signals), SLOTS),
    ]


def _check_surface(program: Program, surface: Surface, limits: Limits) -> None:
    place = f"surface {surface.name!r}"
    rows = [speed_mm_s16(v) for v in surface.velocity_mm_s]
    if len(rows) > SURFACE_VELOCITIES:
        reason = f"{len(rows)} velocities, a device holds {SURFACE_VELOCITIES}"
        raise _refuse(program, place, reason, "leave some out")
    if rows[-1] > 65_535 or np.any(np.diff(rows) < 1):
        raise _refuse(program, place, "velocities closer than 1/16 mm/s or above 4095", "move them apart")
    strongest_cN = float(np.max(np.abs(surface.table_cN + limits.weight_cN)))
    if strongest_cN > limits.force_cN:
        reason = (
            f"{force_text(strongest_cN, '.4g')}, weight included, the rig gives "
            f"{force_number(limits.force_cN)}"
        )
        raise _refuse(program, place, reason, "weaken it")
    ends = (16_000 * surface.displacement_mm[0], 16_000 * surface.displacement_mm[-1])
    if not START_um16[0] <= ends[0] <= ends[1] <= START_um16[1]:
        raise _refuse(program, place, "reaches outside -2 to 20 mm", "shorten it")


def _check_bias(program: Program, state: State, limits: Limits) -> None:
    bias_cN = max(abs(b + limits.weight_cN) for b in state.biases_cN())
    if bias_cN > limits.force_cN:
        reason = f"a bias of {force_text(bias_cN)}, the rig gives {force_number(limits.force_cN)}"
        raise _refuse(program, f"state {state.name!r}", reason, "weaken it")


def _convert(program: Program, signal: Signal, convert: Converter) -> ConvertedVibration:
    try:
        return convert(signal.vibration())
    except ModelError as error:
        raise _refuse(program, f"signal {signal.name!r}", str(error), "weaken or shorten it") from error


def _check_waves(program: Program, converted: Sequence[ConvertedVibration]) -> None:
    samples = sum(len(c.slot.wave) for c in converted)
    if samples > POOL_BYTES:
        reason = f"{samples} samples of sampled signals, the vibration board holds {POOL_BYTES}"
        raise _refuse(program, "signals", reason, "use single modes of phase 0, which need none")


def _check_fit(program: Program, grids: Sequence[Grid], size_bytes: int, limits: Limits) -> None:
    for surface, grid in zip(program.surfaces, grids, strict=True):
        if grid.error_cN > limits.worst_grid_error_cN:
            reason = f"on {grid.columns} even columns it is {force_text(grid.error_cN, '.3g')} off"
            raise _refuse(program, f"surface {surface.name!r}", reason, "smooth its steps or shorten it")
    if size_bytes > IMAGE_BYTES:
        reason = f"{size_bytes} bytes with surfaces as coarse as allowed, a device holds {IMAGE_BYTES}"
        raise _refuse(program, "whole program", reason, "use fewer or smoother surfaces, or fewer velocities")
