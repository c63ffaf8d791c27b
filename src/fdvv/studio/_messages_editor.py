"""Messages of the editor: what a rig makes of the curves that are being drawn, and what was measured."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

Velocity = Annotated[float, Meta(ge=0.01, le=5000)]
StrokeName = Literal["press", "release"]


class RigsAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask which rigs there are."""


class RigChoice(Struct, frozen=True, forbid_unknown_fields=True):
    """One rig; known : it answers at once, else it is met first, which takes about a second."""

    rig_id: str
    about: str
    simulated: bool
    known: bool


class Rigs(Struct, frozen=True, forbid_unknown_fields=True):
    """The rigs of the project, the shipped ones first."""

    rigs: list[RigChoice]


class AchievableAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask what a rig makes of both strokes of a model at some speeds.

    model : a document as in a ``*.fdvv.json`` file. velocities_mm_s : null for a curve of unknown velocity.
    """

    model: msgspec.Raw
    velocities_mm_s: Annotated[list[Velocity | None], Meta(min_length=1, max_length=24)]
    rig_id: str


class LimitedPart(Struct, frozen=True, forbid_unknown_fields=True):
    """Where a limit of force (or duty) or of its slew cuts."""

    start_mm: float
    end_mm: float
    limit: Literal["force", "slew"]


class AchievableForce(Struct, frozen=True, forbid_unknown_fields=True):
    """One stroke at one speed, computed; expected_mean_cN : error that learning leaves, an estimate."""

    stroke: StrokeName
    velocity_mm_s: float
    displacement_mm: list[float]
    intended_cN: list[float]
    achievable_cN: list[float]
    limited: list[LimitedPart]
    verdict: str
    reasons: list[str]
    expected_mean_cN: float


class Achievable(Struct, frozen=True, forbid_unknown_fields=True):
    """What a rig makes of the curves, presses before releases."""

    curves: list[AchievableForce]


class ButtonAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the model of any button, to take curves from."""

    button_id: str


class ButtonTold(Struct, frozen=True, forbid_unknown_fields=True):
    """A model as in a ``*.fdvv.json`` file; a measured button is fitted for it."""

    model: msgspec.Raw


class MeasuredAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for what presses of a button gave; name as in its id."""

    name: str


class MeasuredForce(Struct, frozen=True, forbid_unknown_fields=True):
    """One stroke at one speed: quartiles of the force over the presses."""

    stroke: StrokeName
    velocity_mm_s: float
    displacement_mm: list[float]
    low_cN: list[float]
    median_cN: list[float]
    high_cN: list[float]
    mean_error_cN: float


class MeasuredPresses(Struct, frozen=True, forbid_unknown_fields=True):
    """What presses gave; simulated : they came from the twin."""

    device_name: str
    presses: int
    simulated: bool
    curves: list[MeasuredForce]


class Measured(Struct, frozen=True, forbid_unknown_fields=True):
    """The presses of a button; null if none were kept."""

    found: MeasuredPresses | None
