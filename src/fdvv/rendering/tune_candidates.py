"""What is tried when a vibration is tuned: the one that was measured, and templates around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model import FDVVModel, ForceSurface, Stroke, Vibration
from fdvv.program import Limits, button_program, compile_program
from fdvv.vibration import (
    FULL_SCALE_V,
    KnownExciter,
    TemplateGrid,
    correlation,
    spectral_similarity,
    st_sim,
    templates_around,
)
from fdvv.workflow._vibration_slots import converter

SCORE_Hz = 16_000
RING_s = 0.01


@dataclass(frozen=True, eq=False)
class Candidates:
    """The vibrations that are tried at one velocity; the first is the measured one as it is."""

    velocity_mm_s: float
    vibrations: tuple[Vibration, ...]

    def scores(self) -> list[dict[str, float]]:
        """Compare each with the measured one: waveform, spectrum, ST-SIM (fdvv.vibration); 1 is the same."""
        longest_s = max(v.duration_s for v in self.vibrations) + RING_s
        t_s = np.arange(round(longest_s * SCORE_Hz)) / SCORE_Hz
        measured = self.vibrations[0].acceleration_m_s2(t_s)
        found = []
        for vibration in self.vibrations:
            shape = vibration.acceleration_m_s2(t_s)
            found.append(
                {
                    "correlation": correlation(shape, measured),
                    "spectral_similarity": spectral_similarity(shape, measured, SCORE_Hz),
                    "st_sim": st_sim(shape, measured, SCORE_Hz),
                }
            )
        return found

    def plain(self) -> list[dict[str, Any]]:
        """Write the vibrations as JSON would give them back."""
        return [{**asdict(v), "stroke": str(v.stroke)} for v in self.vibrations]


def candidates_for(
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    grid: TemplateGrid | None = None,
    exciter: KnownExciter | None = None,
) -> tuple[Candidates, ...]:
    """Give what to try at each velocity: the model's vibration of the press nearest to it, and templates.

    exciter : tells how many m/s² a volt is at the vibration's frequency, and so where templates meet the
    limit; without it Limits does. Raises InputError if the model has no vibration of the press.
    """
    found = []
    for velocity in velocities_mm_s:
        measured = model.vibration(Stroke.PRESS, velocity)
        if measured is None:
            raise InputError(
                model.name, "vibrations", "it has none of the press to tune", "give it one first"
            )
        own = replace(measured, velocity_mm_s=float(velocity))
        templates = templates_around(own, acceleration_per_volt(own, exciter), grid)
        made = [t.vibration(own, acceleration_per_volt(own, exciter)) for t in templates]
        found.append(Candidates(float(velocity), (own, *(v for v in made if not _alike(v, own)))))
    return tuple(found)


def acceleration_per_volt(vibration: Vibration, exciter: KnownExciter | None) -> float:
    """Give m/s² of the cap per volt at a vibration's strongest frequency, as uploads use it."""
    if exciter is None:
        return 2048 / FULL_SCALE_V / Limits().counts_per_m_s2
    strongest = max(vibration.modes, key=lambda mode: abs(mode.amplitude_m_s2))
    return abs(complex(exciter.response(strongest.frequency_Hz)))


def tuned_model(model: FDVVModel, chosen: Sequence[Vibration]) -> FDVVModel:
    """Give a model with these vibrations of the press instead of its own at their velocities.

    One that served every velocity is replaced by them all.
    """
    tuned = {v.velocity_mm_s for v in chosen}
    kept = [
        v for v in model.vibrations if v.stroke is not Stroke.PRESS or v.velocity_mm_s not in {None, *tuned}
    ]
    return replace(model, vibrations=(*kept, *chosen))


def candidate_image(
    model: FDVVModel, surface: ForceSurface, vibration: Vibration, exciter: KnownExciter | None
) -> bytes:
    """Give the program that plays one vibration in every press. InputError if the board cannot."""
    others = tuple(v for v in model.vibrations if v.stroke is not Stroke.PRESS)
    shown = replace(model, vibrations=(*others, replace(vibration, velocity_mm_s=None)))
    convert = converter(exciter) if exciter else None
    try:
        return compile_program(button_program(shown, surface), convert=convert).image
    except ModelError as error:
        raise InputError(model.name, "vibrations", str(error), "weaken or shorten it") from error


def _alike(a: Vibration, b: Vibration) -> bool:
    """Tell whether two vibrations differ by less than rounding."""
    if len(a.modes) != len(b.modes) or not np.isclose(a.duration_s, b.duration_s):
        return False
    mine, theirs = (
        [(m.frequency_Hz, m.amplitude_m_s2, m.decay_1_s, m.phase_rad) for m in v.modes] for v in (a, b)
    )
    return bool(np.allclose(mine, theirs, rtol=1e-3, atol=1e-9))
