"""Candidates of a vibration's tuning: the measured one, and templates around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, astuple, dataclass, replace
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.model.vibration import Vibration
from fdvv.program.button import button_program
from fdvv.program.compile import compile_program
from fdvv.program.render_vibration import converter
from fdvv.program.surface import Limits
from fdvv.vibration.exciter import FULL_SCALE_V, KnownExciter
from fdvv.vibration.inverse import correlation, spectral_similarity, st_sim
from fdvv.vibration.templates import TemplateGrid, templates_around
from fdvv.vibration.tune import SimulatedObserver

SCORE_Hz = 16_000  # the vibration board's rate (synth.RATE_HZ): faster cannot be played
RING_s = 0.01  # assumed; silence behind the longest candidate, which ends with its duration


@dataclass(frozen=True, eq=False)
class Candidates:
    """The candidate vibrations of one velocity; the first is the measured one."""

    velocity_mm_s: float
    vibrations: tuple[Vibration, ...]

    def scores(self) -> list[dict[str, float]]:
        """Compare each with the measured one: waveform, spectrum, ST-SIM (fdvv.vibration); 1 is the same."""
        longest_s = max(v.duration_s for v in self.vibrations) + RING_s
        t_s = np.arange(round(longest_s * SCORE_Hz)) / SCORE_Hz
        measured = self.vibrations[0].acceleration_m_s2(t_s)
        return [
            {
                "correlation": correlation(shape, measured),
                "spectral_similarity": spectral_similarity(shape, measured, SCORE_Hz),
                "st_sim": st_sim(shape, measured, SCORE_Hz),
            }
            for shape in (vibration.acceleration_m_s2(t_s) for vibration in self.vibrations)
        ]

    def plain(self) -> list[dict[str, Any]]:
        return [{**asdict(v), "stroke": str(v.stroke)} for v in self.vibrations]


def candidates_for(
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    grid: TemplateGrid | None = None,
    exciter: KnownExciter | None = None,
) -> tuple[Candidates, ...]:
    """Return the candidates of each velocity: the model's nearest vibration of the press, and templates.

    exciter : gives m/s² per volt at the vibration's frequency, which decides where templates reach the
    limit; without it Limits does. Raises InputError if the model has no vibration of the press.
    """
    sets = []
    for velocity in velocities_mm_s:
        measured = model.vibration(Stroke.PRESS, velocity)
        if measured is None:
            reason = "it has none of the press to tune"
            raise InputError(model.name, "vibrations", reason, "give it one first")
        own = replace(measured, velocity_mm_s=float(velocity))
        m_s2_V = acceleration_per_volt(own, exciter)
        made = [t.vibration(own, m_s2_V) for t in templates_around(own, m_s2_V, grid)]
        sets.append(Candidates(float(velocity), (own, *(v for v in made if not _alike(v, own)))))
    return tuple(sets)


def acceleration_per_volt(vibration: Vibration, exciter: KnownExciter | None) -> float:
    """Return m/s² of the cap per volt at a vibration's strongest frequency, as uploads use it."""
    if exciter is None:
        return 2048 / FULL_SCALE_V / Limits().counts_per_m_s2
    strongest = max(vibration.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    return abs(complex(exciter.response(strongest.frequency_Hz)))


def replace_vibrations(model: FDVVModel, chosen: Sequence[Vibration]) -> FDVVModel:
    """Return a model with these vibrations of the press instead of its own at their velocities.

    One that served every velocity is replaced by them all.
    """
    tuned = {v.velocity_mm_s for v in chosen}
    gone = {None, *tuned}
    kept = [v for v in model.vibrations if v.stroke is not Stroke.PRESS or v.velocity_mm_s not in gone]
    return replace(model, vibrations=(*kept, *chosen))


def candidate_image(
    model: FDVVModel, surface: ForceSurface, vibration: Vibration, exciter: KnownExciter | None
) -> bytes:
    """Return the program that plays one vibration in every press. Raises InputError if the board cannot."""
    others = tuple(v for v in model.vibrations if v.stroke is not Stroke.PRESS)
    shown = replace(model, vibrations=(*others, replace(vibration, velocity_mm_s=None)))
    convert = converter(exciter) if exciter else None
    try:
        return compile_program(button_program(shown, surface), convert=convert).image
    except ModelError as error:
        raise InputError(model.name, "vibrations", str(error), "weaken or shorten it") from error


def _alike(a: Vibration, b: Vibration) -> bool:
    if len(a.modes) != len(b.modes) or not np.isclose(a.duration_s, b.duration_s):
        return False
    mine, theirs = ([astuple(mode) for mode in v.modes] for v in (a, b))
    return bool(np.allclose(mine, theirs, rtol=1e-3, atol=1e-9))


TIMES_s = np.arange(800) / 8000
FOR_SHAPE, FOR_STRENGTH = 4.0, 1.5
"""Loss of preference, in units of the noise: for an uncorrelated shape, for twice the strength."""


def simulated_observer(candidates: Sequence[Candidates], seed: int = 0) -> SimulatedObserver:
    """Return an observer with a random favourite per velocity, who prefers the others by similarity."""
    random = np.random.default_rng([seed, 1])
    likes = []
    for candidate_set in candidates:
        favourite = candidate_set.vibrations[int(random.integers(len(candidate_set.vibrations)))]
        likes.append([_like(vibration, favourite) for vibration in candidate_set.vibrations])
    return SimulatedObserver(likes, seed=seed)


def _like(vibration: Vibration, favourite: Vibration) -> float:
    rendered, wanted = (v.acceleration_m_s2(TIMES_s) for v in (vibration, favourite))
    strength = abs(float(np.log2((np.linalg.norm(rendered) + 1e-9) / (np.linalg.norm(wanted) + 1e-9))))
    return FOR_SHAPE * (correlation(rendered, wanted) - 1) - FOR_STRENGTH * strength
