"""What the shelf knows of one button without opening it: a row of figures, and a sketch of its curves."""

from __future__ import annotations

from enum import StrEnum

import msgspec

SKETCH_POINTS = 64
"""Per stroke, evenly from contact to the end of the travel."""


class Origin(StrEnum):
    """Where a button of the shelf comes from."""

    BUILTIN = "builtin"
    OWN = "own"
    MEASURED = "measured"


class ButtonType(StrEnum):
    """What the force of a button does; a question mark belongs to what force alone can only suggest."""

    LINEAR = "linear"
    TACTILE = "tactile"
    CLICKY = "clicky?"
    DOME = "dome?"
    UNCLEAR = "unclear"


class Sketch(msgspec.Struct, frozen=True):
    """The slowest press and its release in tenths of a centinewton, 64 points each; empty if not there."""

    press_dcN: tuple[int, ...] = ()
    release_dcN: tuple[int, ...] = ()


class ShelfRow(msgspec.Struct, frozen=True, kw_only=True):
    """One button of the shelf. A figure that is None was not detected or is not known; ``why`` says which.

    Attributes
    ----------
    id : ``builtin:NAME``, ``own:NAME`` or ``measured:`` and 16 hexadecimal digits.
    collection : the folder a measured file lies in, below the source and with it.
    stated : words of the maker or the measurer ("silent", "linear" ...) in name and folder; not measured.
    kind, kind_reason : decided from the force alone, and by what.
    peak_cN, peak_mm, valley_cN, valley_mm, drop_cN, snap_ratio : of the bump of the press.
    release_drop_cN : of the bump of the release.
    actuation_mm, actuation_cN, reset_mm : of the electrical contact.
    preload_cN, bottom_out_cN, travel_mm, pre_slope_cN_mm, post_slope_cN_mm, work_mJ, loss_mJ : as
        fdvv.model.Landmarks; loss is work put in and not given back.
    speeds_mm_s : the known speeds of the presses, rising; empty if the source tells none.
    cycles, used : how many presses the source holds and how many the mean is of; None for a model.
    date : ISO day on which the file was last changed; None for a built-in.
    source, licence : as the button's file states them.
    simulated : whether the numbers come from the twin.
    why : reasons of what is None, each beginning with its subject and a colon.
    """

    id: str
    name: str
    origin: Origin
    collection: str
    stated: tuple[str, ...]
    kind: ButtonType
    kind_reason: str
    peak_cN: float | None
    peak_mm: float | None
    valley_cN: float | None
    valley_mm: float | None
    drop_cN: float | None
    snap_ratio: float | None
    release_drop_cN: float | None
    actuation_mm: float | None
    actuation_cN: float | None
    reset_mm: float | None
    preload_cN: float | None
    bottom_out_cN: float | None
    travel_mm: float
    pre_slope_cN_mm: float | None
    post_slope_cN_mm: float | None
    work_mJ: float | None
    loss_mJ: float | None
    speeds_mm_s: tuple[float, ...]
    cycles: int | None
    used: int | None
    date: str | None
    source: str
    licence: str
    simulated: bool
    why: tuple[str, ...]
    sketch: Sketch


NUMBERS = (
    *("peak_cN", "peak_mm", "valley_cN", "valley_mm", "drop_cN", "snap_ratio", "release_drop_cN"),
    *("actuation_mm", "actuation_cN", "reset_mm", "preload_cN", "bottom_out_cN", "travel_mm"),
    *("pre_slope_cN_mm", "post_slope_cN_mm", "work_mJ", "loss_mJ"),
)
"""Figures of a row that can be searched by range and sorted by."""
"""The fields of a row that are ranges to filter by and columns to sort by."""
