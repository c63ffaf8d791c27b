"""A button as MuJoCo's XML: springs that switch in one after another draw its force curve.

MuJoCo knows no tabulated spring. A fixed tendon whose springlength is a pair of numbers, however, has no
force between them, so that tendons of one joint, each with its own dead zone, add up to any broken line;
the line's straight part is an actuator with affine bias. Both are documented and need positive stiffnesses
only. What a broken line over displacement cannot hold is the loop and the speed: they become Coulomb
friction and damping, and what that leaves is reported per stroke and velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal
from xml.sax.saxutils import quoteattr

import numpy as np

from fdvv.errors import ModelError
from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray, N_from_cN, m_from_mm


def polyline(x: FloatArray, y: FloatArray, tolerance: float) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Choose samples whose straight joints stay within tolerance of all samples (Ramer, Douglas and Peucker).

    x : (n,) strictly rising; y : (n,). Gives the chosen indices, rising, both ends among them. Deviation is
        measured along y, which is what a force's error is.
    """
    chosen = {0, x.size - 1}
    spans = [(0, x.size - 1)]
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

Follow = Literal["press", "both"]
"""What the line draws: the presses, which people feel first, or the middle of both strokes."""


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
        """Evaluate what the springs give on a stroke.

        velocity_mm_s : its speed, positive.
        """
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
    errors = tuple(_error(model, made, x, stroke, v) for stroke in Stroke for v in _known(model, stroke))
    return SpringButton(x[at], middle[at], friction, damping, errors)


def _known(model: FDVVModel, stroke: Stroke) -> tuple[float | None, ...]:
    return tuple(c.velocity_mm_s for c in model.of(stroke))


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
    model: FDVVModel, made: SpringButton, x: FloatArray, stroke: Stroke, velocity_mm_s: float | None
) -> tuple[Stroke, float | None, float, float]:
    v = velocity_mm_s or UNKNOWN_mm_s
    off = made.force_at_cN(x, v, stroke) - model.force_cN(x, v, stroke)
    return stroke, velocity_mm_s, float(np.sqrt(np.mean(off**2))), float(np.abs(off).max())


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
    worst = max(error[3] for error in springs.errors)
    figures: dict[str, float | None] = {
        "pieces": float(springs.displacement_mm.size - 1),
        "friction_cN": springs.friction_cN,
        "damping_cN_s_mm": springs.damping_cN_s_mm,
        "worst_cN": worst,
    }
    for stroke, v, rms, largest in springs.errors:
        speed = "" if v is None else f"_{v:g}mm_s"
        figures |= {f"{stroke}{speed}_rms_cN": rms, f"{stroke}{speed}_max_cN": largest}
    return Exported(
        "mjcf",
        scene_xml(model, cap_mass_g, springs).encode(),
        ("force over displacement", "the median loop as friction", "travel", "contact points as numbers"),
        ("how loop and speed change over displacement", "the contact's switching", *_vibration(model)),
        figures,
    )


def _vibration(model: FDVVModel) -> tuple[str, ...]:
    return ("vibrations",) if model.vibrations else ()


def scene_xml(model: FDVVModel, cap_mass_g: float, springs: SpringButton | None) -> str:
    """Write the scene; without springs the joint is bare and a callback gives the force."""
    held = N_from_cN(springs.friction_cN) if springs else 0.0
    loss = N_from_cN(springs.damping_cN_s_mm) * 1000.0 if springs else 0.0
    joint = f'frictionloss="{held:.9g}" damping="{loss:.9g}"'
    line, tendons = _springs(springs) if springs else ("0 0 0", "")
    points = "".join(
        f'    <numeric name="{name}" data="{m_from_mm(at):.9g}"/>\n'
        for name, at in (("button_actuation_m", model.actuation_mm), ("button_reset_m", model.reset_mm))
        if at is not None
    )
    return SCENE.format(
        # XML holds no control characters, whatever a file's name was
        name=quoteattr("".join(c if c.isprintable() else "?" for c in model.name)),
        travel=f"{m_from_mm(model.travel_mm):.9g}",
        mass=f"{cap_mass_g / 1000:.9g}",
        joint=joint,
        line=line,
        tendons=f"  <tendon>\n{tendons}  </tendon>\n" if tendons else "",
        custom=f"  <custom>\n{points}  </custom>\n" if points else "",
        userdata="" if springs else '  <size nuserdata="1"/>\n',
        closed=""
        if springs
        else '    <user name="button_closed" dim="1" needstage="pos" datatype="positive"/>\n',
    )


def _springs(springs: SpringButton) -> tuple[str, str]:
    """Turn the broken line into an affine bias and tendons, one for each corner.

    Where the slope rises by k the tendon pulls beyond the corner; where it falls by k a tendon pulls up to
    it.
    """
    x, force = m_from_mm(springs.displacement_mm), N_from_cN(springs.force_cN)
    slopes = np.diff(force) / np.diff(x)
    bends = np.diff(slopes)
    corners = x[1:-1]
    slope = slopes[-1] - bends[bends > 0].sum()
    # what the tendons that hold back before their corner pull at 0
    start = force[0] - (bends[bends < 0] * corners[bends < 0]).sum()
    rows = []
    for i, (at, bend) in enumerate(zip(corners, bends, strict=True)):
        zone = f"{-FAR_m:g} {at:.9g}" if bend > 0 else f"{at:.9g} {FAR_m:g}"
        rows.append(
            f'    <fixed name="bend{i}" springlength="{zone}" stiffness="{abs(bend):.9g}">'
            '<joint joint="button" coef="1"/></fixed>\n'
        )
    return f"{-start:.9g} {-slope:.9g} 0", "".join(rows)


# limits and friction are constraints whose stiffness goes with the mass: with MuJoCo's defaults a cap of a
# gram would sink into its stops, and friction would only be full at speeds of metres a second
SCENE = """<mujoco model={name}>
  <!-- SI units; the joint's position is the displacement into the button -->
  <option timestep="0.0001" integrator="implicitfast"/>
{userdata}  <worldbody>
    <body name="button" gravcomp="1">
      <joint name="button" type="slide" axis="0 0 -1" limited="true" range="0 {travel}"
        solreflimit="0.001 1" solimplimit="0.99 0.999 0.0001"
        solreffriction="0.0002 1" solimpfriction="0.99 0.999 0.0001" {joint}/>
      <geom name="cap" type="box" size="0.006 0.006 0.002" mass="{mass}" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
{tendons}  <actuator>
    <general name="button" joint="button" gainprm="1" biastype="affine" biasprm="{line}"/>
  </actuator>
  <sensor>
    <jointpos name="button_displacement" joint="button"/>
    <jointvel name="button_velocity" joint="button"/>
{closed}  </sensor>
{custom}</mujoco>
"""


def fine_surface(model: FDVVModel, step_mm: float, points: int) -> ForceSurface:
    """Tabulate a model densely: displacement in steps, velocities from rest to the fastest known."""
    known = model.velocities_mm_s(Stroke.PRESS) + model.velocities_mm_s(Stroke.RELEASE)
    # a model of unknown velocities is the same at every speed; two rows are what a table needs
    dense = np.linspace(0.0, max(known), points) if known else np.array([0.0, UNKNOWN_mm_s])
    return ForceSurface.of_model(model, np.unique(np.append(dense, sorted(set(known)))), step_mm)
