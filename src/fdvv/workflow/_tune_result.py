"""What a tuning is set up with, what it tells on the way, and what comes out of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from fdvv.errors import ModelError
from fdvv.model import FDVVModel, ForceSurface, Vibration
from fdvv.vibration import KnownExciter, Standing, TemplateGrid
from fdvv.workflow._answer_log import Given
from fdvv.workflow._receipt import Receipt
from fdvv.workflow._tune_candidates import Candidates

OBSERVERS = ("person", "simulated observer")


@dataclass(frozen=True, eq=False)
class TuneSetup:
    """What is put on the device while a vibration is tuned.

    Attributes
    ----------
    surface : forces as compensation learned them; None: the model's own.
    exciter : where it is known, vibrations are played through its inverse.
    grid : of templates.
    observer : "person", or "simulated observer": then nothing that comes out is evidence of anything.
    """

    surface: ForceSurface | None = None
    exciter: KnownExciter | None = None
    grid: TemplateGrid = field(default_factory=TemplateGrid)
    observer: str = OBSERVERS[0]

    def __post_init__(self) -> None:
        if self.observer not in OBSERVERS:
            raise ModelError(f"observer must be one of {', '.join(OBSERVERS)}, got {self.observer!r}")


@dataclass(frozen=True, eq=False)
class TunedVibration:
    """What came out at one velocity."""

    candidates: Candidates
    standing: Standing

    @property
    def vibration(self) -> Vibration:
        """Give the vibration that is kept."""
        return self.candidates.vibrations[self.standing.best]

    @property
    def sentence(self) -> str:
        """Say how sure that is."""
        s, count = self.standing, len(self.candidates.vibrations)
        if not s.told_apart:
            return f"no difference found between {count} vibrations; the measured one is kept"
        others = len(s.alike) - 1
        tied = f", {others} more cannot be told from it" if others else ""
        return f"{'the measured one' if not s.best else f'template {s.best}'} of {count} was best{tied}"

    def to_dict(self) -> dict[str, Any]:
        """Give it as plain values."""
        s = self.standing
        rows = zip(self.candidates.plain(), s.scores, s.errors, self.candidates.scores(), strict=True)
        return {
            "velocity_mm_s": self.candidates.velocity_mm_s,
            "best": s.best,
            "alike": list(s.alike),
            "answers": s.answers,
            "explanation": self.sentence,
            "candidates": [
                {"vibration": v, "score": score, "error": error, "objective": objective}
                for v, score, error, objective in rows
            ],
        }


@dataclass(frozen=True, eq=False)
class TuneTold:
    """An answer that is on file, and what all so far say.

    Attributes
    ----------
    given : the answer. total : the most questions that it can become.
    tuned : as it stands at each velocity. Whoever answers should not be led by it.
    """

    given: Given
    total: int
    tuned: tuple[TunedVibration, ...]


@dataclass(frozen=True, eq=False)
class TuneResult:
    """A tuned model and how it came about; simulated if device or observer is."""

    model: FDVVModel
    method: str
    device: str
    observer: str
    simulated: bool
    tuned: tuple[TunedVibration, ...]
    receipt: Receipt

    @property
    def answers(self) -> int:
        """Count the answers."""
        return self.receipt.used

    def to_dict(self) -> dict[str, Any]:
        """Give the report."""
        head = {
            name: getattr(self, name) for name in ("method", "device", "observer", "simulated", "answers")
        }
        return {"model": self.model.name, **head, "velocities": [t.to_dict() for t in self.tuned]}
