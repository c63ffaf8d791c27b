"""The editor: rigs, what they make of the curves that are being drawn, and measured forces."""

from __future__ import annotations

from typing import Annotated, Literal, cast

import msgspec
import numpy as np
from msgspec import Meta

from fdvv.model.file import model_from_json, model_to_json
from fdvv.rendering.feasibility import CurveFeasibility
from fdvv.rendering.rig_catalog import LimitedRange, RigEntry, ranges_at_limit
from fdvv.rendering.rig_catalog import achievable as make_achievable
from fdvv_studio.project.measured_bands import MeasuredButton, load_measured_button
from fdvv_studio.studio.contract import Empty, Message, call
from fdvv_studio.studio.rounding import round_row
from fdvv_studio.studio.studio import Studio

Velocity = Annotated[float, Meta(ge=0.01, le=5000)]
StrokeName = Literal["press", "release"]


class Rigs(Message):
    """The rigs of the project, the shipped ones first."""

    rigs: list[RigEntry]


class AchievableAsk(Message):
    """Ask what a rig makes of both strokes of a model at some speeds.

    model : a document as in a ``*.fdvv.json`` file. velocities_mm_s : null for a curve of unknown velocity.
    """

    model: msgspec.Raw
    velocities_mm_s: Annotated[list[Velocity | None], Meta(min_length=1, max_length=24)]
    rig_id: str


class AchievableForce(Message):
    """One stroke at one speed, computed; expected_mean_cN : error that learning leaves, an estimate."""

    stroke: StrokeName
    velocity_mm_s: float
    displacement_mm: tuple[float, ...]
    intended_cN: tuple[float, ...]
    achievable_cN: tuple[float, ...]
    limited: tuple[LimitedRange, ...]
    verdict: str
    reasons: tuple[str, ...]
    expected_mean_cN: float


class Achievable(Message):
    """What a rig makes of the curves, presses before releases."""

    curves: list[AchievableForce]


class ButtonAsk(Message):
    """Ask for the model of any button, to take curves from."""

    button_id: str


class ButtonModel(Message):
    """A model as in a ``*.fdvv.json`` file; a measured button is fitted for it."""

    model: msgspec.Raw


class MeasuredAsk(Message):
    """Ask for what presses of a button gave; name as in its id."""

    name: str


class Measured(Message):
    """The presses of a button; null if none were kept."""

    found: MeasuredButton | None


POINTS = 201
"""Points of a curve: 0.02 mm on a button of 4 mm."""
DECIMALS = 4
"""Of mm and cN on the way to a screen."""


@call("editor.rigs")
def rigs(studio: Studio, _ask: Empty) -> Rigs:
    return Rigs(list(studio.rigs.entries()))


@call("editor.achievable")
def achievable(studio: Studio, ask: AchievableAsk) -> Achievable:
    model = model_from_json(bytes(ask.model), "the button")
    rig = studio.rigs.rig(ask.rig_id)
    return Achievable([_curve(c) for c in make_achievable(model, rig, ask.velocities_mm_s)])


@call("editor.button")
def button(studio: Studio, ask: ButtonAsk) -> ButtonModel:
    return ButtonModel(msgspec.Raw(model_to_json(studio.catalog.model(ask.button_id)).encode()))


@call("editor.measured")
def read_measured(studio: Studio, ask: MeasuredAsk) -> Measured:
    return Measured(load_measured_button(studio.project, ask.name))


def _curve(curve: CurveFeasibility) -> AchievableForce:
    reached, x = curve.reached, curve.reached.displacement_mm
    places = np.linspace(x[0], x[-1], min(POINTS, x.size))
    forces = (np.interp(places, x, column) for column in (reached.intended_cN, reached.achievable_cN))
    x_mm, intended_cN, achievable_cN = (round_row(column, DECIMALS) for column in (places, *forces))
    return AchievableForce(
        cast(StrokeName, str(curve.stroke)),
        curve.velocity_mm_s,
        x_mm,
        intended_cN,
        achievable_cN,
        tuple(ranges_at_limit(reached)),
        str(curve.verdict.following),
        curve.verdict.reasons,
        curve.expected.mean_cN,
    )
