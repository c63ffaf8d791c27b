"""The winning design on a device: rendered, measured afresh, and captured back into a model. Simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.bench.model import RecordedModel, model_of_recording
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.contract import Device
from fdvv.device.open import open_device
from fdvv.errors import DeviceError, FitError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.recording.types import Quantity, Recording, Stage, Stream, Take
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import ProbeResult, probe
from fdvv.report.records import RenderedBand, RenderedCurve
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger, PressVariability
from fdvv.units import N_from_cN
from fdvv_people.optimize.experiment.experiment import ExperimentResult
from fdvv_people.optimize.experiment.setup import OPTIMAL, RANDOM
from fdvv_people.optimize.paper_space import paper_model

WINNER_RIG = "paper"
"""Shipped rig that renders the winner."""
TRAVEL_mm = 6.0
"""The stop is set this deep: a firm press on the paper's 6.2 mm goes beyond what the rig's sensor tells."""
CANDIDATES = 5
"""So many of the best designs are tried; a finger cannot follow every curve to the stop."""
PACE_mm_s = 100.0
PRESSES = 15
BEYOND_N = 1.0
"""By how much the measuring finger pushes harder than the hardest place of the button."""
EDGE_mm = 0.3
"""Near rest and stop the captured curve is not compared: there a press is more finger than button."""


@dataclass(frozen=True, eq=False)
class Winner:
    """A design that won, as found.

    Attributes
    ----------
    person : from 0. reduction_ratio : by which part its validation lies below the mean of the switches.
    """

    person: int
    level: str
    design: dict[str, float]
    reduction_ratio: float

    @property
    def model(self) -> FDVVModel:
        return paper_model(self.design, f"optimal of person {self.person + 1}, {self.level}")

    @property
    def rendered(self) -> FDVVModel:
        """What is rendered of it: the button with its stop at TRAVEL_mm."""
        return replace(self.model, travel_mm=TRAVEL_mm)


@dataclass(frozen=True, eq=False)
class RenderedWinner:
    """A winner on a device.

    Attributes
    ----------
    probed : errors of fresh presses against the design. captured : the model that those presses came to.
    difference_cN : mean |captured - designed| by stroke, away from rest and stop.
    refused : designs that did better and could not be rendered, each with its reason.
    """

    winner: Winner
    probed: ProbeResult
    captured: RecordedModel
    difference_cN: dict[str, float]
    refused: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the figures for a file."""
        return {
            "person": self.winner.person,
            "level": self.winner.level,
            "parameters": self.winner.design,
            "reduction_ratio": self.winner.reduction_ratio,
            "device": self.probed.device_name,
            "rig": WINNER_RIG,
            "probed_mean_error_cN": {
                str(c.stroke): float(np.median(c.mean_errors_cN)) for c in self.probed.curves
            },
            "captured_difference_cN": self.difference_cN,
            "captured_travel_mm": self.captured.model.travel_mm,
            "refused": list(self.refused),
            "simulated": self.probed.simulated,
        }


def winners_of(result: ExperimentResult) -> tuple[Winner, ...]:
    """Rank the designs by how they did in validation against the same person's switches, the best first.

    The first is the best of many noisy ones: it shows a design, its score is no estimate of how good it is.
    """
    found = [
        Winner(one.person, one.level, one.best, _reduction(result, one.person, one.level))
        for one in result.trainings
    ]
    return tuple(sorted(found, key=lambda winner: -winner.reduction_ratio))


def render_best(result: ExperimentResult) -> RenderedWinner:
    """Render the best design that the simulated rig and finger can follow to the stop.

    Raises DeviceError, with the reason of the last, if none of the first CANDIDATES can be.
    """
    refused: list[str] = []
    for winner in winners_of(result)[:CANDIDATES]:
        try:
            devices = open_winner_devices(winner.rendered, result.setup.seed)
            return replace(render_winner(winner, *devices), refused=tuple(refused))
        except (DeviceError, ModelError, FitError) as error:
            # a session says after its reason how to go on with it; here there is none
            refused.append(f"person {winner.person + 1}, {winner.level}: {error.__cause__ or error}")
    raise DeviceError(f"none of the best {len(refused)} designs can be rendered; the last: {refused[-1]}")


def _reduction(result: ExperimentResult, person: int, level: str) -> float:
    theirs = [o for o in result.observations if (o.person, o.level) == (person, level)]
    optimal = np.mean([o.asynchrony_ms for o in theirs if o.button == OPTIMAL])
    switches = np.mean([o.asynchrony_ms for o in theirs if o.button not in (OPTIMAL, RANDOM)])
    return float(1.0 - optimal / switches)


def open_winner_devices(model: FDVVModel, seed: int) -> tuple[Device, Device]:
    """Open the simulated rig that renders winners twice: to learn on, and to measure on with another seed.

    Its finger pushes firmly enough to reach the stop: people of the task need not, but whoever measures must.
    """
    x = np.linspace(0.0, model.travel_mm, 200)
    peak_N = float(N_from_cN(model.force_cN(x, PACE_mm_s, Stroke.PRESS).max()))
    finger = Finger(habit=PressVariability(push_N=max(PressVariability().push_N, peak_N + BEYOND_N)))
    rig = load_rig(WINNER_RIG)
    return open_device("twin", rig, finger, seed), open_device("twin", rig, finger, seed + 1000)


def render_winner(winner: Winner, learn_on: Device, measure_on: Device) -> RenderedWinner:
    """Learn a winner's actuation on a device, measure it afresh, and capture it as a model.

    learn_on, measure_on : the same rig; simulated ones with different seeds. The presses that are captured
    are as the device's own sensors saw them.

    Raises DeviceError if the device fails, ModelError or FitError if its presses make no model.
    """
    model = winner.rendered
    learned = compensate(learn_on, model, [PACE_mm_s], RigAware())
    tuning = learned.outcome.tuning
    probed = probe(
        measure_on, model, learned.surface, [PACE_mm_s], PRESSES, method=learned.method, tuning=tuning
    )
    presses = [measure_on.press(PACE_mm_s) for _ in range(PRESSES)]
    captured = model_of_recording(recording_of(presses, model.name))
    return RenderedWinner(winner, probed, captured, _difference_cN(captured.model, model))


def method_curves(rendered: RenderedWinner) -> list[RenderedCurve]:
    """Return the design, fresh presses (median and quartiles) and the captured model, for a figure."""
    model, curves = rendered.captured.model, []
    for one in rendered.probed.curves:
        low, middle, high = np.percentile(one.rendered_cN, [25, 50, 75], axis=0)
        bands = [RenderedBand("fresh presses, median and quartiles", middle, low, high)]
        if model.of(one.stroke):
            captured = model.force_cN(np.minimum(one.displacement_mm, model.travel_mm), PACE_mm_s, one.stroke)
            bands.append(RenderedBand("captured model", captured, captured, captured))
        cell = one.stroke, one.velocity_mm_s, one.displacement_mm, one.target_cN, tuple(bands)
        curves.append(RenderedCurve(*cell, simulated=rendered.probed.simulated))
    return curves


def recording_of(presses: list[Press], name: str) -> Recording:
    """Make a recording of a device's presses, one take each, as its sensors saw them.

    Where the device tells its ticks only those count: between them it repeats what it last sensed.
    DeviceError if it senses no force.
    """
    takes = []
    for number, press in enumerate(presses, 1):
        if press.sensed_mm is None or press.sensed_cN is None:
            raise DeviceError("the device tells neither displacement nor force of its presses")
        rows = np.arange(press.t_s.size) if press.tick is None else np.flatnonzero(press.tick)
        columns = {Quantity.DISPLACEMENT: press.sensed_mm, Quantity.FORCE: press.sensed_cN}
        streams = tuple(
            Stream(str(quantity), quantity, "device", press.t_s[rows], column[rows])
            for quantity, column in columns.items()
        )
        takes.append(Take(number, streams, (), Stage.PRESS, press.velocity_mm_s))
    simulated = any(press.simulated for press in presses)
    return Recording(name, tuple(takes), simulated=simulated)


def _difference_cN(captured: FDVVModel, designed: FDVVModel) -> dict[str, float]:
    x = np.linspace(EDGE_mm, min(captured.travel_mm, designed.travel_mm) - EDGE_mm, 200)
    return {
        str(stroke): float(
            np.mean(np.abs(captured.force_cN(x, PACE_mm_s, stroke) - designed.force_cN(x, PACE_mm_s, stroke)))
        )
        for stroke in Stroke
        if captured.of(stroke)
    }
