"""Just noticeable differences (JND) of force and vibration at a finger, each with where it comes from.

One JND is the difference that three of four comparisons notice. No study measured whole strokes of
push-buttons against each other; what is taken over from elsewhere is marked as an assumption.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.units import FloatArray

FORCE_jnd_ratio, FORCE_floor_cN = 0.07, 30.0
SUDDEN_jnd_cN = 10.0
"""What was noticed on push-buttons: a sudden change in the middle of the stroke."""
THRESHOLD_um, BEST_Hz = 0.2, 250.0
LOWEST_Hz, HIGHEST_Hz = 40.0, 1000.0
"""Beyond which the threshold of vibration is held: other receptors take over, or none."""
HEARD_s = 0.2
"""Over which vibration adds up in the skin: some 3 dB per doubling up to there (Verrillo 1965)."""
VIBRATION_jnd_ratio = 0.17
FREQUENCY_jnd_ratio = 0.2
ONSET_jnd_ms = 5.5


@dataclass(frozen=True)
class JndSource:
    """Where a JND comes from.

    Attributes
    ----------
    of : what differs. value : the JND. source : who measured what. assumed : what goes beyond the source.
    """

    of: str
    value: str
    source: str
    assumed: str


SOURCES = (
    JndSource(
        "force",
        f"{100 * FORCE_jnd_ratio:.0f} % of (force + {FORCE_floor_cN:g} cN)",
        "Pang, Tan and Durlach 1991: 7 % at 2.5 to 10 N and 25 to 160 mm/s, two plates squeezed; "
        "Doerrer and Werthschützky 2002, on push-buttons: a sudden change in the middle of the stroke was "
        "noticed above 10 cN, at 50 to 250 cN",
        "the 30 cN, so that the ratio grows below 1 N; it gives 5.6 cN at 50 cN, half of what was found on "
        "push-buttons",
    ),
    JndSource(
        "vibration, faintest",
        f"{THRESHOLD_um:g} µm at {BEST_Hz:g} Hz, 12 dB per octave away from it",
        "Verrillo 1963 (after Gescheider and Verrillo 1979): falling by 12 dB per octave from 40 Hz to the "
        "minimum at 250 Hz, on the thumb's base",
        "the fingertip's 0.2 µm (0.1 to 0.3 are quoted; pressing harder lowers it, Papetti et al. 2017), the "
        "same slope above 250 Hz, and that energy adds up over 0.2 s",
    ),
    JndSource(
        "vibration, strength",
        f"{100 * VIBRATION_jnd_ratio:.0f} % of an amplitude well above the faintest, more near it",
        "Forta, Griffin and Morioka 2012, on the thumb's base and the forearm: 20 % (125 Hz, 10 dB above "
        "threshold) to 58 % (10 Hz, 20 dB); Hatzfeld and Werthschützky 2012: 20 dB on average near threshold",
        "17 % (1.4 dB), stricter than both",
    ),
    JndSource(
        "vibration, frequency",
        f"{100 * FREQUENCY_jnd_ratio:.0f} %",
        "",
        "no source was read; 18 to 20 % are quoted",
    ),
    JndSource(
        "vibration, onset",
        f"{ONSET_jnd_ms:g} ms",
        "Hachisu and Kajimoto 2017: a vibration that followed the tap of a rod later than that was noticed",
        "that it holds for a button's snap, and for one that comes early",
    ),
)


def force_jnd_cN(force_cN: npt.ArrayLike) -> FloatArray:
    """Return the JND of a force of either sign, in the shape given."""
    return np.asarray(FORCE_jnd_ratio * (np.abs(np.asarray(force_cN, dtype=np.float64)) + FORCE_floor_cN))


def vibration_threshold_um(
    frequency_Hz: npt.ArrayLike, least_um: float = THRESHOLD_um, best_Hz: float = BEST_Hz
) -> FloatArray:
    """Return the faintest amplitude that is felt: lowest at best_Hz, 12 dB per octave away from it."""
    ratio = np.clip(np.asarray(frequency_Hz, dtype=np.float64), LOWEST_Hz, HIGHEST_Hz) / best_Hz
    return np.asarray(least_um * 0.5 * (ratio**2 + ratio**-2))


def vibration_steps(above: npt.ArrayLike, ratio: float = VIBRATION_jnd_ratio) -> FloatArray:
    """Return JNDs between nothing and vibrations: about one at threshold, one per ratio far above it.

    above : amplitude over the faintest that is felt.
    """
    return np.asarray(np.log1p(ratio * np.asarray(above, dtype=np.float64)) / ratio)


def acceleration_above_threshold(acceleration_m_s2: FloatArray, rate_Hz: float) -> float:
    """Return by how much a vibration of the cap exceeds the faintest that is felt: 1 at threshold.

    acceleration_m_s2 : (n,) at an even rate. Only 40 to 1000 Hz count; energy adds up over 0.2 s.
    """
    size = 1 << int(np.ceil(np.log2(max(acceleration_m_s2.size, rate_Hz / 4))))
    frequency_Hz = np.fft.rfftfreq(size, 1 / rate_Hz)
    felt = (frequency_Hz >= LOWEST_Hz) & (frequency_Hz <= HIGHEST_Hz)
    at_Hz = frequency_Hz[felt]
    moved_um = 1e6 * np.abs(np.fft.rfft(acceleration_m_s2, size)[felt]) / rate_Hz / (2 * np.pi * at_Hz) ** 2
    # twice: an amplitude is the root of twice the mean square, and the spectrum has two sides
    energy = 4 * float(np.sum((moved_um / vibration_threshold_um(at_Hz)) ** 2)) * rate_Hz / size
    return float(np.sqrt(energy / HEARD_s))
