"""Can these strokes be a push-button's? Each bound with what it was taken from.

"Real files" are 1,107 readable ones, some in two layouts: all of HaaTa, bluepylons and BuddyOG, a quarter of
ThereminGoat, some of Geekboards and joaoachando. Switches, domes, buckling and bare springs,
latching and magnetic keys. A bound lies beyond all of them; a stranger button is accepted when asked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.force_text import force_number, force_text, force_unit
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.fit import CurveFit, FitMethod
from fdvv.model.residual import noise_cN

OPTION = "--accept-implausible"

TRAVEL_mm = (0.1, 15.0)
"""Real files: 1.49 to 9.7 mm. Data sheets: metal domes 0.15 to 0.35 mm, arcade and piano keys up to 10 mm."""

MEAN_cN = (10.0, 500.0)
"""Of a press, or of a release alone, over its travel. Real files: 11.9 (a bare spring) to 332 cN (Cherry MX
Mega Black). Ounces taken for grams of force are 28 times more, pounds 454 times, newtons 102 times,
millinewtons 10 times less."""

PEAK_cN, WHOLE_cN = 2000.0, 4000.0
"""Up to the stop, and with it. Real files: 1012 cN where the stop's start was missed; benches go on to 200,
255 or 1200 gf. Fingers type with 60 to 250 cN."""

RANGE_ratio = 0.05
"""Range of the force over its greatest. Real files: 0.79 and more for a press, 0.1 for the release of a bare
spring of which the file holds the last millimetre; a load cell that hangs has none."""

NOISE_ratio, COARSE_ratio, COARSE_samples = 0.03, 0.2, 100
"""Noise over the range of the force; of fewer samples a bump looks like noise. Real files: at most 0.0135;
noise alone has 0.3."""

MISFIT_ratio = 0.05
"""RMSE of 15 or more free control points over the range of the force. Real files: at most 0.022."""
MISFIT_POINTS = 15  # the paper's number; fewer may miss a shape that is real

LOSS_ratio = (-0.05, 0.95)
"""Part of the work of the press that the release does not give back. A button has no motor, so below zero the
columns are out of step or the strokes exchanged. Real files: -0.023 (noise of a bare spring) to 0.75."""

STOP_APART_mm = 0.25
"""How much earlier a release may leave the stop than the press reaches it. Real files: at most 0.18 mm."""

END_DROP_ratio = {Stroke.PRESS: 0.4, Stroke.RELEASE: 0.6}
"""How far a stroke falls at its deepest place below its greatest force, over that force. A stop is left when
the stage turns, not before. Real files: at most 0.084 on the press, 0.34 on the release."""

BEGINS_cN, FURTHER_mm = 10.0, 0.5
"""A press that begins with more force than this while its release goes on further than this was cut at its
start. Real files: never both; 0.2 mm with more force."""

CYCLES_ratio = 1.15
"""Greatest over least typical force, and travel, of the cycles of one run. Repeats agree to 2 %; no real file
holds two buttons in one pair of columns."""

FRAGMENT_mm = 1.0
"""A press without a stop and without a release is a fragment below this. Real files: all have one of both."""

MISSING_mm, MISSING_steps = 0.5, 20.0
"""A stretch of the travel without a sample, longer than this and than so many steps. Real files: 0.33 mm."""

FASTEST_mm_s = 2000.0
"""Keystrokes reach 640 mm/s (10 to 90 % of the travel in 5 ms)."""


@dataclass(frozen=True)
class Implausible:
    """Why strokes are doubted: where, what is wrong, and what may be the cause and its remedy."""

    place: str
    reason: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.place}: {self.reason}"


UNITS = "check the units in the header"
COLUMNS = "check which column is which, and its units"
ROWS = "check that force and displacement of a row belong together"


def implausible_strokes(strokes: Sequence[MeasuredCurve], stop_found: bool) -> Iterator[Implausible]:
    """Find what cannot be in strokes cut from contact to bottom-out; the likeliest cause first.

    strokes : in the displacement of the model. stop_found : whether the first of them reached its stop.
    """
    for stroke in strokes:
        yield from _of_stroke(str(stroke.stroke), stroke)
        if stroke.stroke is strokes[0].stroke and np.ptp(stroke.displacement_mm) > 0:
            yield from _of_mean(str(stroke.stroke), stroke)
    if len(strokes) == 1 and not stop_found and np.ptp(strokes[0].displacement_mm) < FRAGMENT_mm:
        travel = f"ends after {np.ptp(strokes[0].displacement_mm):.2f} mm without a stop or a release"
        yield Implausible(str(strokes[0].stroke), travel, "check that the file is whole")
    for press in strokes:
        for release in strokes:
            pair = (press.stroke, release.stroke) == (Stroke.PRESS, Stroke.RELEASE)
            if pair and press.velocity_mm_s == release.velocity_mm_s:
                yield from _of_pair(press, release)


def _of_stroke(where: str, stroke: MeasuredCurve) -> Iterator[Implausible]:
    x, force, _ = stroke.by_displacement()
    if x.size < 2:
        yield Implausible(where, "has one displacement between contact and bottom-out", COLUMNS)
        return
    travel, highest, span = float(x[-1] - x[0]), float(force.max()), float(np.ptp(force))
    if not TRAVEL_mm[0] <= travel <= TRAVEL_mm[1]:
        yield Implausible(where, f"travels {travel:.4g} mm, not {_range(TRAVEL_mm)} mm", COLUMNS)
    step = np.diff(x)
    if step.max() > max(MISSING_mm, MISSING_steps * float(np.median(step))):
        reason = f"{step.max():.2f} mm of its travel are missing from {x[int(np.argmax(step))]:.2f} mm on"
        yield Implausible(where, reason, "check that the file is whole")
    if highest > PEAK_cN:
        yield Implausible(
            where, f"the force reaches {force_text(highest, '.4g')}, more than {force_number(PEAK_cN)}", UNITS
        )
    if span < RANGE_ratio * highest:
        reason = (
            f"the force hardly changes, from {force_number(highest - span, '.4g')} to "
            f"{force_text(highest, '.4g')}"
        )
        yield Implausible(where, reason, "check the load cell and the force column")
    noise = noise_cN(force)
    if noise > (NOISE_ratio if x.size >= COARSE_samples else COARSE_ratio) * span:
        reason = (
            f"the force jumps by {force_text(noise, '.3g')} (RMS) from sample to sample, over a range of "
            f"{force_text(span, '.4g')}"
        )
        yield Implausible(where, reason, ROWS)
    if stroke.velocity_mm_s is not None and stroke.velocity_mm_s > FASTEST_mm_s:
        reason = f"its speed is {stroke.velocity_mm_s:.4g} mm/s, more than {FASTEST_mm_s:g}"
        yield Implausible(where, reason, "check the unit of time")


def _of_mean(where: str, stroke: MeasuredCurve) -> Iterator[Implausible]:
    x, force, _ = stroke.by_displacement()
    mean = float(np.trapezoid(force, x) / (x[-1] - x[0]))
    if not MEAN_cN[0] <= mean <= MEAN_cN[1]:
        yield Implausible(
            where,
            f"the mean force is {force_text(mean, '.4g')}, not {' to '.join(map(force_number, MEAN_cN))} "
            f"{force_unit()}",
            UNITS,
        )


def _of_pair(press: MeasuredCurve, release: MeasuredCurve) -> Iterator[Implausible]:
    (x, force, _), (back_x, back, _) = press.by_displacement(), release.by_displacement()
    grid = np.linspace(max(x[0], back_x[0]), min(x[-1], back_x[-1]), 400)
    if grid[0] >= grid[-1]:
        yield Implausible("release", "shares no displacement with the press", ROWS)
        return
    if x[-1] - back_x[-1] > STOP_APART_mm:
        reason = f"leaves the stop {x[-1] - back_x[-1]:.2f} mm before where the press reaches it"
        yield Implausible("release", reason, ROWS)
    put_in = float(np.trapezoid(np.interp(grid, x, force), grid))
    loss = 1 - float(np.trapezoid(np.interp(grid, back_x, back), grid)) / put_in
    if loss < LOSS_ratio[0]:
        reason = f"gives back {100 * -loss:.0f} % more work than the press put in"
        yield Implausible(
            "release", reason, "check which stroke is which, and " + ROWS.removeprefix("check ")
        )
    elif loss > LOSS_ratio[1]:
        yield Implausible("release", f"gives back only {100 * (1 - loss):.0f} % of the work", ROWS)


def implausible_whole(stroke: MeasuredCurve) -> Iterator[Implausible]:
    """Find what cannot be in a whole stroke, air and stop included."""
    _, force, _ = stroke.by_displacement()
    highest = float(force.max())
    if highest > WHOLE_cN:
        reason = (
            f"the force reaches {force_text(highest, '.4g')} in the stop, more than {force_number(WHOLE_cN)}"
        )
        yield Implausible(str(stroke.stroke), reason, UNITS)
    drop = highest - float(force[-1])
    if drop > END_DROP_ratio[stroke.stroke] * highest:
        reason = f"the force falls by {force_text(drop, '.4g')} before the deepest displacement"
        yield Implausible(f"deep end of the {stroke.stroke}", reason, ROWS)


def implausible_start(press: MeasuredCurve, release: MeasuredCurve) -> Iterator[Implausible]:
    """Find a whole press whose beginning is missing, by its release."""
    further = float(press.displacement_mm[0] - release.displacement_mm[0])
    force_cN = float(press.by_displacement()[1][0])
    if further > FURTHER_mm and force_cN > BEGINS_cN:
        reason = f"begins at {force_text(force_cN, '.4g')}, and the release goes on for {further:.2f} mm"
        yield Implausible("press", reason, "check that the file is whole")


def implausible_cycles(cycles: Sequence[MeasuredCurve]) -> Iterator[Implausible]:
    """Find cycles of one run that cannot be of one button."""
    figures = {
        "force": [float(np.median(c.force_cN[c.force_cN >= 0.2 * c.force_cN.max()])) for c in cycles],
        "range of displacement": [float(np.ptp(c.displacement_mm)) for c in cycles],
    }
    for what, values in figures.items():
        if values and max(values) > CYCLES_ratio * max(min(values), 1e-9):
            ends = (min(values), max(values))
            low, high = (force_number(v, ".3g") if what == "force" else f"{v:.3g}" for v in ends)
            units = "mm" if what != "force" else force_unit()
            reason = f"the {what} of its cycles goes from {low} to {high} {units}"
            yield Implausible("run", reason, "put each button in a file of its own")


def implausible_fit(fit: CurveFit, measured: MeasuredCurve) -> Iterator[Implausible]:
    """Find a stroke that as many free control points as this cannot follow."""
    enough = fit.method is FitMethod.ADAPTIVE and fit.curve.control_points_cN.size >= MISFIT_POINTS
    span = float(np.ptp(measured.by_displacement()[1]))
    if enough and fit.smoothing_mm == 0 and fit.rmse_cN > MISFIT_ratio * span:
        reason = (
            f"no smooth curve follows it: RMSE {force_text(fit.rmse_cN, '.3g')} over a range of "
            f"{force_text(span, '.4g')}"
        )
        yield Implausible(str(fit.curve.stroke), reason, ROWS)


def _range(bounds: tuple[float, float]) -> str:
    return f"{bounds[0]:g} to {bounds[1]:g}"
