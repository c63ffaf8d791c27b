"""Hypothesis strategies of valid knots, curves, vibrations and models."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.spread import CurveSpread, ModeSpread, PointSpread, VibrationSpread
from fdvv.model.velocity import Interpolation
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray

forces_cN = st.floats(-100, 300, allow_subnormal=False)
velocities_mm_s = st.floats(0.01, 1000, allow_subnormal=False)
names = st.text(st.characters(codec="utf-8", exclude_categories=["C", "Z"]), min_size=1, max_size=12)
sentences = st.text(st.characters(codec="utf-8"), max_size=30)


@st.composite
def knots(draw: st.DrawFn, degree: int) -> FloatArray:
    """Draw clamped knots of 4 mm; an inner one repeats up to degree times, so that curves are continuous."""
    spans = draw(st.lists(st.floats(0.05, 1.0), min_size=1, max_size=8))
    places = 4.0 * np.cumsum(spans) / np.sum(spans)
    repeats = [draw(st.integers(1, degree)) for _ in places[:-1]]
    return np.concatenate([np.zeros(degree + 1), np.repeat(places[:-1], repeats), np.full(degree + 1, 4.0)])


deviations = st.floats(0, 100, allow_subnormal=False)
maybe = st.one_of(st.none(), deviations)
presses = st.integers(2, 200)
point_spreads = st.builds(PointSpread, deviations, presses)


@st.composite
def curve_spreads(draw: st.DrawFn) -> CurveSpread:
    """Draw the spread of a curve at two to twenty places."""
    steps = draw(st.lists(st.floats(1e-3, 0.5), min_size=2, max_size=20))
    spread_cN = draw(st.lists(deviations, min_size=len(steps), max_size=len(steps)))
    achieved = draw(st.one_of(st.none(), velocities_mm_s))
    return CurveSpread(np.cumsum(steps), np.array(spread_cN), draw(presses), achieved, draw(maybe))


@st.composite
def curves(
    draw: st.DrawFn,
    stroke: Stroke | None = None,
    velocity_mm_s: float | None = 50.0,
    degree: int | None = None,
) -> ForceCurve:
    """Draw a curve from 0 to 4 mm."""
    k = degree or draw(st.integers(1, 5))
    t = draw(knots(k))
    n = t.size - k - 1
    c = np.array(draw(st.lists(forces_cN, min_size=n, max_size=n)))
    spread = draw(st.one_of(st.none(), curve_spreads()))
    return ForceCurve(stroke or draw(st.sampled_from(Stroke)), velocity_mm_s, k, t, c, spread)


@st.composite
def vibrations(draw: st.DrawFn, stroke: Stroke, velocity_mm_s: float | None) -> Vibration:
    """Draw a vibration of one to three modes."""
    mode = st.builds(
        Mode, st.floats(1, 5000), st.floats(-100, 100), st.floats(0, 1000), st.floats(-np.pi, np.pi)
    )
    modes = tuple(draw(st.lists(mode, min_size=1, max_size=3)))
    of_modes = st.lists(st.builds(ModeSpread, maybe, maybe, maybe), min_size=len(modes), max_size=len(modes))
    spreads = st.builds(VibrationSpread, presses, maybe, maybe, st.one_of(st.just(()), of_modes))
    spread = draw(st.one_of(st.none(), spreads))
    return Vibration(stroke, velocity_mm_s, draw(st.floats(-1, 5)), draw(st.floats(1e-4, 1)), modes, spread)


@st.composite
def models(draw: st.DrawFn) -> FDVVModel:
    """Draw a model with a few curves per stroke, or one of unknown velocity, and a few vibrations."""
    known: st.SearchStrategy[list[float | None]] = st.lists(velocities_mm_s, max_size=4, unique=True)
    speeds = st.one_of(known, st.just([None]))
    found: list[ForceCurve] = [draw(curves(Stroke.PRESS, v)) for v in draw(speeds)]
    found += [draw(curves(Stroke.RELEASE, v)) for v in draw(speeds)]
    travel_mm = draw(st.floats(0.1, 10))
    point = st.one_of(st.none(), st.floats(0, travel_mm))
    actuation_mm, reset_mm = draw(point), draw(point)
    spread = st.one_of(st.none(), point_spreads)
    return FDVVModel(
        name=draw(names),
        travel_mm=travel_mm,
        curves=tuple(found) or (draw(curves()),),
        actuation_mm=actuation_mm,
        reset_mm=reset_mm,
        vibrations=tuple(draw(vibrations(s, v)) for s in Stroke for v in draw(speeds)),
        interpolation=draw(st.sampled_from(Interpolation)),
        provenance=draw(provenances),
        travel_spread=draw(spread),
        actuation_spread=None if actuation_mm is None else draw(spread),
        reset_spread=None if reset_mm is None else draw(spread),
    )


provenances = st.builds(
    Provenance,
    source=sentences,
    licence=sentences,
    citation=sentences,
    method=sentences,
    assumptions=st.lists(sentences, max_size=3).map(tuple),
    simulated=st.booleans(),
)
