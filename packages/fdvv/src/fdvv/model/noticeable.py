"""Just noticeable differences (JND) of force, snap, vibration and place at a finger: the one source of them.

One JND is the difference that three of four comparisons notice. No study that was read measured whole strokes
of push-buttons against each other; what is taken over from elsewhere is marked as an assumption. What a study
of thresholds or staircases measured of one's own people replaces it (fdvv.model.jnd_file).
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from fdvv.units import FloatArray

Dimension = Literal["force", "snap", "vibration"]
DIMENSIONS: tuple[Dimension, ...] = ("force", "snap", "vibration")

AT_JND = 0.6744897501960817
"""d' over the root of two at one JND: three of four comparisons are right there (Thurstone 1927)."""

THRESHOLD_um, BEST_Hz = 0.2, 250.0
LOWEST_Hz, HIGHEST_Hz = 40.0, 1000.0
"""Beyond which the threshold of vibration is held: other receptors take over, or none."""
HEARD_s = 0.2
"""Over which vibration adds up in the skin: some 3 dB per doubling up to there (Verrillo 1965)."""


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


def weber_steps(size: npt.ArrayLike, ratio: float, floor: float) -> FloatArray:
    """Return the JNDs from nothing to sizes, none below 0, where a size has the JND ratio (size + floor)."""
    return np.asarray(np.log1p(np.asarray(size, dtype=np.float64) / floor) / ratio)


@dataclass(frozen=True)
class Jnds:
    """What errors and differences are counted in. The defaults are those of the literature: `LITERATURE`.

    Attributes
    ----------
    force_ratio, force_floor_cN : a force F has the JND force_ratio (|F| + force_floor_cN): a constant part
        far above the floor, a constant number of cN far below it.
    snap_cN : of a sudden fall of force, such as that behind a peak.
    vibration_ratio, vibration_floor : an amplitude of a times the faintest that is felt has the JND
        vibration_ratio (a + vibration_floor), in times the faintest; about one at the faintest.
    frequency_ratio, onset_ms : of a vibration's frequency, and of when it begins.
    place_mm : of a place along the travel.
    origin : whose they are, in words that follow "by".
    sources : where each comes from, and what is assumed.
    """

    force_ratio: float = 0.07
    force_floor_cN: float = 30.0
    snap_cN: float = 10.0
    vibration_ratio: float = 0.17
    vibration_floor: float = 1 / 0.17
    frequency_ratio: float = 0.2
    onset_ms: float = 5.5
    place_mm: float = 0.2
    origin: str = "JNDs from the literature"
    sources: tuple[JndSource, ...] = ()

    def force_cN(self, force_cN: npt.ArrayLike) -> FloatArray:
        """Return the JND of a force of either sign, in the shape given."""
        size_cN = np.abs(np.asarray(force_cN, dtype=np.float64))
        return np.asarray(self.force_ratio * (size_cN + self.force_floor_cN))

    def force_steps(self, force_cN: npt.ArrayLike) -> FloatArray:
        """Return the JNDs from no force to forces of 0 and above, in the shape given."""
        return weber_steps(force_cN, self.force_ratio, self.force_floor_cN)

    def vibration(self, above: npt.ArrayLike) -> FloatArray:
        """Return the JND of amplitudes; above : amplitude over the faintest that is felt, as the JND is."""
        size = np.asarray(above, dtype=np.float64)
        return np.asarray(self.vibration_ratio * (size + self.vibration_floor))

    def vibration_steps(self, above: npt.ArrayLike) -> FloatArray:
        """Return the JNDs from nothing to amplitudes; above : amplitude over the faintest that is felt."""
        return weber_steps(above, self.vibration_ratio, self.vibration_floor)

    def to_dict(self) -> dict[str, Any]:
        """Return the figures and whose they are, without the sources."""
        record = asdict(self)
        del record["sources"]
        return record


def _literature(jnds: Jnds) -> tuple[JndSource, ...]:
    """Return where the defaults come from."""
    return (
        JndSource(
            "force",
            f"{100 * jnds.force_ratio:.0f} % of (force + {jnds.force_floor_cN:g} cN)",
            "Pang, Tan and Durlach 1991: 7 % at 2.5 to 10 N and 25 to 160 mm/s, two plates squeezed",
            "the 30 cN, so that the ratio grows to 10 to 14 % at 30 to 80 cN, where 10 to 15 % are quoted; "
            "that it holds at every place of a stroke. 5.6 cN at 50 cN is half of the sudden change below",
        ),
        JndSource(
            "snap",
            f"{jnds.snap_cN:g} cN of a sudden fall of force",
            "Doerrer and Werthschützky 2002, on push-buttons: a sudden change in the middle of the stroke "
            "was noticed above 10 cN, at 50 to 250 cN",
            "that two falls are discriminated by as much as one is noticed",
        ),
        JndSource(
            "vibration, faintest",
            f"{THRESHOLD_um:g} µm at {BEST_Hz:g} Hz, 12 dB per octave away from it",
            "Verrillo 1963 (after Gescheider and Verrillo 1979): falling by 12 dB per octave from 40 Hz to "
            "the minimum at 250 Hz, on the thumb's base",
            "the fingertip's 0.2 µm (0.1 to 0.3 are quoted; pressing harder lowers it, Papetti et al. 2017), "
            "the same slope above 250 Hz, and that energy adds up over 0.2 s",
        ),
        JndSource(
            "vibration, strength",
            f"{100 * jnds.vibration_ratio:.0f} % of an amplitude well above the faintest, more near it",
            "Forta, Griffin and Morioka 2012, on the thumb's base and the forearm: 20 % (125 Hz, 10 dB above "
            "threshold) to 58 % (10 Hz, 20 dB); Hatzfeld and Werthschützky 2012: 20 dB on average near "
            "threshold",
            "17 % (1.4 dB), stricter than both",
        ),
        JndSource(
            "vibration, frequency",
            f"{100 * jnds.frequency_ratio:.0f} %",
            "",
            "no source was read; 18 to 20 % are quoted",
        ),
        JndSource(
            "vibration, onset",
            f"{jnds.onset_ms:g} ms",
            "Hachisu and Kajimoto 2017: a vibration that followed the tap of a rod later than that was "
            "noticed",
            "that it holds for a button's snap, and for one that comes early",
        ),
        JndSource(
            "place along the travel",
            f"{jnds.place_mm:g} mm",
            "",
            "no source was read; only distances between buttons use it",
        ),
    )


LITERATURE = Jnds(sources=_literature(Jnds()))
"""JNDs where no people were measured."""


def vibration_threshold_um(
    frequency_Hz: npt.ArrayLike, least_um: float = THRESHOLD_um, best_Hz: float = BEST_Hz
) -> FloatArray:
    """Return the faintest amplitude that is felt: lowest at best_Hz, 12 dB per octave away from it."""
    ratio = np.clip(np.asarray(frequency_Hz, dtype=np.float64), LOWEST_Hz, HIGHEST_Hz) / best_Hz
    return np.asarray(least_um * 0.5 * (ratio**2 + ratio**-2))


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
