"""The shape of a ``*.fdvv-program.json`` file, as it is checked on reading and published as a JSON schema."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta

from fdvv.documents import tidy_schema
from fdvv.program._program import During, Velocity

FORMAT = "fdvv-program"
VERSION = 1
"""Of the program file."""

Name = Annotated[str, Meta(min_length=1, max_length=40)]
Reference = Annotated[Name | None, Meta(description="a name, or null")]
ConditionName = Literal[
    "always",
    "deeper_than_mm",
    "shallower_than_mm",
    "turned_to_press",
    "turned_to_release",
    "faster_than_mm_s",
    "slower_than_mm_s",
    "after_ms",
    "host_event",
    "risen_by_mm",
    "fallen_by_mm",
]
ConditionRecord = Annotated[
    dict[ConditionName, float | Literal[True]],
    Meta(
        min_length=1,
        max_length=1,
        description="one condition and its value; true for always, turned_to_press and turned_to_release",
        extra_json_schema={"propertyNames": {"enum": list(get_args(ConditionName))}},
    ),
]


class SurfaceRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Force on displacement and velocity, bilinear between its points, its edges held outside."""

    name: Annotated[Name, Meta(description="how states refer to it")]
    displacement_mm: Annotated[list[float], Meta(min_length=2, description="rising, mm, in any steps")]
    velocity_mm_s: Annotated[list[float], Meta(min_length=1, description="rising from 0 or more, mm/s")]
    force_cN: Annotated[
        list[list[float]],
        Meta(min_length=1, description="a row of forces per velocity, cN; negative pulls the cap down"),
    ]


class ModeRecord(msgspec.Struct, forbid_unknown_fields=True):
    """One sinusoid of the cap's acceleration, amplitude exp(-decay t) sin(2 pi frequency t + phase)."""

    frequency_Hz: Annotated[float, Meta(gt=0, description="frequency, Hz")]
    amplitude_m_s2: Annotated[float, Meta(description="acceleration at the start, m/s²")]
    decay_1_s: Annotated[float, Meta(ge=0, description="decay, 1/s")]
    phase_rad: Annotated[float, Meta(description="phase at the start, rad")] = 0.0


class SignalRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A short vibration of the cap, without a place."""

    name: Annotated[Name, Meta(description="how states, transitions and vibrations refer to it")]
    duration_s: Annotated[float, Meta(gt=0, description="length, s")]
    modes: Annotated[list[ModeRecord], Meta(min_length=1, description="the sinusoids that add up to it")]


class TransitionRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The way to another state."""

    to: Annotated[Name, Meta(description="state to enter")]
    when: ConditionRecord
    only_if: Annotated[ConditionRecord | None, Meta(description="a second condition that must hold too")] = (
        None
    )
    signal: Annotated[
        Reference, Meta(description="played on the way, instead of the entered state's own")
    ] = None


class StateRecord(msgspec.Struct, forbid_unknown_fields=True):
    """What is felt and reported until a transition leads on."""

    name: Annotated[Name, Meta(description="how transitions refer to it")]
    press: Annotated[Name, Meta(description="surface looked up while the cap goes down")]
    release: Annotated[Name, Meta(description="surface looked up while it comes up")]
    key: Annotated[
        int, Meta(ge=0, le=255, description="reported to the host: 0 up, else the level that is down")
    ] = 0
    velocity: Annotated[Velocity, Meta(description="which velocity chooses the row of the surfaces")] = (
        Velocity.DECIDED
    )
    enter_signal: Annotated[Reference, Meta(description="played on entering")] = None
    repeat_signal: Annotated[Reference, Meta(description="played again and again in the state")] = None
    repeat_ms: Annotated[int, Meta(ge=0, le=65_535, description="its period, ms; 0 with none")] = 0
    fade_ms: Annotated[
        int, Meta(ge=0, le=2000, description="time in which the force moves to this state's, ms")
    ] = 0
    bias_cN: Annotated[float, Meta(description="added to the surface's force, cN")] = 0.0
    bias_end_cN: Annotated[float, Meta(description="what the bias has become after bias_ms, cN")] = 0.0
    bias_ms: Annotated[
        int, Meta(ge=0, le=65_535, description="time over which the bias changes, ms; 0: it does not")
    ] = 0
    transitions: Annotated[
        list[TransitionRecord], Meta(description="tried in this order; the first that holds is taken")
    ] = []


class VibrationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A signal felt at a displacement, once per stroke."""

    signal: Annotated[Name, Meta(description="what is played")]
    at_mm: Annotated[float, Meta(description="where it is to be felt, mm")]
    stroke: Annotated[During, Meta(description="in which direction")] = During.PRESS
    slowest_mm_s: Annotated[float | None, Meta(description="only at or above this velocity, mm/s")] = None
    fastest_mm_s: Annotated[float | None, Meta(description="only below this velocity, mm/s")] = None
    states: Annotated[list[Name], Meta(description="only in these states; empty: in all")] = []


class ProgramRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A button as a machine of states."""

    format: Annotated[Literal["fdvv-program"], Meta(description="tells the file from other JSON")]
    version: Annotated[Literal[1], Meta(description="of this format")]
    name: Annotated[Name, Meta(description="short, as a file would be called")]
    travel_mm: Annotated[float, Meta(gt=0, description="where the bottom stop is set, mm")]
    start: Annotated[Name, Meta(description="state entered first")]
    states: Annotated[list[StateRecord], Meta(min_length=1, description="no two of one name")]
    surfaces: Annotated[list[SurfaceRecord], Meta(min_length=1, description="no two of one name")]
    signals: Annotated[list[SignalRecord], Meta(description="no two of one name")] = []
    vibrations: Annotated[list[VibrationRecord], Meta(description="signals tied to displacements")] = []
    description: Annotated[str, Meta(description="what the button does, for people")] = ""


def schema() -> dict[str, Any]:
    """Give the JSON schema of the file, as published in docs/reference/fdvv-program.schema.json."""
    found = msgspec.json.schema(ProgramRecord)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **tidy_schema(found)}
