"""The designs of the paper: three points of a force curve, where it activates and where it vibrates.

Liao, Kim, Lee, Oulasvirta, "Button Simulation and Design via FDVV Models" (CHI 2020), human-in-the-loop
button optimisation: x1 in [0, 1), x2 in [1, 3), x3 in [3, 6.2) mm, y1 to y3 in [20, 180] of an actuation
signal, activation and vibration in [0.5, 5.5] mm.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from fdvv.errors import InputError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv_people.optimize.space import BUTTON_LENGTH, Constraint, Design, DesignSpace, Parameter

PAPER_TRAVEL_mm = 6.2
"""How deep the paper's designs go."""
LARGEST_cN, LARGEST_signal = 440.0, 255.0
"""What the paper's linear motor gives at full signal; force is taken as proportional to it."""
SIGNALS = (20.0, 180.0)
APART_mm = 0.01
"""The ranges of x are open above; two neighbours keep this distance."""
TEMPLATE = Mode(frequency_Hz=239.0, amplitude_m_s2=4.6, decay_1_s=130.7)
TEMPLATE_s = 0.016
"""The paper's vibration, as the shipped MX Clear has it."""


def paper_space(constraints: tuple[Constraint, ...] = ()) -> DesignSpace:
    """Return the paper's eight parameters with their ranges; any constraints on top, as of a rig."""
    low_cN, high_cN = (LARGEST_cN * signal / LARGEST_signal for signal in SIGNALS)
    edges = (0.0, 1.0, 3.0, PAPER_TRAVEL_mm)
    along = (Parameter(f"x{i + 1}_mm", edges[i], edges[i + 1] - APART_mm) for i in range(3))
    force = (Parameter(f"y{i + 1}_cN", low_cN, high_cN) for i in range(3))
    points = (Parameter(f"{what}_mm", 0.5, 5.5) for what in ("actuation", "vibration"))
    return DesignSpace("paper", (*along, *force, *points), constraints, BUTTON_LENGTH)


def paper_model(design: Design, name: str = "design") -> FDVVModel:
    """Make the button of a paper design: one curve for press and release at any velocity.

    Between its three points the force is a monotone cubic, so no bump appears that no point asks for;
    before the first and after the last it holds. Activation and reset are one point.
    """
    x = np.array([design[f"x{i}_mm"] for i in (1, 2, 3)])
    y = np.array([design[f"y{i}_cN"] for i in (1, 2, 3)])
    knots, coefficients = _monotone(x, y)
    onset_mm = design["vibration_mm"]
    return FDVVModel(
        name=name,
        travel_mm=PAPER_TRAVEL_mm,
        curves=tuple(ForceCurve(stroke, None, 3, knots, coefficients) for stroke in Stroke),
        actuation_mm=design["actuation_mm"],
        reset_mm=design["actuation_mm"],
        vibrations=tuple(Vibration(stroke, None, onset_mm, TEMPLATE_s, (TEMPLATE,)) for stroke in Stroke),
        provenance=Provenance(
            method="eight parameters of the paper's optimisation",
            assumptions=(
                "Force is proportional to the paper's actuation signal, 4.4 N at 255.",
                "The paper does not tell how force runs between its points; here a monotone cubic.",
                "The release takes the press's curve and the contact opens where it closes.",
            ),
        ),
    )


def _monotone(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Write the monotone cubic (PCHIP) through three points as a B-spline with a double inner knot."""
    from scipy.interpolate import PchipInterpolator

    slope = PchipInterpolator(x, y)(x, nu=1)
    third = np.diff(x) / 3
    after, before = y[:2] + slope[:2] * third, y[1:] - slope[1:] * third
    knots = np.concatenate([np.full(4, x[0]), np.full(2, x[1]), np.full(4, x[2])])
    return knots, np.array([y[0], after[0], before[0], after[1], before[1], y[2]])


PLACES = 7
"""Tried in the range of each point."""


def paper_design_like(model: FDVVModel) -> dict[str, float]:
    """Return the design whose points are nearest to a button's slowest press in the mean square.

    The three places are searched on a grid; what a range does not reach stays at its bound. InputError on a
    model without a press.
    """
    if not model.of(Stroke.PRESS):
        raise InputError(model.name, "curves", "it has no press", "start from another button")
    space = paper_space()
    curve = model.of(Stroke.PRESS)[0]
    x = np.linspace(0.0, model.travel_mm, 100)
    wanted = curve.force_cN(np.clip(x, curve.start_mm, curve.end_mm))
    tried = [_points(space, places, x, wanted) for places in product(*_places(space, model.travel_mm))]
    best = min(tried, key=lambda points: _miss(points, x, wanted))
    names = (*(f"x{i}_mm" for i in (1, 2, 3)), *(f"y{i}_cN" for i in (1, 2, 3)))
    design = dict(zip(names, best.T.ravel().tolist(), strict=True))
    actuation_mm = model.actuation_mm if model.actuation_mm is not None else model.travel_mm / 2
    onset_mm = model.vibrations[0].onset_mm if model.vibrations else actuation_mm
    return space.nearest({**design, "actuation_mm": actuation_mm, "vibration_mm": onset_mm})


def _places(space: DesignSpace, travel_mm: float) -> list[FloatArray]:
    """Return what is tried for each place; none beyond the travel but where the range begins there."""
    ranges = [one for one in space.parameters if one.name.startswith("x")]
    return [np.linspace(one.low, max(one.low, min(one.high, travel_mm)), PLACES) for one in ranges]


def _points(space: DesignSpace, places: tuple[float, ...], x: FloatArray, wanted: FloatArray) -> FloatArray:
    """Put the points on the curve, within their ranges, (3, 2)."""
    low, high = next((one.low, one.high) for one in space.parameters if one.name == "y1_cN")
    return np.column_stack([places, np.clip(np.interp(places, x, wanted), low, high)])


def _miss(points: FloatArray, x: FloatArray, wanted: FloatArray) -> float:
    return float(np.mean((np.interp(x, *points.T) - wanted) ** 2))
