"""The file ``jnds.json``: JNDs of a study's people, by which a project judges."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from statistics import NormalDist, geometric_mean
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from fdvv.errors import InputError
from fdvv.force_text import force_text
from fdvv.io.documents import Kind, pretty, read_record
from fdvv.io.files import write_atomic
from fdvv.model.noticeable import AT_JND, DIMENSIONS, LITERATURE, Dimension, Jnds, JndSource

FILE_NAME = "jnds.json"
"""Its name in a project."""
REMEDY = f"write {FILE_NAME} again with fdvv study jnds, or remove it"
KIND = Kind("fdvv-jnds", 1, "a file of JNDs", REMEDY)
LARGEST_bytes = 1_000_000  # room for thousands of thresholds of a few hundred bytes; a study measures a few

WIDE_factor = 2.0
"""By which an interval may reach either way of its middle."""

Ratio = Annotated[float, Meta(ge=0.001, le=10)]
End = Annotated[float, Meta(gt=0)]
"""Of an interval: of two people alone it can be very wide."""
Count = Annotated[int, Meta(ge=1)]
Size = Annotated[float, Meta(gt=0, le=1e6)]


class MeasuredJnd(msgspec.Struct, forbid_unknown_fields=True):
    """The threshold of one dimension at one reference button, over people.

    Attributes
    ----------
    button, condition : the reference, by its name in the study, and the stimulus that was the standard.
    standard, unit : what a threshold is a part of: the force at the peak, or at bottom-out without one; the
        fall of force behind it; the largest amplitude of the vibration's modes.
    above : of a vibration, the standard over the faintest that is felt; null of force and snap.
    ratio : the threshold, geometric mean over people. low, high : its 95 % interval; null where one person
        alone gives none.
    people, trials : that count.
    """

    dimension: Dimension
    button: str
    condition: str
    standard: Size
    unit: Literal["cN", "m/s²"]
    ratio: Ratio
    low: End | None
    high: End | None
    people: Count
    trials: Count
    above: Size | None = None


class JndRecord(msgspec.Struct, forbid_unknown_fields=True):
    """What a study measured of its people.

    Attributes
    ----------
    study, kind, fingerprint : the study's name and kind, and the fingerprint that it was frozen with.
    simulated : no person took part.
    task : what people were asked. share_correct : part of the comparisons that is right at the threshold.
    velocity_mm_s : of presses, at which the standards were read.
    """

    format: Literal["fdvv-jnds"]
    version: Literal[1]
    study: str
    kind: str
    fingerprint: str
    simulated: bool
    task: str
    share_correct: Annotated[float, Meta(ge=0.55, le=0.95)]
    velocity_mm_s: Size
    people: Count
    trials: Count
    jnds: Annotated[list[MeasuredJnd], Meta(min_length=1)]

    @property
    def whose(self) -> str:
        """Who was measured, in words."""
        people = "1 person" if self.people == 1 else f"{self.people} people"
        return f"{people} of study {self.study}{' (simulated)' if self.simulated else ''}"

    @property
    def origin(self) -> str:
        """Whose JNDs they are, and of what unless it is everything that a study can measure."""
        there = [dimension for dimension in DIMENSIONS if self.of(dimension)]
        of = "" if len(there) == len(DIMENSIONS) else f"of {' and '.join(there)} "
        return f"JNDs {of}of {self.whose}"

    def of(self, dimension: Dimension) -> list[MeasuredJnd]:
        """Return what was measured of a dimension, by reference."""
        return [jnd for jnd in self.jnds if jnd.dimension == dimension]

    def doubts(self) -> list[str]:
        """Say why these JNDs should not be relied on, a line each; empty if nothing speaks against them."""
        wide = [
            f"{jnd.dimension} of {jnd.button}: the interval is wider than a factor of {WIDE_factor:g} either "
            "way; measure more people"
            for jnd in self.jnds
            if jnd.low is None or jnd.high is None or jnd.high > WIDE_factor**2 * jnd.low
        ]
        proxy = ["simulated participants are a proxy, no evidence of what people notice"]
        return [*(proxy if self.simulated else ()), *wide]


def save_jnds(record: JndRecord, path: Path) -> None:
    """Write the file whole or not at all. OSError."""
    write_atomic(path, pretty(msgspec.to_builtins(record)) + "\n")


def load_jnds(path: Path) -> Jnds:
    """Read the JNDs of a file, or of the project in a folder. InputError."""
    if path.is_dir():
        if not (path / FILE_NAME).exists():
            reason, remedy = f"holds no {FILE_NAME}", "write one: fdvv study jnds STUDY --into PROJECT"
            raise InputError(path, "project", reason, remedy)
        path = path / FILE_NAME
    record = read_record(path, KIND, JndRecord, LARGEST_bytes)
    for place, jnd in enumerate(record.jnds):
        if (jnd.dimension == "vibration") != (jnd.above is not None):
            reason = f"a JND of {jnd.dimension} must {'have' if jnd.above is None else 'not have'} it"
            raise InputError(path, f"$.jnds[{place}].above", reason, REMEDY)
    return jnds_of(record)


def project_jnds(project: Path) -> Jnds:
    """Return the JNDs that a project judges by: the literature's where it has no file. InputError."""
    return load_jnds(project) if (project / FILE_NAME).exists() else LITERATURE


def jnds_of(record: JndRecord) -> Jnds:
    """Return the literature's JNDs, scaled so that they agree with what was measured at the references.

    A study knows one point of each curve. Its form is kept from the literature: a JND is a constant part of
    what is large, and a constant amount where it is small. What was not measured stays as it is. A threshold
    at another share than three of four is carried over by d' in proportion to the change. Of several
    references the geometric mean counts.
    """
    jnds = replace(LITERATURE, origin=record.origin)
    for kind in DIMENSIONS:
        if measured := record.of(kind):
            jnds = _rescale(jnds, kind, geometric_mean(_scale(jnd, record.share_correct) for jnd in measured))
    return replace(jnds, sources=tuple(_source(dimension, jnds, record) for dimension in LITERATURE.sources))


def _scale(jnd: MeasuredJnd, share: float) -> float:
    """Return a measured JND over the literature's at the same reference."""
    at_share = AT_JND / NormalDist().inv_cdf(share)
    if jnd.dimension == "vibration":
        assert jnd.above is not None  # load_jnds has looked
        return at_share * jnd.ratio * jnd.above / float(LITERATURE.vibration(jnd.above))
    expected_cN = LITERATURE.snap_cN if jnd.dimension == "snap" else LITERATURE.force_cN(jnd.standard)
    return at_share * jnd.ratio * jnd.standard / float(expected_cN)


def _rescale(jnds: Jnds, dimension: Dimension, scale: float) -> Jnds:
    if dimension == "force":
        return replace(jnds, force_ratio=scale * jnds.force_ratio)
    if dimension == "snap":
        return replace(jnds, snap_cN=scale * jnds.snap_cN)
    return replace(jnds, vibration_ratio=scale * jnds.vibration_ratio)


SOURCE_OF: dict[str, Dimension] = {"force": "force", "snap": "snap", "vibration, strength": "vibration"}
"""Which sources of the literature a study replaces."""


def _source(literature: JndSource, jnds: Jnds, record: JndRecord) -> JndSource:
    """Return where a JND comes from now."""
    dimension = SOURCE_OF.get(literature.of)
    if dimension is None or not record.of(dimension):
        return literature
    measured = "; ".join(map(_describe, record.of(dimension)))
    source = f"{record.whose}, {100 * record.share_correct:.3g} % right at {measured}"
    value, assumed = _value_and_assumed(dimension, jnds)
    return JndSource(literature.of, value, source, assumed)


def _value_and_assumed(dimension: Dimension, jnds: Jnds) -> tuple[str, str]:
    return {
        "force": (
            f"{100 * jnds.force_ratio:.1f} % of (force + {force_text(jnds.force_floor_cN)})",
            f"the {force_text(jnds.force_floor_cN)}, as in the literature's; that the JND of a whole button "
            "holds at every place of a stroke",
        ),
        "snap": (
            f"{force_text(jnds.snap_cN, '.1f')} of a fall of force",
            "that it is the same at larger and smaller falls",
        ),
        "vibration": (
            f"{100 * jnds.vibration_ratio:.0f} % of an amplitude well above the faintest, more near it",
            "how it grows near the faintest, as in the literature's",
        ),
    }[dimension]


def _describe(jnd: MeasuredJnd) -> str:
    between = (
        "" if jnd.low is None or jnd.high is None else f" ({100 * jnd.low:.1f} to {100 * jnd.high:.1f} %)"
    )
    size = force_text(jnd.standard, ".0f") if jnd.unit == "cN" else f"{jnd.standard:.3g} {jnd.unit}"
    return f"{100 * jnd.ratio:.1f} %{between} of the {size} of {jnd.button}"
