"""New buttons: templates, and names that are valid as names of files."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from enum import StrEnum

import numpy as np

from fdvv.errors import InputError
from fdvv.model.bspline import uniform_knots
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel, Provenance

TRAVEL_mm = 4.0
VELOCITY_mm_s = 50.0
"""Of the first curves; more can be drawn beside them."""

FRICTION_cN = 8.0
"""A release gives back so much less than the press took."""


class ModelTemplate(StrEnum):
    """A plain spring, or one with a bump half-way."""

    LINEAR = "linear"
    TACTILE = "tactile"


_PRESS_cN = {
    ModelTemplate.LINEAR: [40, 42, 44, 46, 48, 50, 52, 54, 56, 58, 60, 62],
    ModelTemplate.TACTILE: [25, 34, 44, 54, 60, 52, 40, 42, 48, 54, 60, 66],
}


def new_model(name: str, template: ModelTemplate | str) -> FDVVModel:
    """Make a button of 4 mm travel, drawn, to be edited. Raises ModelError on a name that is none."""
    template = ModelTemplate(template)
    points = np.array(_PRESS_cN[template], dtype=np.float64)
    degree = 3
    knots = uniform_knots(0.0, TRAVEL_mm, points.size, degree).round(6)
    forces = {Stroke.PRESS: points, Stroke.RELEASE: points - FRICTION_cN}
    return FDVVModel(
        name=name,
        travel_mm=TRAVEL_mm,
        curves=tuple(ForceCurve(s, VELOCITY_mm_s, degree, knots, f) for s, f in forces.items()),
        actuation_mm=2.0,
        reset_mm=1.8,
        provenance=Provenance(
            method=f"drawn from the {template} template", assumptions=("Nothing is measured.",)
        ),
    )


LONGEST, LONGEST_bytes = 60, 200
"""Characters, and bytes of UTF-8: with a suffix and in any script a name stays below the 255 bytes of file
systems."""

_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_SAFE = re.compile(r"\w[\w .+()-]*", re.UNICODE)


def check_name(name: str, there: Iterable[str] = ()) -> str:
    """Return a name that every file system takes, and that is not there yet in any case.

    Raises InputError on another, with the reason.
    """
    tidy = unicodedata.normalize("NFC", name)
    reason = _wrong(tidy)
    if reason:
        raise InputError("studio", "name", f"{name[:LONGEST]!r} {reason}", "choose another name")
    for other in there:
        if other.casefold() == tidy.casefold():
            raise InputError("studio", "name", f"there is a button {other!r} already", "choose another name")
    return tidy


def _wrong(name: str) -> str:
    if not name:
        return "is empty"
    if len(name) > LONGEST:
        return f"is longer than {LONGEST} characters"
    if len(name.encode(errors="replace")) > LONGEST_bytes:
        return f"is longer than {LONGEST_bytes} bytes; letters of this script take up to four each"
    if not _SAFE.fullmatch(name) or name[0] == "_":
        return "must begin with a letter or digit and have only letters, digits, spaces and . + - _ ( )"
    if name[-1] in " .":
        return "must not end with a space or a point"
    return "is reserved by an operating system" if _RESERVED.fullmatch(name) else ""


def free_name(wanted: str, there: Iterable[str]) -> str:
    """Return a valid free name near the wanted one: "name", "name 2", "name 3"."""
    taken = {name.casefold() for name in there}
    base = re.sub(r"[^\w .+()-]+", "-", unicodedata.normalize("NFC", wanted)).strip(" ._-+()")
    base = _cut(base).rstrip(" .") or "button"
    if _wrong(base):
        base = _cut(f"button {base}")
    number, name = 1, base
    while name.casefold() in taken:
        number += 1
        name = f"{base} {number}"
    return name


NUMBER_length = 6
"""What is left for a number behind a name."""


def _cut(name: str) -> str:
    """Return as much of a name as leaves room for a number."""
    fits = name.encode(errors="replace")[: LONGEST_bytes - NUMBER_length].decode(errors="ignore")
    return fits[: LONGEST - NUMBER_length]
