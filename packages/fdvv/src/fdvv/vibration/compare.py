"""A vibration on the cap beside the one asked for: onset, strength, spectrum, likeness, and JNDs.

Force alone moves the cap too, often more strongly than a vibration. So presses that play the vibration are
compared with silent ones of the same table: what they have more of, in energy, is the vibration. The part of
the motion that repeats with the speed is removed first (where the very same press was made both ways, as only
a simulated person can, the silent press itself), and from every press what is slower than half of the
vibration's slowest mode. Energies and not waveforms are averaged, because a vibration that starts by a
millisecond sooner or later would cancel itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.noticeable import LITERATURE, Jnds, LOWEST_Hz, acceleration_above_threshold
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray

RATE_Hz = 8000.0
AROUND_s = 0.01
"""Looked at before the onset and beyond the vibration's end; also the earliest and latest onset searched."""
BANDS_Hz = ((40.0, 100.0), (100.0, 200.0), (200.0, 400.0), (400.0, 800.0))
PERIODS = 1.0
"""Of the slowest mode that must lie within the stroke, else nothing is compared."""
FREQUENCY_periods = 3.0
"""Of the slowest mode after the onset, without which its frequency is not measured."""
CERTAIN_errors = 2.0
"""Standard errors that added energy must exceed, and the likeness it must have, to have an onset."""
ALIKE = 0.6  # assumed; the shape explains 36 % of what was added, with less the delay may be off by a period
FREQUENCY_ratios = np.geomspace(0.5, 3.2, 96)


@dataclass(frozen=True, eq=False)
class CapMotions:
    """Acceleration of the cap around the onset in some presses of one stroke.

    Attributes
    ----------
    acceleration_m_s2 : (presses, n) at RATE_Hz; column k lies k - before samples after the onset's place.
    speed_mm_s : (presses,) of the cap at the onset's place.
    before : samples before the onset.
    paired : row for row these are the presses that they are compared with, but for the vibration.
    """

    acceleration_m_s2: FloatArray
    speed_mm_s: FloatArray
    before: int
    paired: bool = False

    @property
    def since_s(self) -> FloatArray:
        """Time since the cap reached the onset, (n,)."""
        return (np.arange(self.acceleration_m_s2.shape[1]) - self.before) / RATE_Hz


@dataclass(frozen=True)
class VibrationError:
    """How a vibration came out, over several presses.

    Attributes
    ----------
    played : presses with it were compared; else only what the cap does without.
    asked_m_s2, own_m_s2, added_m_s2 : rms in each of BANDS_Hz: of the vibration asked for, of silent presses,
        and of what playing adds; the last is None if nothing was played.
    level_dB : energy added over energy asked for; None if nothing was played.
    own_dB : energy of the cap's own motion over energy asked for.
    onset_ms, onset_mm : late (positive) or early; None if nothing like the vibration was added.
    likeness : root of the part of the added energy that the shape asked for explains, at any strength and
        phase; 1 is the same shape.
    frequency_ratio : of the shape that explains most, over the one asked for; None without an onset, or if
        too little of it lies in the stroke.
    level_JND, onset_JND, frequency_JND : what a finger could notice; None where that was not measured.
    compared_ms : length of what is compared, after the onset.
    """

    played: bool
    asked_m_s2: tuple[float, ...]
    own_m_s2: tuple[float, ...]
    own_dB: float
    level_JND: float
    compared_ms: float
    added_m_s2: tuple[float, ...] | None = None
    level_dB: float | None = None
    onset_ms: float | None = None
    onset_mm: float | None = None
    likeness: float | None = None
    frequency_ratio: float | None = None
    onset_JND: float | None = None
    frequency_JND: float | None = None

    @property
    def total_JND(self) -> float:
        """The whole difference; the parts are taken to add up by their squares."""
        return float(np.linalg.norm([self.level_JND, self.onset_JND or 0.0, self.frequency_JND or 0.0]))


def least_s(vibration: Vibration) -> float:
    """Return how long after the onset a stroke must go on for anything to be compared."""
    return PERIODS / _slowest_Hz(vibration)


def compare_vibration(
    vibration: Vibration, silent: CapMotions, played: CapMotions | None, jnds: Jnds = LITERATURE
) -> VibrationError:
    """Compare what playing adds to silent presses with what was asked for.

    silent, played : of one stroke and speed, of one shape but for the number of presses. jnds : what the
    differences are counted in. Raises ModelError on different shapes.
    """
    if played is not None and (played.since_s.size, played.before) != (silent.since_s.size, silent.before):
        raise ModelError("presses with and without the vibration must be cut alike")
    comparison = _Comparison(vibration, silent, played, jnds)
    if played is None:
        return comparison.silent_error()
    return comparison.error()


def without_slow_motion(vibration: Vibration, since_s: FloatArray, rows: FloatArray) -> FloatArray:
    """Return signals, (presses, n), without what is slower than half of the vibration's slowest mode."""
    return _high_passed(rows, 0.5 * _slowest_Hz(vibration), float(since_s[-1] - since_s[0]))


def ripple_rms(signal: FloatArray) -> float:
    """Return the rms of a signal at RATE_Hz, (n,), within 40 to 800 Hz, in its own unit."""
    still = _high_passed(signal[None, :], BANDS_Hz[0][0], (signal.size - 1) / RATE_Hz)
    return float(np.sqrt(band_power(still).sum()))


def _high_passed(rows: FloatArray, above_Hz: float, length_s: float) -> FloatArray:
    """Remove a polynomial from every row; one of degree n over T follows what is slower than n / 2T."""
    degree = max(1, int(2 * above_Hz * length_s))
    along = np.linspace(-1.0, 1.0, rows.shape[1])
    motion = np.linalg.qr(np.polynomial.legendre.legvander(along, degree))[0]
    return np.asarray(rows - (rows @ motion) @ motion.T)


def band_power(signals: FloatArray) -> FloatArray:
    """Return the mean square of signals at RATE_Hz, (presses, n), in each of BANDS_Hz: (presses, bands)."""
    count = signals.shape[1]
    size = 1 << int(np.ceil(np.log2(max(count, RATE_Hz / 5))))
    frequency_Hz = np.fft.rfftfreq(size, 1 / RATE_Hz)
    power = 2 * np.abs(np.fft.rfft(signals, size, axis=1)) ** 2 / (size * count)
    bands = [(frequency_Hz >= low) & (frequency_Hz < high) for low, high in BANDS_Hz]
    return np.stack([power[:, band].sum(axis=1) for band in bands], axis=1)


class _Comparison:
    """One comparison; every signal without what is slower than half of the slowest mode."""

    def __init__(
        self, vibration: Vibration, silent: CapMotions, played: CapMotions | None, jnds: Jnds
    ) -> None:
        self._vibration, self._since_s, self._jnds = vibration, silent.since_s, jnds
        self._asked = self._still(vibration.acceleration_m_s2(self._since_s)[None, :])
        self._silent = self._still(silent.acceleration_m_s2)
        self._apart = _cross_validate(self._silent, silent.speed_mm_s)
        if played is not None and played.paired:
            self._apart = np.zeros_like(self._silent)
        self._played: FloatArray | None = None
        if played is not None:
            self._played = self._still(played.acceleration_m_s2) - self._without(silent, played)
            self._speed_mm_s = float(np.median(played.speed_mm_s))

    def _without(self, silent: CapMotions, played: CapMotions) -> FloatArray:
        """Return what the played presses would have been without the vibration."""
        if played.paired:
            return self._silent
        return _predict(self._silent, silent.speed_mm_s, played.speed_mm_s)

    def _still(self, rows: FloatArray) -> FloatArray:
        return without_slow_motion(self._vibration, self._since_s, rows)

    @cached_property
    def _powers(self) -> tuple[FloatArray, FloatArray]:
        return band_power(self._asked)[0], band_power(self._silent).mean(axis=0)

    def silent_error(self) -> VibrationError:
        asked, own = self._powers
        return VibrationError(
            played=False,
            asked_m_s2=_rms(asked),
            own_m_s2=_rms(own),
            own_dB=_dB(own, asked),
            level_JND=self._level_JND(0.0),
            compared_ms=1e3 * float(self._since_s[-1]),
        )

    def error(self) -> VibrationError:
        assert self._played is not None
        powers = [band_power(rows).mean(axis=0) for rows in (self._played, self._apart)]
        added = np.clip(powers[0] - powers[1], 0.0, None)
        onset_s, likeness = self._onset()
        error = replace(
            self.silent_error(),
            played=True,
            added_m_s2=_rms(added),
            level_dB=_dB(added, self._powers[0]),
            likeness=likeness,
            level_JND=self._level_JND(max(_excess_power(self._played) - _excess_power(self._apart), 0.0)),
        )
        if onset_s is None:
            return error
        late_ms = 1e3 * onset_s
        onset_JND = abs(late_ms) / self._jnds.onset_ms
        error = replace(error, onset_ms=late_ms, onset_mm=onset_s * self._speed_mm_s, onset_JND=onset_JND)
        if self._since_s[-1] - onset_s < FREQUENCY_periods / _slowest_Hz(self._vibration):
            return error
        ratio = self._frequency_ratio(onset_s)
        apart = abs(float(np.log(ratio))) / float(np.log1p(self._jnds.frequency_ratio))
        return replace(error, frequency_ratio=ratio, frequency_JND=apart)

    def _level_JND(self, added: float) -> float:
        """Compare what is felt, the cap's own motion included, with that motion and the vibration."""
        own, asked = _excess_power(self._silent), _excess_power(self._asked)
        steps = self._jnds.vibration_steps(np.sqrt([own + added, own + asked]))
        return abs(float(steps[0] - steps[1]))

    def _onset(self) -> tuple[float | None, float | None]:
        """Return when the shape starts that explains most of what was added, and its likeness."""
        assert self._played is not None
        energies = [np.sum(rows**2, axis=1) for rows in (self._played, self._apart)]
        added = float(energies[0].mean() - energies[1].mean())
        unsure = float(np.sqrt(sum(e.var(ddof=1) / e.size for e in energies if e.size > 1)))
        if added <= CERTAIN_errors * unsure or added <= 0:
            return None, None
        latest_s = min(AROUND_s, float(self._since_s[-1]) - least_s(self._vibration))
        delays_s = np.arange(-round(AROUND_s * RATE_Hz), round(latest_s * RATE_Hz) + 1) / RATE_Hz
        explained = np.array([self._energy_of_shape(float(delay_s)) for delay_s in delays_s])
        at = int(np.argmax(explained))
        likeness = float(np.sqrt(np.clip(explained[at] / added, 0.0, 1.0)))
        return (float(delays_s[at]) if likeness >= ALIKE else None), likeness

    def _frequency_ratio(self, onset_s: float) -> float:
        explained = [self._energy_of_shape(onset_s, float(ratio)) for ratio in FREQUENCY_ratios]
        return float(FREQUENCY_ratios[int(np.argmax(explained))])

    def _energy_of_shape(self, delay_s: float, ratio: float = 1.0) -> float:
        """Return the added energy that the shape explains with this delay, frequency, at any phase."""
        assert self._played is not None
        shapes = [_retune(self._vibration, ratio, phase) for phase in (0.0, np.pi / 2)]
        rows = np.stack([shape.acceleration_m_s2(self._since_s - delay_s) for shape in shapes])
        basis = np.linalg.qr(self._still(rows).T)[0]
        with_it, without = (np.mean(np.sum((x @ basis) ** 2, axis=1)) for x in (self._played, self._apart))
        return float(with_it - without)


def _retune(vibration: Vibration, ratio: float, phase_rad: float) -> Vibration:
    modes = tuple(
        replace(mode, frequency_Hz=ratio * mode.frequency_Hz, phase_rad=mode.phase_rad + phase_rad)
        for mode in vibration.modes
    )
    return replace(vibration, modes=modes, spread=None)


def _slowest_Hz(vibration: Vibration) -> float:
    return max(min(mode.frequency_Hz for mode in vibration.modes), LOWEST_Hz)


def _predict(rows: FloatArray, speed_mm_s: FloatArray, at_mm_s: FloatArray) -> FloatArray:
    """Return the motion that rows, (presses, n), let expect at other speeds: their mean, and its change."""
    middle = speed_mm_s.mean()
    columns = [np.ones_like(speed_mm_s), speed_mm_s - middle]
    # two presses tell nothing of a change with speed
    design = np.column_stack(columns if rows.shape[0] > 3 and np.ptp(speed_mm_s) > 0 else columns[:1])
    weights = np.linalg.lstsq(design, rows, rcond=None)[0]
    there = np.column_stack([np.ones_like(at_mm_s), at_mm_s - middle])[:, : design.shape[1]]
    return np.asarray(there @ weights)


def _cross_validate(rows: FloatArray, speed_mm_s: FloatArray) -> FloatArray:
    """Return each row less what the others let expect; a single row as it is."""
    if rows.shape[0] == 1:
        return rows
    residuals = np.empty_like(rows)
    for i in range(rows.shape[0]):
        others = np.arange(rows.shape[0]) != i
        residuals[i] = rows[i] - _predict(rows[others], speed_mm_s[others], speed_mm_s[i : i + 1])[0]
    return residuals


def _excess_power(rows: FloatArray) -> float:
    """Return the mean square of how far rows, (presses, n), lie above the faintest that is felt."""
    return float(np.mean([acceleration_above_threshold(row, RATE_Hz) ** 2 for row in rows]))


def _rms(power: FloatArray) -> tuple[float, ...]:
    return tuple(np.sqrt(power).tolist())


def _dB(power: FloatArray, reference: FloatArray) -> float:
    # 120 dB below is nothing
    return 10 * float(np.log10(max(power.sum() / reference.sum(), 1e-12)))
