"""The shape of a ``*.fdvv.json`` file, as it is checked on reading and published as a JSON schema."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from fdvv.documents import tidy_schema
from fdvv.model._curve import Stroke
from fdvv.model._spread_records import CurveSpreadRecord, PointSpreadRecord, VibrationSpreadRecord
from fdvv.model._velocity import Interpolation

FORMAT = "fdvv-model"
VERSION = 2
"""Of a file with spreads; one without is of version 1, which had no place for them."""

StrokeName = Annotated[Stroke, Meta(description="press or release")]


class CurveRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Force on displacement for one stroke at one velocity, as a clamped B-spline."""

    stroke: StrokeName
    velocity_mm_s: Annotated[
        Annotated[float, Meta(gt=0)] | None,
        Meta(description="mean speed of the stroke, mm/s; null if unknown, and then the stroke's only curve"),
    ]
    degree: Annotated[int, Meta(ge=1, le=5, description="polynomial degree k")]
    knots_mm: Annotated[
        list[float],
        Meta(
            min_length=4,
            description="n + k + 1 knots, mm, not falling; the first and last k + 1 equal, the curve's ends",
        ),
    ]
    control_points_cN: Annotated[
        list[float], Meta(min_length=2, description="n coefficients, cN, one per basis function")
    ]
    spread: Annotated[
        CurveSpreadRecord | None, Meta(description="between presses; null or absent if not measured")
    ] = None


class ModeRecord(msgspec.Struct, forbid_unknown_fields=True):
    """One sinusoid of the cap's acceleration, amplitude exp(-decay t) sin(2 pi frequency t + phase)."""

    frequency_Hz: Annotated[float, Meta(gt=0, description="frequency, Hz")]
    amplitude_m_s2: Annotated[float, Meta(description="acceleration at the onset, m/s²")]
    decay_1_s: Annotated[float, Meta(ge=0, description="decay, 1/s")]
    phase_rad: Annotated[float, Meta(description="phase at the onset, rad")] = 0.0


class VibrationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The vibration of one stroke at one velocity."""

    stroke: StrokeName
    velocity_mm_s: Annotated[
        Annotated[float, Meta(gt=0)] | None,
        Meta(description="speed it was found at, mm/s; null if it serves every speed"),
    ]
    onset_mm: Annotated[float, Meta(description="displacement at which it starts, mm")]
    duration_s: Annotated[float, Meta(gt=0, description="length, s; the signal is zero after it")]
    modes: Annotated[list[ModeRecord], Meta(min_length=1, description="the sinusoids that add up to it")]
    spread: Annotated[
        VibrationSpreadRecord | None, Meta(description="between presses; null or absent if not measured")
    ] = None


class ProvenanceRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Where the model comes from."""

    source: Annotated[str, Meta(description="the button and who measured it")] = ""
    licence: Annotated[str, Meta(description="of the measurements, as their publisher states it")] = ""
    citation: Annotated[str, Meta(description="how to credit it")] = ""
    method: Annotated[str, Meta(description="how the curves were made from the source, and edits since")] = ""
    assumptions: Annotated[list[str], Meta(description="what no measurement backs, one sentence each")] = []
    simulated: Annotated[bool, Meta(description="whether the numbers come from the twin")] = False


class ModelRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A button as force over displacement and velocity, with its vibration (FDVV)."""

    format: Annotated[Literal["fdvv-model"], Meta(description="tells the file from other JSON")]
    version: Annotated[Literal[1, 2], Meta(description="of this format; 2 if the file tells of spreads")]
    name: Annotated[str, Meta(min_length=1, description="short, as a file would be called")]
    travel_mm: Annotated[float, Meta(gt=0, description="from first contact to bottom-out, mm")]
    actuation_mm: Annotated[
        Annotated[float, Meta(ge=0)] | None,
        Meta(description="where the contact closes on the press, mm; null if unknown"),
    ]
    reset_mm: Annotated[
        Annotated[float, Meta(ge=0)] | None,
        Meta(description="where the contact opens on the release, mm; null if unknown"),
    ]
    interpolation: Annotated[Interpolation, Meta(description="how force is found between the velocities")]
    curves: Annotated[
        list[CurveRecord],
        Meta(min_length=1, description="no two of one stroke and velocity; in any order"),
    ]
    vibrations: Annotated[list[VibrationRecord], Meta(description="no two of one stroke and velocity")] = []
    provenance: Annotated[ProvenanceRecord, Meta(description="where the model comes from")] = msgspec.field(
        default_factory=ProvenanceRecord
    )
    travel_spread: Annotated[
        PointSpreadRecord | None, Meta(description="of travel_mm; null or absent if not measured")
    ] = None
    actuation_spread: Annotated[
        PointSpreadRecord | None, Meta(description="of actuation_mm; null or absent if not measured")
    ] = None
    reset_spread: Annotated[
        PointSpreadRecord | None, Meta(description="of reset_mm; null or absent if not measured")
    ] = None


def schema() -> dict[str, Any]:
    """Give the JSON schema of the file format, as published in docs/reference/fdvv.schema.json."""
    found = msgspec.json.schema(ModelRecord)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **tidy_schema(found)}
