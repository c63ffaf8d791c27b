"""Files that a person drops on the page: read, fitted and shown before anything is kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import numpy as np
from msgspec import Meta

from fdvv.bench.model import process_recording
from fdvv.button.fit import FitSettings
from fdvv.button.import_file import ImportSettings, import_file
from fdvv.button.plausible import OPTION
from fdvv.errors import FdvvError, InputError
from fdvv.model.curve import MeasuredCurve
from fdvv_studio.library.opened import OpenedFile, open_file, open_fitted, skip_paired_releases
from fdvv_studio.project.patch import record_of
from fdvv_studio.studio.api.documents import Documents
from fdvv_studio.studio.api.library import Number
from fdvv_studio.studio.api.library_buttons import LibraryStroke, sample_strokes
from fdvv_studio.studio.contract import Message, call, error_line
from fdvv_studio.studio.studio import Studio

MOST_FILES = 64
MOST_SAMPLES = 1500
"""Of a stroke, drawn as dots: more than a plot has columns."""
LONGEST_NAME_bytes = 200
"""File systems take 255; a reader may look for the other stroke under a longer name."""


class DroppedFile(Message):
    """A file of the person's.

    name : with its folders, separated by slashes. content : its bytes, in base64.
    """

    name: Annotated[str, Meta(min_length=1, max_length=1000)]
    content: bytes


class FilesAsk(Message):
    """Read some files.

    into : the button that a vibration among them is given to; its full scale is full_scale_m_s2.
    accept_implausible : read also what cannot be a button's.
    """

    files: Annotated[list[DroppedFile], Meta(min_length=1, max_length=MOST_FILES)]
    into: Annotated[str, Meta(max_length=300)] | None = None
    full_scale_m_s2: Annotated[float, Meta(gt=0, le=1e5)] | None = None
    accept_implausible: bool = False


class FileSamples(Message):
    """Raw samples of a stroke, at most some 1,500, contact at 0."""

    stroke: str
    velocity_mm_s: Number
    displacement_mm: list[float]
    force_cN: list[float]


class FileFit(Message):
    """How closely a curve follows its samples.

    rmse_cN : of the samples. control_points : how many the curve has. bump_kept_ratio : null without a bump.
    """

    stroke: str
    velocity_mm_s: Number
    rmse_cN: float
    control_points: int
    bump_kept_ratio: Number


class FileButton(Message):
    """What a file holds.

    name : free for a button of one's own. model : null if the file could not be read; then reason is one
    line, and doubted says whether it is read when implausible files are accepted.
    sentence : what the button is and how well it was fitted. notes : what was repaired or assumed.
    """

    file: str
    name: str
    reason: str
    doubted: bool = False
    sentence: str = ""
    notes: tuple[str, ...] = ()
    model: dict[str, Any] | None = None
    strokes: tuple[LibraryStroke, ...] = ()
    samples: tuple[FileSamples, ...] = ()
    fits: tuple[FileFit, ...] = ()


class FileButtons(Message):
    """One for each button, in the order of the files; the two files of a pair are one button."""

    buttons: list[FileButton]


@call("file.read")
def read_files(studio: Studio, ask: FilesAsk) -> FileButtons:
    """Read files as ``fdvv fit``, ``process`` or ``import`` would, and keep nothing of them."""
    with TemporaryDirectory(prefix="fdvv-") as folder:
        paths = list(_write_files(Path(folder), ask.files))
        return FileButtons([_button(studio, ask, path) for path in skip_paired_releases(paths)])


def _write_files(folder: Path, files: Sequence[DroppedFile]) -> Iterator[Path]:
    """Write files below a folder under safe names; those of one folder stay together, as pairs must."""
    folders: dict[PurePosixPath, Path] = {}
    for file in files:
        named = PurePosixPath(file.name.replace("\\", "/"))
        place = folders.setdefault(named.parent, folder / str(len(folders)))
        place.mkdir(exist_ok=True)
        path = place / _safe_name(named.name)
        path.write_bytes(file.content)
        yield path


def _safe_name(name: str) -> str:
    """Return a name without what a file system refuses, short enough, with the file's own ending."""
    name = "".join(c if c.isprintable() else "?" for c in name.encode(errors="replace").decode())
    # the names of this folder and of the one above are no names of files
    name = name if name.strip(".") else "file"
    stem, suffix = PurePosixPath(name).stem, PurePosixPath(name).suffix[:20]
    fits = stem.encode()[: LONGEST_NAME_bytes - len(suffix.encode())].decode(errors="ignore")
    return f"{fits}{suffix}"


def _button(studio: Studio, ask: FilesAsk, path: Path) -> FileButton:
    store = studio.part(Documents).store
    try:
        opened = _open_dropped(studio, ask, path)
    except InputError as error:
        # the page has a switch where the command line has an option
        remedy, doubted, _ = error.remedy.partition(f"; fdvv fit {OPTION}")
        line = error_line(InputError(error.source, error.place, error.reason, remedy))
        return FileButton(path.name, "", line, doubted=bool(doubted))
    except FdvvError as error:
        return FileButton(path.name, "", error_line(error))
    return FileButton(
        file=path.name,
        name=store.free_name(opened.model.name),
        reason="",
        sentence=opened.sentence,
        notes=opened.notes,
        model=record_of(opened.model),
        strokes=tuple(sample_strokes(opened.model)),
        samples=tuple(_samples(stroke) for stroke in opened.measured),
        fits=tuple(
            FileFit(
                stroke=str(fit.curve.stroke),
                velocity_mm_s=fit.curve.velocity_mm_s,
                rmse_cN=fit.rmse_cN,
                control_points=fit.curve.control_points_cN.size,
                bump_kept_ratio=fit.bump_kept_ratio,
            )
            for fit in opened.fits
        ),
    )


def _open_dropped(studio: Studio, ask: FilesAsk, path: Path) -> OpenedFile:
    with path.open("rb") as stream:
        head = stream.read(12)
    if path.name.endswith(".recording.jsonl"):
        return open_fitted(process_recording(path))
    if head.startswith(b"RIFF") or path.suffix.lower() in (".ahap", ".haptic", ".hjif"):
        return _with_vibration(studio, ask, path)
    return open_file(path, FitSettings(accept_implausible=ask.accept_implausible))


def _with_vibration(studio: Studio, ask: FilesAsk, path: Path) -> OpenedFile:
    """Put a vibration into the button that the page shows."""
    if ask.into is None:
        remedy = "open the button that it belongs to, and drop the file there"
        raise InputError(path.name, "whole file", "holds a vibration, no button", remedy)
    into = studio.catalog.model(ask.into)
    made = import_file(path, ImportSettings(into=into, full_scale_m_s2=ask.full_scale_m_s2))
    count = len(made.model.vibrations[-1].modes)
    return OpenedFile(
        made.model, f"{into.name} with a vibration of {count} modes from {path.name}.", made.notes
    )


def _samples(stroke: MeasuredCurve) -> FileSamples:
    every = max(1, int(np.ceil(stroke.force_cN.size / MOST_SAMPLES)))
    x_mm, force_cN = stroke.displacement_mm[::every], stroke.force_cN[::every]
    return FileSamples(
        str(stroke.stroke), stroke.velocity_mm_s, np.round(x_mm, 4).tolist(), np.round(force_cN, 3).tolist()
    )
