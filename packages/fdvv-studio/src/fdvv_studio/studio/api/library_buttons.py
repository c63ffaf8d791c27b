"""Buttons of the catalogue: rows for pickers, similar buttons, curves with landmarks."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from msgspec import Meta

from fdvv.button.kind import ButtonType
from fdvv.button.page import MOST_BUTTONS, buttons_page
from fdvv.errors import FdvvError
from fdvv.model.model import FDVVModel
from fdvv_studio.library.figures import row_of_model
from fdvv_studio.library.row import NUMBERS, Origin
from fdvv_studio.library.search import SearchQuery
from fdvv_studio.studio.api.library import Library, Number
from fdvv_studio.studio.contract import Message, call, error_line, message_of
from fdvv_studio.studio.studio import Studio

STEP_mm, MOST_POINTS = 0.01, 2000
"""Of curves on the page."""


class LibraryQuery(Message):
    """What a picker of buttons asks: as LibraryFind, with at most ``limit`` rows in the answer."""

    text: Annotated[str, Meta(max_length=200)] = ""
    kinds: tuple[ButtonType, ...] = ()
    origins: tuple[Origin, ...] = ()
    limit: Annotated[int, Meta(ge=1, le=1000)] = 50


class LibraryRow(Message):
    """One button with its main landmarks."""

    id: str
    name: str
    origin: Origin
    kind: ButtonType
    collection: str
    stated: tuple[str, ...]
    peak_cN: Number
    drop_cN: Number
    actuation_mm: Number
    bottom_out_cN: Number
    travel_mm: float
    simulated: bool


class LibraryRows(Message):
    """The first rows that match, and how many match. ended : whether every file has been looked at."""

    rows: list[LibraryRow]
    total: int
    ended: bool


class LibraryLikeAsk(Message):
    """Ask for the buttons that feel most like one."""

    id: str
    limit: Annotated[int, Meta(ge=1, le=1000)] = 20


class LibraryAlike(Message):
    """A button and how far it is from the one asked for, in just noticeable differences."""

    row: LibraryRow
    distance_jnd: float
    force_jnd: float
    shape_jnd: float
    landmarks_jnd: float


class LibraryAlikes(Message):
    """The nearest first. jnds : whose JNDs the distances are counted in, in words."""

    alike: list[LibraryAlike]
    jnds: str


class LibraryCurvesAsk(Message):
    """Ask for the curves of some buttons."""

    ids: Annotated[list[str], Meta(max_length=100)]


class LibraryStroke(Message):
    """Force of a stroke at start + i step, contact at 0. velocity_mm_s : null if the source tells none."""

    stroke: str
    velocity_mm_s: Number
    start_mm: float
    step_mm: float
    force_cN: list[float]


class LibraryButton(Message):
    """All that is known of a button.

    numbers : its landmarks by name. why : reasons of what is null, each with its subject and a colon.
    cycles, used : presses in the source and in the mean. source, licence : empty if not stated.
    """

    id: str
    name: str
    origin: Origin
    kind: ButtonType
    kind_reason: str
    collection: str
    stated: tuple[str, ...]
    numbers: dict[str, Number]
    why: tuple[str, ...]
    cycles: int | None
    used: int | None
    date: str | None
    source: str
    licence: str
    simulated: bool
    strokes: list[LibraryStroke]


class LibraryMissing(Message):
    """A button that cannot be had, and why."""

    id: str
    reason: str


class LibraryCurves(Message):
    """Buttons in the order asked for, and those that cannot be had."""

    buttons: list[LibraryButton]
    missing: list[LibraryMissing]


def sample_strokes(model: FDVVModel) -> list[LibraryStroke]:
    """Sample every curve of a model about every 10 um from its start to its end, in reading order."""
    strokes = []
    for curve in model.curves:
        points = round((curve.end_mm - curve.start_mm) / STEP_mm) + 1
        x = np.linspace(curve.start_mm, curve.end_mm, int(np.clip(points, 2, MOST_POINTS)))
        force_cN = np.round(curve.force_cN(x), 3).tolist()
        start_mm, step_mm = float(x[0]), float(x[1] - x[0])
        strokes.append(LibraryStroke(curve.stroke, curve.velocity_mm_s, start_mm, step_mm, force_cN))
    return strokes


class LibraryPageAsk(Message):
    """Ask for the page of one button or of several compared; velocity_mm_s : null is the slowest of each."""

    ids: Annotated[list[str], Meta(min_length=1, max_length=MOST_BUTTONS)]
    velocity_mm_s: Annotated[float, Meta(gt=0)] | None = None


class LibraryPage(Message):
    """An HTML document with nothing outside itself, and a name for its file."""

    name: str
    html: str


@call("library.page")
def page(studio: Studio, ask: LibraryPageAsk) -> LibraryPage:
    models = [studio.catalog.model(button_id) for button_id in ask.ids]
    return LibraryPage(
        f"{' and '.join(m.name for m in models)}.html", buttons_page(models, ask.velocity_mm_s, studio.jnds)
    )


@call("library.search")
def search(library: Library, ask: LibraryQuery) -> LibraryRows:
    query = SearchQuery(text=ask.text, kinds=ask.kinds, origins=ask.origins)
    result, rows, indexed = library.find(query)
    best = [message_of(LibraryRow, rows[at]) for at in result.positions[: ask.limit]]
    return LibraryRows(best, len(result.positions), indexed.ended)


@call("library.like")
def like(library: Library, ask: LibraryLikeAsk) -> LibraryAlikes:
    jnds = library.jnds
    result, rows, _ = library.find(SearchQuery(like=ask.id, jnds=jnds))
    alike = [
        LibraryAlike(
            message_of(LibraryRow, rows[at]), round(float(distance), 3), *np.round(parts, 3).tolist()
        )
        for at, distance, parts in zip(result.positions, result.distances, result.parts, strict=True)
        if np.isfinite(distance)
    ]
    return LibraryAlikes(alike[: ask.limit], jnds.origin)


@call("library.curves")
def curves(studio: Studio, ask: LibraryCurvesAsk) -> LibraryCurves:
    """Return curves and landmarks; a button that cannot be read does not prevent the others."""
    library = studio.part(Library)
    buttons, missing = [], []
    for button_id in ask.ids:
        try:
            buttons.append(button_of(studio, library, button_id))
        except FdvvError as error:
            missing.append(LibraryMissing(button_id, error_line(error)))
    return LibraryCurves(buttons, missing)


def button_of(studio: Studio, library: Library, button_id: str) -> LibraryButton:
    """Return a button with its curves; one that is not indexed yet is read. InputError."""
    model = studio.catalog.curves(button_id)
    row = library.row(button_id) or row_of_model(model, button_id, Origin(button_id.partition(":")[0]))
    numbers = {name: getattr(row, name) for name in NUMBERS}
    return message_of(LibraryButton, row, numbers=numbers, strokes=sample_strokes(model))
