"""A button as MuJoCo's XML: springs that switch in one after another draw its force curve.

MuJoCo knows no tabulated spring. A fixed tendon whose springlength is a pair of numbers, however, has no
force between them, so that tendons of one joint, each with its own dead zone, add up to any broken line;
the line's straight part is an actuator with affine bias. Both are documented and need positive stiffnesses
only. What a broken line over displacement cannot hold is the loop and the speed: they become Coulomb
friction and damping, and what that leaves is reported per stroke and velocity.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from fdvv.errors import ModelError
from fdvv.formats.exchange.exchange_format import Follow
from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray, N_from_cN, m_from_mm


def polyline(x: FloatArray, y: FloatArray, tolerance: float) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Choose samples whose straight joints stay within tolerance of all samples (Ramer, Douglas and Peucker).

    x : (n,) strictly rising; y : (n,). Gives the chosen indices, rising, both ends among them. Deviation is
        measured along y, which is what a force's error is.
    """
    chosen, spans = {0, x.size - 1}, [(0, x.size - 1)]
    while spans:
        first, last = spans.pop()
        inside = slice(first + 1, last)
        line = y[first] + (y[last] - y[first]) * (x[inside] - x[first]) / (x[last] - x[first])
        off = np.abs(y[inside] - line)
        if off.size and off.max() > tolerance:
            worst = first + 1 + int(np.argmax(off))
            chosen.add(worst)
            spans += [(first, worst), (worst, last)]
    return np.array(sorted(chosen), dtype=np.intp)


TOLERANCE_cN = 0.25
"""Of the broken line against the curve it follows: below what fingers and the rig can resolve."""
STEP_mm = 0.005
CAP_g = 1.0
"""A keycap with its stem; no model knows it, and a joint of MuJoCo must have a mass."""
FAR_m = 1.0
UNKNOWN_mm_s = 10.0
"""Curves of unknown velocity come from slow benches; every speed gives the same there."""


@dataclass(frozen=True, eq=False)
class SpringButton:
    """A button as MuJoCo's own springs: force = line(x) + friction sign(v) + damping v.

    Attributes
    ----------
    displacement_mm, force_cN : (n,) corners of the broken line.
    friction_cN : half the loop.
    damping_cN_s_mm : rise of force with speed.
    errors : per stroke and velocity (stroke, mm/s or None, rms cN, largest cN) against the model.
    """

    displacement_mm: FloatArray
    force_cN: FloatArray
    friction_cN: float
    damping_cN_s_mm: float
    errors: tuple[tuple[Stroke, float | None, float, float], ...]

    def force_at_cN(self, displacement_mm: FloatArray, velocity_mm_s: float, stroke: Stroke) -> FloatArray:
        """Evaluate what the springs give on a stroke; its speed is positive."""
        line = np.interp(displacement_mm, self.displacement_mm, self.force_cN)
        sign = 1.0 if stroke is Stroke.PRESS else -1.0
        return np.asarray(line + sign * (self.friction_cN + self.damping_cN_s_mm * velocity_mm_s))


def spring_button(
    model: FDVVModel,
    tolerance_cN: float = TOLERANCE_cN,
    follow: Follow = "press",
    velocity_mm_s: float | None = None,
) -> SpringButton:
    """Fit line, friction and damping to a model. Raises ModelError if it has no press curve.

    Friction and damping are the least squares of half the difference of press and release over speed, neither
    below 0; the line is what then is left of the presses or of both strokes: at one velocity if one is given,
    else the mean over the model's. Pieces of the line stray from it by tolerance_cN at most.
    velocity_mm_s : of that one velocity; None: all of the model's.
    """
    if not model.of(Stroke.PRESS):
        raise ModelError(f"model {model.name!r} has no press curve, MuJoCo's joint needs one")
    x = np.linspace(0.0, model.travel_mm, max(2, round(model.travel_mm / STEP_mm) + 1))
    speeds = np.array(model.velocities_mm_s(Stroke.PRESS) or (UNKNOWN_mm_s,))
    press, release = _strokes(model, x, speeds)
    friction, damping = _loop(speeds, np.median(press - release, axis=1) / 2)
    if velocity_mm_s is not None:
        speeds = np.array([velocity_mm_s])
        press, release = _strokes(model, x, speeds)
    loop = friction + damping * speeds[:, np.newaxis]
    middle = np.mean(press - loop if follow == "press" else (press + release) / 2, axis=0)
    at = polyline(x, middle, tolerance_cN)
    made = SpringButton(x[at], middle[at], friction, damping, ())
    errors = [_error(model, made, x, curve) for stroke in Stroke for curve in model.of(stroke)]
    return replace(made, errors=tuple(errors))


def _strokes(model: FDVVModel, x: FloatArray, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    grid = (x[np.newaxis], speeds[:, np.newaxis])
    press = model.force_cN(*grid, Stroke.PRESS)
    return press, model.force_cN(*grid, Stroke.RELEASE) if model.of(Stroke.RELEASE) else press


def _loop(speeds: FloatArray, half_cN: FloatArray) -> tuple[float, float]:
    from scipy.optimize import nnls

    if speeds.size == 1:
        return max(float(half_cN[0]), 0.0), 0.0
    found, _ = nnls(np.stack([np.ones(speeds.size), speeds], axis=1), half_cN)
    return float(found[0]), float(found[1])


def _error(
    model: FDVVModel, made: SpringButton, x: FloatArray, curve: ForceCurve
) -> tuple[Stroke, float | None, float, float]:
    v = curve.velocity_mm_s or UNKNOWN_mm_s
    off = made.force_at_cN(x, v, curve.stroke) - model.force_cN(x, v, curve.stroke)
    return curve.stroke, curve.velocity_mm_s, float(np.sqrt(np.mean(off**2))), float(np.abs(off).max())


def mjcf(
    model: FDVVModel,
    tolerance_cN: float = TOLERANCE_cN,
    cap_mass_g: float = CAP_g,
    follow: Follow = "press",
    velocity_mm_s: float | None = None,
) -> Exported:
    """Write a button as an MJCF file of its own: body, slide joint, springs, sensors, points of the contact.

    Displacement is the joint's position in m, positive into the button; control ``button`` is what a finger
    adds, N. velocity_mm_s : the one velocity that the line is of; None: all of the model's.
    Raises ModelError if the model has no press curve or the mass is not positive.
    """
    if not (np.isfinite(cap_mass_g) and cap_mass_g > 0):
        raise ModelError(f"cap_mass_g must be positive, got {cap_mass_g}")
    springs = spring_button(model, tolerance_cN, follow, velocity_mm_s)
    figures: dict[str, float | None] = {
        "pieces": float(springs.displacement_mm.size - 1),
        "friction_cN": springs.friction_cN,
        "damping_cN_s_mm": springs.damping_cN_s_mm,
        "worst_cN": max(error[3] for error in springs.errors),
    }
    for stroke, v, rms, largest in springs.errors:
        speed = "" if v is None else f"_{v:g}mm_s"
        figures |= {f"{stroke}{speed}_rms_cN": rms, f"{stroke}{speed}_max_cN": largest}
    lost = ["how loop and speed change over displacement", "the contact's switching"]
    lost += ["vibrations"] if model.vibrations else []
    return Exported(
        "mjcf",
        scene_xml(model, cap_mass_g, springs).encode(),
        ("force over displacement", "the median loop as friction", "travel", "contact points as numbers"),
        tuple(lost),
        figures,
    )


def scene_xml(model: FDVVModel, cap_mass_g: float, springs: SpringButton | None) -> str:
    """Write the scene; without springs the joint is bare and a callback gives the force."""
    from jinja2 import StrictUndefined, Template

    look: Any = {"trim_blocks": True, "lstrip_blocks": True, "keep_trailing_newline": True}
    scene = Template(
        files("fdvv_haptics").joinpath("scene.xml").read_text("utf-8"),
        undefined=StrictUndefined,
        **look,
    )
    start_N, slope_N_m, bends = _springs(springs) if springs else (0.0, 0.0, [])
    points_mm = {"button_actuation_m": model.actuation_mm, "button_reset_m": model.reset_mm}
    text: str = scene.render(
        # XML holds no control characters, whatever a file's name was
        name=quoteattr("".join(c if c.isprintable() else "?" for c in model.name)),
        springs=springs,
        travel_m=m_from_mm(model.travel_mm),
        mass_kg=cap_mass_g / 1000,
        friction_N=N_from_cN(springs.friction_cN) if springs else 0.0,
        damping_N_s_m=N_from_cN(springs.damping_cN_s_mm) * 1000.0 if springs else 0.0,
        start_N=start_N,
        slope_N_m=slope_N_m,
        bends=bends,
        points_m={name: m_from_mm(at) for name, at in points_mm.items() if at is not None},
    )
    return text


def _springs(springs: SpringButton) -> tuple[float, float, list[dict[str, Any]]]:
    """Turn the broken line into an affine bias and tendons, one for each corner.

    Where the slope rises by k the tendon pulls beyond the corner; where it falls by k a tendon pulls up to
    it.
    """
    corner_m, force_N = m_from_mm(springs.displacement_mm), N_from_cN(springs.force_cN)
    slopes = np.diff(force_N) / np.diff(corner_m)
    bends, corner_m = np.diff(slopes), corner_m[1:-1]
    slope = slopes[-1] - bends[bends > 0].sum()
    # what the tendons that hold back before their corner pull at 0
    start = force_N[0] - (bends[bends < 0] * corner_m[bends < 0]).sum()
    tendons = [
        {"stiffness_N_m": abs(k), "zone_m": f"{-FAR_m:g} {at:.9g}" if k > 0 else f"{at:.9g} {FAR_m:g}"}
        for at, k in zip(corner_m, bends, strict=True)
    ]
    return -start, -slope, tendons


def fine_surface(model: FDVVModel, step_mm: float, points: int) -> ForceSurface:
    """Tabulate a model densely: displacement in steps, velocities from rest to the fastest known."""
    known = model.velocities_mm_s(Stroke.PRESS) + model.velocities_mm_s(Stroke.RELEASE)
    # a model of unknown velocities is the same at every speed; two rows are what a table needs
    dense = np.linspace(0.0, max(known), points) if known else np.array([0.0, UNKNOWN_mm_s])
    return ForceSurface.of_model(model, np.unique(np.append(dense, sorted(set(known)))), step_mm)
