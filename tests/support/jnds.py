"""JNDs as a study would have measured them."""

from __future__ import annotations

from fdvv.model.jnd_file import JndRecord, MeasuredJnd
from fdvv.model.noticeable import LITERATURE, Dimension

FALL_cN, ABOVE = 20.0, 6.0


def measured(dimension: Dimension, ratio: float, standard: float, above: float | None = None) -> MeasuredJnd:
    """Return a JND of 12 people at mx-clear, with an interval of a quarter either way."""
    unit = "m/s²" if dimension == "vibration" else "cN"
    about = ("MX Clear", "standard", standard, unit, ratio, ratio / 1.25, ratio * 1.25, 12, 648, above)
    return MeasuredJnd(dimension, *about)  # type: ignore[arg-type]


def as_literature(dimension: Dimension, times: float = 1.0, force_cN: float = 66.0) -> MeasuredJnd:
    """Return so many times the JND that the literature expects."""
    if dimension == "force":
        return measured("force", times * float(LITERATURE.force_cN(force_cN)) / force_cN, force_cN)
    if dimension == "snap":
        return measured("snap", times * LITERATURE.snap_cN / FALL_cN, FALL_cN)
    return measured("vibration", times * float(LITERATURE.vibration(ABOVE)) / ABOVE, 4.6, ABOVE)


def record_of(*jnds: MeasuredJnd, simulated: bool = False, share_correct: float = 0.75) -> JndRecord:
    """Return the file of a study called weights."""
    return JndRecord(
        format="fdvv-jnds",
        version=1,
        study="weights",
        kind="thresholds",
        fingerprint="0123-4567-89ab-cdef",
        simulated=simulated,
        task="Which one feels stronger?",
        share_correct=share_correct,
        velocity_mm_s=100.0,
        people=12,
        trials=648,
        jnds=list(jnds),
    )
