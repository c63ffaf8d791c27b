"""The drive that makes the cap's acceleration be a vibration: a regularised inverse with bounded gain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Vibration
from fdvv.units import FloatArray
from fdvv.vibration._exciter import FULL_SCALE_V, LIMIT_V, KnownExciter
from fdvv.vibration._likeness import correlation

RATE_Hz = 16_000.0
"""At which the vibration board gives samples."""
WAVE_Hz = 65_535 / 16
WAVE_SAMPLES = 512
"""The fastest and the longest wave that it interpolates."""
RING_s = 0.03
"""Looked at beyond the drive's end: whatever rings on counts as error."""
STEPS = tuple(2.0**n for n in range(12))
"""Where the drive would exceed its limit, the inverse is bounded more tightly by these factors."""


@dataclass(frozen=True)
class InverseSettings:
    """How the drive is found.

    Attributes
    ----------
    gain_dB : how much more the inverse may boost anything than the vibration's own strongest frequency.
    limit_V : largest drive.
    lead_s : how long before the vibration the drive may begin; the cap cannot get rid of the momentum that it
        is left with at the end unless it swings back a little first.
    tail_s : how long after its end the drive may go on, to brake the magnet.
    """

    gain_dB: float = 15.0
    limit_V: float = LIMIT_V
    lead_s: float = 0.001
    tail_s: float = 0.004

    def __post_init__(self) -> None:
        if not (np.isfinite(self.gain_dB) and 0 < self.limit_V <= FULL_SCALE_V):
            raise ModelError(
                f"gain_dB must be finite and limit_V above 0 to {FULL_SCALE_V}, "
                f"got {self.gain_dB} and {self.limit_V}"
            )
        if not (0 <= self.lead_s <= 0.01 and 0 <= self.tail_s <= 0.05):
            raise ModelError(
                f"lead_s must be 0 to 0.01 and tail_s 0 to 0.05, got {self.lead_s} and {self.tail_s}"
            )


@dataclass(frozen=True, eq=False)
class Drive:
    """Volts for a vibration, and what they can achieve by the known exciter.

    Attributes
    ----------
    volts : (n,) at rate_Hz, straight lines between, 0 before and after; positive moves the cap inward if the
        exciter's leads are so.
    lead_s : how much of it comes before the vibration.
    likeness : of the acceleration expected to the vibration: correlation at any delay.
    strength_ratio : of the expected acceleration along the vibration's shape to what was asked; below 1 where
        the limit of the volts or of the gain was met.
    """

    volts: FloatArray
    rate_Hz: float
    lead_s: float
    likeness: float
    strength_ratio: float


def drive_for(exciter: KnownExciter, vibration: Vibration, settings: InverseSettings | None = None) -> Drive:
    """Find the drive whose acceleration of the cap is nearest to a vibration.

    Least squares in time over what the board can play: min ‖H w - a‖² + λ ‖w‖², the Wiener inverse for a
    drive of finite length. No direction is boosted by more than 1 / 2√λ, which is set gain_dB above 1 / |H|
    at the vibration's strongest frequency. A drive beyond the limit is weakened, and bounded more tightly
    where that is nearer to the vibration. Raises ModelError if the board cannot play such a wave.
    """
    chosen = settings or InverseSettings()
    length_s = chosen.lead_s + vibration.duration_s + chosen.tail_s
    rate_Hz = min(WAVE_Hz, (WAVE_SAMPLES - 1) / length_s)
    fastest_Hz = max(mode.frequency_Hz for mode in vibration.modes)
    if fastest_Hz >= rate_Hz / 2:
        raise ModelError(
            f"a drive of {length_s:g} s holds frequencies below {rate_Hz / 2:g} Hz, got {fastest_Hz:g} Hz; "
            "shorten it or leave out that mode"
        )
    wanted = _wanted(vibration, chosen.lead_s, round((length_s + RING_s) * RATE_Hz))
    drives = _hats(int(length_s * rate_Hz) + 1, rate_Hz, wanted.size)
    moves = acceleration_m_s2(exciter, drives)
    volts = _nearest(drives, moves, wanted, exciter, chosen)
    felt = moves @ volts
    power = float(wanted @ wanted)
    strength = float(felt @ wanted) / power if power else 0.0
    return Drive(volts, rate_Hz, chosen.lead_s, correlation(felt, wanted), strength)


def acceleration_m_s2(exciter: KnownExciter, volts: FloatArray) -> FloatArray:
    """Give the cap's acceleration for volts at 16 kHz, each column by itself; same shape, from rest."""
    count = volts.shape[0]
    size = 1 << int(np.ceil(np.log2(2 * count + RING_s * RATE_Hz)))
    response = exciter.response(np.fft.rfftfreq(size, 1 / RATE_Hz))
    # rows are faster to transform than columns
    found: FloatArray = np.fft.irfft(np.fft.rfft(np.ascontiguousarray(volts.T), size) * response, size)
    return found[..., :count].T


def _wanted(vibration: Vibration, lead_s: float, count: int) -> FloatArray:
    return vibration.acceleration_m_s2((np.arange(count) + 0.5) / RATE_Hz - lead_s)


def _hats(count: int, rate_Hz: float, rows: int) -> FloatArray:
    """Give what each sample of a wave does to the board's output, as its columns."""
    places = (np.arange(rows) + 0.5) / RATE_Hz * rate_Hz
    found: FloatArray = np.maximum(0.0, 1.0 - np.abs(places[:, None] - np.arange(count)))
    return found


def _nearest(
    drives: FloatArray, moves: FloatArray, wanted: FloatArray, exciter: KnownExciter, chosen: InverseSettings
) -> FloatArray:
    """Solve for the wave's samples: the tightest bound that is within 0.1 % of the nearest drive."""
    spectrum = np.abs(np.fft.rfft(wanted, 1 << 14))
    strongest_Hz = float(np.fft.rfftfreq(1 << 14, 1 / RATE_Hz)[np.argmax(spectrum)])
    bound = (abs(complex(exciter.response(strongest_Hz))) / (2 * 10 ** (chosen.gain_dB / 20))) ** 2
    power, size = moves.T @ moves, drives.T @ drives
    best: FloatArray = np.zeros(drives.shape[1])
    least = float(np.linalg.norm(wanted))
    margin = 1e-3 * least
    for step in STEPS:
        volts = np.asarray(np.linalg.solve(power + step * bound * size, moves.T @ wanted), dtype=np.float64)
        volts = volts * min(1.0, chosen.limit_V / max(float(np.abs(volts).max()), 1e-12))
        error = float(np.linalg.norm(moves @ volts - wanted))
        if error < least - margin:
            best, least = volts, error
    return best
