"""The vibration of one stroke at one velocity, pooled over its presses; each figure with its spread."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model.bump import find_bump
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv.vibration.damped import DampedMode
from fdvv.vibration.ring import Ring, fit_ring
from fdvv.vibration.snap import HeardPress, NotFound, Snap, find_snap

mJ_PER_cN_mm = 0.01
"""1 cN mm = 10 mN x 1 mm = 0.01 mJ."""
BEFORE_ratio, AFTER_ratio = 0.25, 1.25
"""A leaf lands once the force has fallen, at the valley of a press or past it, and is struck past that of a
release; in lengths of the fall."""
LEAST_SHARE = 0.5
"""A snap that fewer presses show is not one of the button's."""
ROUNDS = 2
"""Searches with the modes of the search before; none where two modes were known beforehand."""
SAME_ratio = 0.15
"""Frequencies within this part of each other are one mode of the housing."""
KNOWN_ratio, FREE_ratio, APART_ratio = 0.02, 0.3, 1.4
"""A mode to build on: frequency known to this part, damping below this part of critical (a fading drive is no
mode), and frequency apart from that of the first."""


@dataclass(frozen=True)
class SnapEnergy:
    """The fall of force that drives a snap.

    Attributes
    ----------
    drop_cN : from peak to valley.
    energy_mJ : set free between them, the area between the peak's force and the curve.
    peak_mm, valley_mm : where it falls.
    """

    drop_cN: float
    energy_mJ: float
    peak_mm: float
    valley_mm: float

    @property
    def window_mm(self) -> tuple[float, float]:
        """Where the snap is looked for: from a quarter of the fall before the valley to 1.25 past it."""
        length = self.valley_mm - self.peak_mm
        return self.valley_mm - BEFORE_ratio * length, self.valley_mm + AFTER_ratio * length


def snap_energy(
    displacement_mm: npt.ArrayLike, force_cN: npt.ArrayLike, least_drop_cN: float | None = None
) -> SnapEnergy | None:
    """Measure the energy that the fall of force sets free; None where it hardly falls.

    displacement_mm, force_cN : (n,) one stroke, displacement strictly rising (turn a release round), contact
        and stop left out.
    least_drop_cN : a smaller fall is friction; that of a bump (find_bump) if None.

    A finger that keeps pressing with the force of the peak gains what the button no longer takes: the area
    between the peak's force and the curve from peak to valley, in mJ.
    """
    x, force = (np.asarray(v, dtype=np.float64) for v in (displacement_mm, force_cN))
    if x.shape != force.shape or x.ndim != 1 or x.size < 3 or np.any(np.diff(x) <= 0):
        raise ModelError(
            f"a stroke needs forces at 3 or more rising displacements, got {x.shape}, {force.shape}"
        )
    bump = find_bump(x, force) if least_drop_cN is None else find_bump(x, force, least_drop_cN)
    if bump is None:
        return None
    fall = (x >= bump.peak_mm) & (x <= bump.valley_mm)
    given = np.trapezoid(bump.peak_cN - force[fall], x[fall]) * mJ_PER_cN_mm
    return SnapEnergy(bump.drop_cN, max(float(given), 0.0), bump.peak_mm, bump.valley_mm)


@dataclass(frozen=True)
class Measured:
    """A figure and its spread: standard deviation over presses, or standard error, as its owner says."""

    value: float
    sd: float


@dataclass(frozen=True, eq=False)
class MeasuredVibration:
    """The snap of one stroke at one velocity, measured from its presses.

    Attributes
    ----------
    stroke, velocity_mm_s : of all the presses; the pace that was asked for.
    energy : the fall of force that drives it.
    onset_mm : median, and the spread over presses (scaled from the median deviation).
    snap_velocity_mm_s : of the cap at the onset: median and spread over presses.
    shown, presses : presses that showed it, and all.
    heard, snaps : the presses that showed it, and where.
    ring : its modes, or why they could not be identified.
    acceleration : the sensor gives acceleration, not velocity.
    """

    stroke: Stroke
    velocity_mm_s: float
    energy: SnapEnergy
    onset_mm: Measured
    snap_velocity_mm_s: Measured
    shown: int
    presses: int
    heard: tuple[HeardPress, ...]
    snaps: tuple[Snap, ...]
    ring: Ring | NotFound
    acceleration: bool

    @property
    def amplitude(self) -> Measured | None:
        """Return the principal mode's amplitude in the signal's unit, median and spread, or None."""
        return None if isinstance(self.ring, NotFound) else _median(self.ring.amplitudes[:, 0])

    @property
    def rings(self) -> tuple[tuple[float, float], ...]:
        """Return frequency and decay of the modes that measure_vibration() of other presses can build on."""
        return reliable_rings(self.ring)

    def rings_in(self, frequency_Hz: float) -> bool:
        return any(abs(f / frequency_Hz - 1) <= SAME_ratio for f, _ in self.rings)

    @property
    def duration_s(self) -> Measured | None:
        """Return the time to a tenth of the amplitude, with its standard error; None if unknown."""
        if isinstance(self.ring, NotFound):
            return None
        return Measured(self.ring.duration_s, self.ring.duration_sd_s)

    def vibration(self, scale: float | None = None) -> Vibration:
        """Return the vibration as models hold it, its amplitudes as accelerations of the cap.

        scale : what the sensor gives per m/s (V s/m) or, of an accelerometer, per m/s2. Without it the unit
            of the signal says nothing of the cap: None is refused unless it is an acceleration in m/s2.

        Raises ModelError if the ring was not found or a microphone's scale is unknown.
        """
        if isinstance(self.ring, NotFound):
            raise ModelError(
                f"no vibration of {self.stroke} at {self.velocity_mm_s:g} mm/s: {self.ring.reason}"
            )
        if scale is None and not self.acceleration:
            raise ModelError(
                "the microphone's scale (V s/m) is unknown: state it, or set the amplitude by what is felt"
            )
        return Vibration(
            self.stroke,
            self.velocity_mm_s,
            self.onset_mm.value,
            self.ring.duration_s,
            tuple(
                _mode(m, float(np.median(sizes)) / (scale or 1.0), self.acceleration)
                for m, sizes in zip(self.ring.modes, self.ring.amplitudes.T, strict=True)
            ),
        )


def _mode(mode: DampedMode, amplitude: float, acceleration: bool) -> Mode:
    """Turn a mode of velocity into one of acceleration: times -d + i 2 pi f."""
    f, d = mode.frequency_Hz, mode.decay_1_s
    if acceleration:
        return Mode(f, amplitude, d, mode.phase_rad)
    factor = complex(-d, 2 * math.pi * f)
    return Mode(f, amplitude * abs(factor), d, mode.phase_rad + math.atan2(factor.imag, factor.real))


def _beside(
    own: Sequence[tuple[float, float]], known: Sequence[tuple[float, float]]
) -> tuple[tuple[float, float], ...]:
    """Return two modes at most: own ones, then known ones apart from them."""
    more = [k for k in known if all(not 1 / APART_ratio < k[0] / f < APART_ratio for f, _ in own)]
    return tuple([*own, *more][:2])


def reliable_rings(ring: Ring | NotFound) -> tuple[tuple[float, float], ...]:
    """Return frequency and decay of the principal mode and of the surest other, if known well enough."""
    if isinstance(ring, NotFound):
        return ()
    sure = [
        mode
        for mode in ring.heard
        if mode.frequency_sd_Hz < KNOWN_ratio * mode.frequency_Hz
        and mode.decay_1_s < FREE_ratio * 2 * math.pi * mode.frequency_Hz
    ]
    apart = [m for m in sure[1:] if not 1 / APART_ratio < m.frequency_Hz / sure[0].frequency_Hz < APART_ratio]
    apart.sort(key=lambda mode: mode.frequency_sd_Hz / mode.frequency_Hz)
    return tuple((mode.frequency_Hz, mode.decay_1_s) for mode in [*sure[:1], *apart[:1]])


def measure_vibration(
    presses: Sequence[HeardPress],
    velocity_mm_s: float,
    energy: SnapEnergy | None,
    acceleration: bool = False,
    rings: Sequence[tuple[float, float]] = (),
) -> MeasuredVibration | NotFound:
    """Measure onset, frequency, decay, duration and amplitude of the snap of one stroke at one velocity.

    presses : all of one stroke.
    energy : of the force curve of that stroke, from snap_energy(); None where its force does not fall: then
        there is no snap to look for.
    acceleration : the signal is an acceleration, not a velocity.

    rings : frequency (Hz) and decay (1/s) of modes that this button is known to ring in, as other velocities
        or the other stroke gave (MeasuredVibration.rings); they sharpen the search.

    Each press is searched by itself; the modes that the pooled presses ring in then sharpen the search. The
    ring is fitted to all presses together.
    """
    if not presses or any(press.stroke is not presses[0].stroke for press in presses):
        raise ModelError("a vibration is measured from one or more presses, all of one stroke")
    if energy is None:
        return NotFound("force does not fall between contact and bottom-out: there is no snap to look for")
    looked = [find_snap(press, energy.window_mm, rings) for press in presses]
    heard, snaps = _pairs_with_snap(presses, looked)
    ring = fit_ring(heard, snaps, acceleration) if snaps else NotFound("no press shows a snap")
    for _ in range(0 if len(rings) > 1 else ROUNDS):
        known = _beside(reliable_rings(ring), rings)
        # known modes part beginning from going on only where a sample is short beside their periods
        if not known or 8 * presses[0].period_s * max(f for f, _ in known) > 1:
            break
        again = [find_snap(press, energy.window_mm, known) for press in presses]
        if len(_pairs_with_snap(presses, again)[0]) < len(heard):
            break
        before, looked = [snap.onset_s for snap in snaps], again
        heard, snaps = _pairs_with_snap(presses, looked)
        if before == [snap.onset_s for snap in snaps]:
            break
        ring = fit_ring(heard, snaps, acceleration)
    if len(snaps) < LEAST_SHARE * len(presses):
        reasons = [snap.reason for snap in looked if isinstance(snap, NotFound)]
        return NotFound(f"{len(snaps)} of {len(presses)} presses show a snap; of the others: {reasons[0]}")
    place, speed = (
        _median(np.array([getattr(snap, name) for snap in snaps])) for name in ("onset_mm", "velocity_mm_s")
    )
    what = presses[0].stroke, velocity_mm_s, energy, place, speed, len(snaps), len(presses)
    return MeasuredVibration(*what, tuple(heard), tuple(snaps), ring, acceleration)


def _pairs_with_snap(
    presses: Sequence[HeardPress], looked: Sequence[Snap | NotFound]
) -> tuple[list[HeardPress], list[Snap]]:
    pairs = [(press, snap) for press, snap in zip(presses, looked, strict=True) if isinstance(snap, Snap)]
    return [press for press, _ in pairs], [snap for _, snap in pairs]


def _median(values: FloatArray) -> Measured:
    """Return the median, and the spread from the median deviation, which a few outliers do not move."""
    middle = float(np.median(values))
    return Measured(middle, 1.4826 * float(np.median(np.abs(values - middle))))
