"""The real button under the finger: slider, leaf on its cam or dome, stops and plate, in SI units.

Sources: "curves" is what the button's own slow curves say, or were drawn to say; "assumed" has no source
and must be swept; "literature" is cited in docs/explanation/real-buttons.md.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.twin.quantity import Section, choice, quantity
from fdvv.units import FloatArray, N_from_cN, m_from_mm

FEWEST_FORCES = 8
BUILT = ("elastic_N", "height_m", "rail_N", "friction_ratio")
"""Columns of a BuiltCam."""
STEP_mm = 0.02  # as Curve.step_m, which is left at its default


@dataclass(frozen=True)
class Curve(Section):
    """What the slow press and release curves belong to; identified, so never drawn at random."""

    kind: str = choice("leaf", "what the force comes from", ("leaf", "dome"), "curves")
    step_m: float = quantity(
        2e-5, "spacing of press_N and release_N", "m", (5e-6, 5e-5), (1e-6, 5e-4), "curves"
    )
    speed_m_s: float = quantity(
        5e-4, "speed they were measured at", "m/s", (1e-4, 1e-3), (1e-6, 0.05), "curves"
    )
    travel_m: float = quantity(0.004, "bottom stop", "m", (0.0015, 0.0042), (5e-4, 0.01), "curves")
    close_m: float = quantity(
        0.002, "where the circuit closes on a slow press", "m", (5e-4, 0.0026), (1e-4, 0.01), "curves"
    )
    open_m: float = quantity(
        0.002, "where a dome's circuit opens again", "m", (5e-4, 0.0026), (0.0, 0.01), "curves"
    )
    seat_m: float = quantity(
        1e-4, "depth up to which the top stop shapes the curve", "m", (5e-5, 4e-4), (0.0, 0.002), "curves"
    )
    force_ratio: float = quantity(
        1.0, "this unit's force over that of the curves", "", (0.8, 1.2), (0.1, 10.0), "literature"
    )


@dataclass(frozen=True)
class Slider(Section):
    """What moves with the cap, and how it rubs: stem, cap, a third of the spring, markers."""

    mass_kg: float = quantity(0.003, "moving mass", "kg", (0.0013, 0.004), (3e-4, 0.05))
    viscous_N_s_m: float = quantity(0.15, "viscous drag", "N s/m", (0.05, 0.4), (0.0, 20.0))
    bristle_m: float = quantity(1e-5, "way over which friction turns round", "m", (8e-6, 2e-5), (5e-6, 1e-3))


@dataclass(frozen=True)
class Leaf(Section):
    """The leaf spring that rides on the cam and falls on the fixed contact; unused by a dome."""

    mass_kg: float = quantity(5e-5, "effective mass", "kg", (3e-5, 1e-4), (1e-5, 0.01))
    stiffness_N_m: float = quantity(300.0, "stiffness", "N/m", (200.0, 500.0), (10.0, 1e4))
    damping_ratio: float = quantity(
        0.05, "damping of the free leaf, of critical", "", (0.02, 0.1), (0.0, 1.0)
    )
    cam_stiffness_N_m: float = quantity(2e4, "leaf on plastic cam", "N/m", (1e4, 4e4), (1e3, 1e5))
    cam_loss_s_m: float = quantity(1.0, "alpha of that contact", "s/m", (0.3, 3.0), (0.0, 50.0))
    fixed_stiffness_N_m: float = quantity(
        1000.0, "fixed contact, itself a leaf", "N/m", (600.0, 2000.0), (100.0, 1e5)
    )
    fixed_loss_s_m: float = quantity(1.0, "alpha of that contact", "s/m", (0.3, 3.0), (0.0, 50.0))


@dataclass(frozen=True)
class Dome(Section):
    """The rubber: one relaxing arm makes the loop, a law of velocity makes it stiffer; unused by a leaf."""

    law: str = choice("log", "how force grows with speed", ("log", "linear"), "literature")
    log_ratio: float = quantity(
        0.028, "growth per e-fold of 1 + v / log_speed", "", (0.02, 0.035), (0.0, 0.5), "literature"
    )
    log_speed_m_s: float = quantity(
        5e-4, "speed where the logarithm begins", "m/s", (2e-4, 1e-3), (1e-6, 0.1)
    )
    linear_s_m: float = quantity(
        1.55, "growth per speed of the linear law", "s/m", (1.3, 1.9), (0.0, 50.0), "literature"
    )
    arm_m: float = quantity(1e-4, "way over which the arm turns round", "m", (5e-5, 3e-4), (5e-6, 0.01))
    arm_s: float = quantity(2.0, "time in which the arm relaxes", "s", (0.5, 10.0), (0.01, 1e4))


@dataclass(frozen=True)
class Housing(Section):
    """The stops of the housing (Hunt-Crossley) and the two modes of the plate under it."""

    bottom_stiffness_N_m: float = quantity(
        5e4, "bottom stop", "N/m", (2e4, 1e5), (1e3, 3e5), "literature, assumed"
    )
    bottom_loss_s_m: float = quantity(3.0, "alpha of it", "s/m", (2.0, 4.0), (0.0, 50.0))
    top_stiffness_N_m: float = quantity(2e4, "top stop", "N/m", (1e4, 5e4), (1e3, 3e5))
    top_loss_s_m: float = quantity(3.0, "alpha of it", "s/m", (2.0, 4.0), (0.0, 50.0))
    first_Hz: float = quantity(239.0, "first mode", "Hz", (150.0, 350.0), (20.0, 5000.0), "literature")
    first_damping_ratio: float = quantity(0.1, "damping of it, of critical", "", (0.05, 0.15), (0.0, 1.0))
    first_kg: float = quantity(0.04, "modal mass of it", "kg", (0.02, 0.1), (1e-3, 100.0))
    second_Hz: float = quantity(900.0, "second mode", "Hz", (600.0, 1500.0), (20.0, 5000.0))
    second_damping_ratio: float = quantity(0.06, "damping of it, of critical", "", (0.03, 0.1), (0.0, 1.0))
    second_kg: float = quantity(0.03, "modal mass of it", "kg", (0.015, 0.08), (1e-3, 100.0))
    snap_ratio: float = quantity(
        0.5, "part of the leaf's blow on the fixed contact that drives the plate", "", (0.2, 1.0), (0.0, 1.0)
    )


def _hold(record: object, name: str, fewest: int, rule: str) -> None:
    """Make a field an array that cannot be written; ModelError unless it is a finite column of so many."""
    column = np.array(getattr(record, name), dtype=np.float64)
    if column.ndim != 1 or column.size < fewest or not np.isfinite(column).all():
        raise ModelError(f"{name} must {rule}")
    column.flags.writeable = False
    object.__setattr__(record, name, column)


@dataclass(frozen=True, eq=False)
class BuiltCam:
    """Coil, cam and friction of a leaf switch as it is built, in place of what its slow curves would give.

    Attributes
    ----------
    elastic_N, height_m, rail_N, friction_ratio : (n,) at the places of press_N: force of the coil less that
        of the top stop, height of the cam, 0 where the leaf just reaches the fixed contact, friction of the
        rails, coefficient between cam and leaf.
    preload_N : of the leaf where it just reaches the fixed contact.
    """

    elastic_N: FloatArray
    height_m: FloatArray
    rail_N: FloatArray
    friction_ratio: FloatArray
    preload_N: float

    def __post_init__(self) -> None:
        for name in BUILT:
            _hold(self, name, 0, "be one column of finite numbers")
        if len({getattr(self, name).size for name in BUILT}) != 1:
            raise ModelError(f"{', '.join(BUILT)} must be equally long")
        if not self.preload_N > 0 or min(self.rail_N.min(), self.friction_ratio.min()) < 0:
            raise ModelError("a leaf's preload must be above 0, and no friction below it")


@dataclass(frozen=True, eq=False)
class ButtonPhysics:
    """One real button as the twin has it; nothing here changes during a press.

    Attributes
    ----------
    name, source, licence : of the button and of the curves it is made from.
    press_N, release_N : (n,) slow force at 0, curve.step_m, ... up to the stop.
    cam : of a designed leaf switch; None: identified from the slow curves. Only for kind "leaf".
    """

    name: str
    source: str
    licence: str
    press_N: FloatArray
    release_N: FloatArray
    curve: Curve = field(default_factory=Curve)
    slider: Slider = field(default_factory=Slider)
    leaf: Leaf = field(default_factory=Leaf)
    dome: Dome = field(default_factory=Dome)
    housing: Housing = field(default_factory=Housing)
    cam: BuiltCam | None = None

    def __post_init__(self) -> None:
        for name in ("press_N", "release_N"):
            _hold(self, name, FEWEST_FORCES, f"hold at least {FEWEST_FORCES} finite forces")
        if self.press_N.size != self.release_N.size:
            sizes = f"{self.press_N.size} and {self.release_N.size}"
            raise ModelError(f"press_N and release_N must be equally long, got {sizes}")
        if self.cam and (self.curve.kind != "leaf" or self.cam.height_m.size != self.press_N.size):
            raise ModelError("a built cam is for a leaf, and as long as press_N")
        self._check_places()

    def _check_places(self) -> None:
        curve = self.curve
        reach_m = (self.press_N.size - 1) * curve.step_m
        if not reach_m <= curve.travel_m + 1e-9 < reach_m + curve.step_m + 2e-9:
            raise ModelError(
                f"press_N must end less than a step before travel_m {curve.travel_m:g} m, not at {reach_m:g}"
            )
        if not curve.seat_m < curve.close_m < curve.travel_m:
            raise ModelError(
                f"close_m must lie between seat_m {curve.seat_m:g} and travel_m {curve.travel_m:g} m, "
                f"got {curve.close_m:g}"
            )
        if curve.open_m > curve.close_m:
            raise ModelError(f"open_m must not exceed close_m {curve.close_m:g} m, got {curve.open_m:g}")


def button_of_model(model: FDVVModel, close_mm: float | None = None, seat_mm: float = 0.1) -> ButtonPhysics:
    """Make a leaf switch of a model; everything its curves do not say keeps its default.

    close_mm : where the circuit closes, the model's activation point if None.
    seat_mm : depth up to which the top stop shapes the curves.

    Raises ModelError if a stroke is missing, or no activation point is known.
    """
    close = model.actuation_mm if close_mm is None else close_mm
    if close is None:
        raise ModelError(f"{model.name}: the model has no activation point; say where the circuit closes")
    if not all(model.of(stroke) for stroke in Stroke):
        raise ModelError(f"{model.name}: a real button needs curves of press and release")
    press_cN, release_cN = (_slowest_cN(model, stroke) for stroke in Stroke)
    origin, at_m = model.provenance, _metres(close)
    return ButtonPhysics(
        model.name,
        f"model {model.name}: {origin.source}. {origin.citation}",
        origin.licence,
        N_from_cN(press_cN),
        N_from_cN(np.maximum(release_cN, 0.0)),
        Curve(travel_m=_metres(model.travel_mm), close_m=at_m, open_m=at_m, seat_m=_metres(seat_mm)),
    )


def _slowest_cN(model: FDVVModel, stroke: Stroke) -> FloatArray:
    curve = min(model.of(stroke), key=lambda c: c.velocity_mm_s or 0.0)
    count = int(np.floor(model.travel_mm / STEP_mm + 1e-9)) + 1
    return np.asarray(curve.force_cN(STEP_mm * np.arange(count)))


def _metres(length_mm: float) -> float:
    return round(m_from_mm(length_mm), 9)
