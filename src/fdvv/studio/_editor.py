"""The editor's questions: rigs, what they make of a curve, and what was measured."""

from __future__ import annotations

from typing import cast

import msgspec

from fdvv.model import model_from_json, model_to_json
from fdvv.studio._contract import Call, ChannelKind
from fdvv.studio._messages_editor import (
    Achievable,
    AchievableAsk,
    AchievableForce,
    ButtonAsk,
    ButtonTold,
    LimitedPart,
    Measured,
    MeasuredAsk,
    MeasuredForce,
    MeasuredPresses,
    RigChoice,
    Rigs,
    RigsAsk,
    StrokeName,
)
from fdvv.studio._studio import Studio
from fdvv.units import FloatArray
from fdvv.workflow import AchievableCurve, LimitedRange, MeasuredBand, RigShelf, measured_button
from fdvv.workflow import achievable as make_achievable

DECIMALS = 4
"""Of mm and cN on the way to a screen."""


class RigService:
    """The project's rigs, each read or met once."""

    def __init__(self, studio: Studio) -> None:
        self.shelf = RigShelf(studio.project)


def rigs(studio: Studio, _ask: RigsAsk) -> Rigs:
    """List the rigs of the project."""
    entries = studio.part(RigService).shelf.entries()
    return Rigs([RigChoice(e.rig_id, e.about, e.simulated, e.known) for e in entries])


def achievable(studio: Studio, ask: AchievableAsk) -> Achievable:
    """Tell what a rig makes of both strokes of a model at the speeds asked for."""
    model = model_from_json(bytes(ask.model), "the button")
    rig = studio.part(RigService).shelf.rig(ask.rig_id)
    return Achievable([_curve(c) for c in make_achievable(model, rig, ask.velocities_mm_s)])


def button(studio: Studio, ask: ButtonAsk) -> ButtonTold:
    """Give the model of any button that the shelf knows."""
    return ButtonTold(msgspec.Raw(model_to_json(studio.shelf.model(ask.button_id)).encode()))


def measured(studio: Studio, ask: MeasuredAsk) -> Measured:
    """Tell what presses of a button gave, if any were kept in the project."""
    found = measured_button(studio.project, ask.name)
    if found is None:
        return Measured(None)
    bands = [_band(band) for band in found.bands]
    return Measured(MeasuredPresses(found.device_name, found.presses, found.simulated, bands))


def _curve(curve: AchievableCurve) -> AchievableForce:
    return AchievableForce(
        cast(StrokeName, str(curve.stroke)),
        curve.velocity_mm_s,
        _rounded(curve.displacement_mm),
        _rounded(curve.intended_cN),
        _rounded(curve.achievable_cN),
        [_part(part) for part in curve.limited],
        curve.verdict,
        list(curve.reasons),
        curve.expected_mean_cN,
    )


def _part(part: LimitedRange) -> LimitedPart:
    return LimitedPart(part.start_mm, part.end_mm, part.limit)


def _band(band: MeasuredBand) -> MeasuredForce:
    stroke = cast(StrokeName, str(band.stroke))
    low, median, high = map(list, (band.low_cN, band.median_cN, band.high_cN))
    places = list(band.displacement_mm)
    return MeasuredForce(stroke, band.velocity_mm_s, places, low, median, high, band.mean_error_cN)


def _rounded(column: FloatArray) -> list[float]:
    return cast("list[float]", column.round(DECIMALS).tolist())


CALLS = (
    Call("editor.rigs", RigsAsk, Rigs, rigs),
    Call("editor.achievable", AchievableAsk, Achievable, achievable),
    Call("editor.button", ButtonAsk, ButtonTold, button),
    Call("editor.measured", MeasuredAsk, Measured, measured),
)
CHANNELS: tuple[ChannelKind, ...] = ()
