"""From the rows of the shelf to what the page is told of them."""

from __future__ import annotations

import base64
from collections.abc import Sequence

import msgspec
import numpy as np

from fdvv.studio._messages_library import (
    LibraryButton,
    LibraryFound,
    LibraryHistogram,
    LibraryIndex,
    LibraryRow,
    LibraryStanding,
    LibraryStroke,
)
from fdvv.workflow import SHELF_NUMBERS, SampledStroke, ShelfFound, ShelfRow

NO_STROKE = -32768
"""In place of every force of a stroke that is not there."""


def rows_told(standing: LibraryStanding, first: int, rows: Sequence[ShelfRow]) -> LibraryIndex:
    """Give rows as columns; first : position of the first of them."""
    return LibraryIndex(
        standing=standing,
        first=first,
        ids=[row.id for row in rows],
        names=[row.name for row in rows],
        collections=[row.collection for row in rows],
        origins=[row.origin for row in rows],
        kinds=[row.kind for row in rows],
        stated=[list(row.stated) for row in rows],
        speeds_mm_s=[list(row.speeds_mm_s) for row in rows],
        dates=[row.date for row in rows],
        simulated=[row.simulated for row in rows],
        numbers={name: [getattr(row, name) for row in rows] for name in SHELF_NUMBERS},
        sketches=_packed(rows),
    )


def _packed(rows: Sequence[ShelfRow]) -> str:
    none = (NO_STROKE,) * 64
    sketches = [(row.sketch.press_dcN or none) + (row.sketch.release_dcN or none) for row in rows]
    return base64.b64encode(np.array(sketches, dtype="<i2").tobytes()).decode()


def found_told(found: ShelfFound, epoch: int) -> LibraryFound:
    """Give what a search found; epoch : of the rows that its positions count."""
    return LibraryFound(
        epoch=epoch,
        positions=found.positions.tolist(),
        distances_jnd=np.round(found.distances, 3).tolist(),
        histograms={
            name: LibraryHistogram(h.lowest, h.highest, h.counts.tolist())
            for name, h in found.histograms.items()
        },
        kinds=found.kinds,
        origins=found.origins,
        without=found.without,
        mended=list(found.mended),
    )


def row_told(row: ShelfRow) -> LibraryRow:
    """Give what a picker shows of a row."""
    return msgspec.convert(row, LibraryRow, from_attributes=True)


def button_told(row: ShelfRow, strokes: Sequence[SampledStroke]) -> LibraryButton:
    """Give all that is known of a button, with its curves."""
    return LibraryButton(
        id=row.id,
        name=row.name,
        origin=row.origin,
        kind=row.kind,
        kind_reason=row.kind_reason,
        collection=row.collection,
        stated=list(row.stated),
        numbers={name: getattr(row, name) for name in SHELF_NUMBERS},
        why=list(row.why),
        cycles=row.cycles,
        used=row.used,
        date=row.date,
        source=row.source,
        licence=row.licence,
        simulated=row.simulated,
        strokes=[
            LibraryStroke(s.stroke, s.velocity_mm_s, s.start_mm, s.step_mm, np.round(s.force_cN, 3).tolist())
            for s in strokes
        ],
    )
