"""What comes of learning on a known rig: rows that are kept, and how every curve went."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.compensate._feed_forward import unrepeatable_cN
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._method import CurveOutcome, Job
from fdvv.compensate._paper import PaperLaw
from fdvv.compensate._rig_learning import Felt, Pair
from fdvv.compensate._rig_memory import RigMemory
from fdvv.compensate._shared_table import SharedTable
from fdvv.model import ForceSurface, Stroke

WORSE_ratio = 1.5
"""A last press this much worse than the best one of its speed says that learning went astray there: chance
alone, with presses as different as people make them, seldom does."""

Presses = tuple[tuple[tuple[Felt, Felt], ...], ...]
"""Per speed, each press on a known rig: press and release."""


def held_up(job: Job) -> ForceSurface:
    """Give the target as it is, with the least command that holds up a cap of unknown weight: the same start
    as the paper's law has.
    """
    target, limit = job.target, job.force_limit_cN
    press, release = (
        np.clip(np.maximum(rows, PaperLaw.hold_cN), -limit, limit)
        for rows in (target.press_cN, target.release_cN)
    )
    return ForceSurface(target.displacement_mm, target.velocity_mm_s, press, release)


def kept_rows(tables: Pair, felt: Presses) -> Pair:
    """Give the tables, with the row of the best press wherever the last press was far worse than that."""
    press, release = (
        _kept(table, [[pair[j] for pair in one] for one in felt]) for j, table in enumerate(tables)
    )
    return press, release


def _kept(table: SharedTable, felt: list[list[Felt]]) -> SharedTable:
    rows = table.rows_cN.copy()
    for at, made in enumerate(felt):
        better = _better(made)
        if better is not None:
            rows[at] = better.row_cN
    return replace(table, rows_cN=rows)


def _better(made: list[Felt]) -> Felt | None:
    """Give the best press of a speed if the last one was far worse; else None."""
    best = min(made, key=lambda one: one.error_cN, default=None)
    return best if best is not None and made[-1].error_cN > WORSE_ratio * best.error_cN else None


def curves_of(job: Job, felt: Presses, memory: RigMemory | None) -> tuple[CurveOutcome, ...]:
    """Tell how every curve went, all of the press first; expected errors where nothing was pressed."""
    speeds = job.target.velocity_mm_s
    expected = np.full((2, speeds.size), np.nan) if memory is None else memory.expected_cN(speeds)
    return tuple(
        _curve(stroke, float(speed), [pair[j] for pair in felt[i]], float(expected[j, i]))
        for j, stroke in enumerate(Stroke)
        for i, speed in enumerate(speeds)
    )


def _curve(stroke: Stroke, speed_mm_s: float, made: list[Felt], expected_cN: float) -> CurveOutcome:
    if not made:
        known = np.isfinite(expected_cN)
        left = f"{expected_cN:.1f} cN expected: what was left on the button that taught the rig"
        told = left if known else "not pressed"
        return CurveOutcome(stroke, speed_mm_s, (), expected_cN, float("nan"), told)
    errors = tuple(one.error_cN for one in made)
    better = _better(made)
    used = better or made[-1]
    told = f"error_k {errors[0]:.1f} cN at press 1, {errors[-1]:.1f} at press {len(made)}"
    told += "; the best table is kept, since the last press got worse" if better else ""
    return CurveOutcome(stroke, speed_mm_s, errors, used.mean_cN, used.max_cN, told)


def told_of(known: KnownRig, tables: tuple[Pair, Pair], felt: tuple[Felt, Felt], at: int) -> str:
    """Tell how a press of speed number ``at`` felt, and what it changed: tables before and after it."""
    (down, up), speed = felt, float(tables[0][0].speeds_mm_s[at])
    moved = [float(np.abs(new.rows_cN[at] - old.rows_cN[at]).max()) for old, new in zip(*tables, strict=True)]
    return (
        f"felt {down.mean_cN:.1f} cN off on the press, {up.mean_cN:.1f} on the release; moved them by up "
        f"to {moved[0]:.1f} and {moved[1]:.1f} cN; two such presses differ by about "
        f"{unrepeatable_cN(known, speed):.1f} cN"
    )
