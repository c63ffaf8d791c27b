"""Read the button in a file of any known format, for a person who looks at it before keeping it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from fdvv.button.fit import FitSettings, fit_file
from fdvv.button.kind import kind_sentence
from fdvv.force_text import force_text
from fdvv.formats.force.read import stroke_of
from fdvv.io.documents import MODEL, own_kind
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.file import load_model
from fdvv.model.fit import CurveFit
from fdvv.model.model import FDVVModel


@dataclass(frozen=True, eq=False)
class OpenedFile:
    """The button that a file holds.

    Attributes
    ----------
    model : the button, fitted if the file holds measured curves.
    sentence : what kind of button it is, and how closely the fit follows the samples.
    notes : what was repaired, left out or could not be found, one sentence each.
    fits, measured : one per curve of the model where it was fitted; else empty.
    """

    model: FDVVModel
    sentence: str
    notes: tuple[str, ...] = ()
    fits: tuple[CurveFit, ...] = ()
    measured: tuple[MeasuredCurve, ...] = ()


def open_file(path: Path, settings: FitSettings | None = None) -> OpenedFile:
    """Read a model file as it is, and fit any other file as ``fdvv fit`` does. Raises InputError."""
    if own_kind(path) == MODEL:
        model = load_model(path)
        return OpenedFile(model, f"{kind_sentence(model)} {_extent(model)}.", model.provenance.assumptions)
    return open_fitted(fit_file(path, settings))


class Fitted(Protocol):
    """A model that was fitted to a file or a recording."""

    @property
    def model(self) -> FDVVModel: ...
    @property
    def fits(self) -> tuple[CurveFit, ...]: ...
    @property
    def measured(self) -> tuple[MeasuredCurve, ...]: ...
    @property
    def warnings(self) -> tuple[str, ...]: ...


def open_fitted(fitted: Fitted) -> OpenedFile:
    worst_cN = max(fit.rmse_cN for fit in fitted.fits)
    fit = f"The fit follows the samples within {force_text(worst_cN, '.2f')} (RMSE)"
    sentence = f"{kind_sentence(fitted.model)} {fit}."
    return OpenedFile(fitted.model, sentence, fitted.warnings, fitted.fits, fitted.measured)


def skip_paired_releases(paths: Sequence[Path]) -> Iterator[Path]:
    """Leave out releases whose press is there too: a reader takes both from the press's file."""
    for path in paths:
        named = stroke_of(path)
        if named is None or named[0] is Stroke.PRESS or named[1] not in paths:
            yield path


def _extent(model: FDVVModel) -> str:
    counts = (
        f"{len(model.curves)} curves",
        f"{len(model.vibrations)} vibrations" if model.vibrations else "",
    )
    return f"{' and '.join(filter(None, counts))} over {model.travel_mm:.2f} mm"
