"""Simulated participants: proxies that judge by psychophysical noise. They plan studies and prove nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.study.simulation.perception import PerceivedDifference, Senses

NOISE_JND = 1.0 / (math.sqrt(2.0) * 0.6744897501960817)
"""Spread of one percept: 1 JND is discriminated in 75 % of choices between two (Thurstone 1927)."""
MOST_LAPSES = 0.5  # ten times what people show (Wichmann and Hill 2001); beyond, most answers are blind


@dataclass(frozen=True)
class ProxySettings:
    """Who is drawn: the middle person, and how people differ.

    Attributes
    ----------
    senses : of the middle person.
    weber_spread_ratio, threshold_spread_dB : between people; of the logarithm of the Weber ratio, and of the
        faintest vibration. Assumed: people's thresholds differ by some 30 % and 5 dB.
    noise_JND : spread of one percept, every time something is felt.
    criterion_JND, criterion_spread_ratio : difference below which "equal" is said, and between people.
        Assumed: people who may say "equal" do so near their threshold.
    lapse_ratio : part of the trials that are answered without feeling, on average; 0 to 0.05 are found
        (Wichmann and Hill 2001).
    taste_ratio : how far one person's judgement of a difference leans one way, as part of the difference
        itself; so nobody leans where nothing differs. Assumed.
    rating_drop_JND : difference at which a rating has fallen to 37 % of the scale. Assumed.
    rating_shift_ratio, rating_noise_ratio : of the scale, between people and from rating to rating. Assumed.
    trial_s, trial_spread_ratio : time of an answer, and its spread, of the logarithm; 36 of them fill the
        paper's hour with its breaks.
    """

    senses: Senses = field(default_factory=Senses)
    weber_spread_ratio: float = 0.3
    threshold_spread_dB: float = 5.0
    noise_JND: float = NOISE_JND
    criterion_JND: float = 0.7
    criterion_spread_ratio: float = 0.5
    lapse_ratio: float = 0.02
    taste_ratio: float = 0.3
    rating_drop_JND: float = 3.0
    rating_shift_ratio: float = 0.1
    rating_noise_ratio: float = 0.1
    trial_s: float = 75.0
    trial_spread_ratio: float = 0.3

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if one.name != "senses" and not 0 <= value < math.inf:
                raise ModelError(f"{one.name} must be 0 or more, got {value}")
        if self.lapse_ratio > MOST_LAPSES or self.rating_drop_JND == 0 or self.trial_s == 0:
            raise ModelError(f"nobody answers like that: {self}")

    def changed(self, name: str, value: float) -> ProxySettings:
        """Copy with one constant of the senses or of the people changed. ModelError if unknown."""
        change: dict[str, Any] = {name: value}
        if name in {one.name for one in fields(Senses)}:
            return replace(self, senses=replace(self.senses, **change))
        if name == "senses" or name not in {one.name for one in fields(self)}:
            raise ModelError(f"a simulated participant has no {name!r}")
        return replace(self, **change)


@dataclass(frozen=True, eq=False)
class SimulatedPeople:
    """People of one shape, for arithmetic on many at once.

    Attributes
    ----------
    sharpness, vibration_gain : how much finer than by the middle person force and vibration are felt.
    criterion_JND, lapse_ratio : as in the settings. taste : leaning, standard normal.
    rating_shift : of the scale. settings : what all share.
    """

    sharpness: FloatArray
    vibration_gain: FloatArray
    criterion_JND: FloatArray
    lapse_ratio: FloatArray
    taste: FloatArray
    rating_shift: FloatArray
    settings: ProxySettings

    @property
    def shape(self) -> tuple[int, ...]:
        return self.sharpness.shape

    def felt_JND(self, difference: PerceivedDifference) -> FloatArray:
        force = self.sharpness**2 * (difference.force_JND**2 + difference.speed_JND**2)
        return np.asarray(np.sqrt(force + self._vibration_squared(difference)))

    def _vibration_squared(self, difference: PerceivedDifference) -> FloatArray:
        senses = self.settings.senses
        if not difference.vibration:
            return np.zeros(self.shape)
        steps = [
            senses.vibration_steps(self.vibration_gain * first)
            - senses.vibration_steps(self.vibration_gain * second)
            for first, second in difference.vibration
        ]
        weights = np.asarray([1.0, senses.release_weight])
        return np.asarray(np.average(np.square(steps), axis=0, weights=weights))


def draw_people(
    random: np.random.Generator, shape: tuple[int, ...] = (), settings: ProxySettings | None = None
) -> SimulatedPeople:
    """Draw people, two spreads either way at most, but of taste and rating, which are normal."""
    settings = settings or ProxySettings()
    three = np.clip(random.standard_normal((3, *shape)), -2.0, 2.0)
    return SimulatedPeople(
        sharpness=np.exp(settings.weber_spread_ratio * three[0]),
        vibration_gain=10 ** (settings.threshold_spread_dB / 20 * three[1]),
        criterion_JND=settings.criterion_JND * np.exp(settings.criterion_spread_ratio * three[2]),
        lapse_ratio=2 * settings.lapse_ratio * random.uniform(size=shape),
        taste=random.standard_normal(shape),
        rating_shift=settings.rating_shift_ratio * random.standard_normal(shape),
        settings=settings,
    )
