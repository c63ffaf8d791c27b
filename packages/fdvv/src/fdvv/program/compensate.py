"""A program on an identified rig: its surfaces as commands, or as targets of the force loop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fdvv.compensation.force_loop.method import lift_target_cN
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import CompensationJob
from fdvv.compensation.rig_learning import Learning, command_cN, command_surface, inertia_cN
from fdvv.compensation.tables import SharedTable
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.program.program import Program, State, Velocity
from fdvv.program.surface import Surface, of_model, of_surface, returning
from fdvv.units import FloatArray

STEP_mm = 0.02
DIGITS_cN = 4
FRICTION_mm_s = 10.0
"""From this speed on the controller compensates friction in full, whatever row of a surface serves."""

Table = Callable[[Surface, FloatArray, FloatArray], FloatArray]
"""Makes forces of a surface, its displacements (n,) and its forces there (rows, n)."""


def loop_targets(program: Program) -> Program:
    """Return a program as the targets of a closed force loop: the same, lifted just under the top stop."""
    return _with_tables(program, lambda s, x, table: lift_target_cN(x, table) if _returns(s) else table)


def commands(program: Program, known: LearnedRig, force_limit_cN: float) -> Program:
    """Return a program whose surfaces and biases are the commands that render it on a rig without a cell.

    The rig's weight and gain are in the surfaces; drag, friction and lag belong to the controller
    (`tuning_of`). What the rig has taught is added where a finger moves the cap (`_finger_surfaces`), in rows
    of the speeds at which it was learned. A surface that brings the cap back also holds it up at rest. A bias
    is divided by the gain at mid travel. Compile the result without a weight.
    """
    rig, led = known.rig, _finger_surfaces(program)

    def table_cN(surface: Surface, x_mm: FloatArray, table: FloatArray) -> FloatArray:
        learned = led.get(surface.name)
        more = 0.0 if learned is None else _residual_cN(known, learned, surface, x_mm, program.travel_mm)
        if not _returns(surface):
            return np.clip(command_cN(rig, x_mm, table) + more, -force_limit_cN, force_limit_cN)
        return _commands_cN(rig, program, x_mm, table, force_limit_cN, more)

    wide = replace(program, surfaces=tuple(_add_rows(s, known, s.name in led) for s in program.surfaces))
    gain = float(rig.gain_at(np.array(0.5 * program.travel_mm)))
    made = _with_tables(wide, table_cN)
    return replace(made, states=tuple(_scale_bias(state, gain) for state in made.states))


def with_learned(made: Program, program: Program, learned: ForceSurface, button: FDVVModel) -> Program:
    """Return a rendering with the tables that were learned for a button where the program has its surfaces.

    made : the rendering of program. What is not exactly the button's own stays as it was made.
    """
    own = {s: (of_model(button, s), returning(of_model(button, s))) for s in Stroke}
    strokes = {
        surface.name: stroke
        for surface in program.surfaces
        for stroke in Stroke
        if any(surface.force_cN == variant.force_cN for variant in own[stroke])
    }
    surfaces = tuple(
        of_surface(learned, strokes[s.name], s.name) if s.name in strokes else s for s in made.surfaces
    )
    return replace(made, surfaces=surfaces)


def _commands_cN(
    rig: RigModel,
    program: Program,
    x_mm: FloatArray,
    table: FloatArray,
    limit_cN: float,
    more_cN: FloatArray | float,
) -> FloatArray:
    """Return the commands of one surface as a table of forces has them."""
    # speeds beyond FRICTION_mm_s, whatever the rows' are: the controller compensates friction in all of them
    rows = FRICTION_mm_s + np.arange(float(len(table)))
    job = CompensationJob(ForceSurface(x_mm, rows, table, table), program.travel_mm, limit_cN)
    learned = SharedTable(x_mm, rows, np.zeros_like(table) + more_cN, np.zeros((rows.size, rows.size)))
    return command_surface(job, rig, (learned, learned), FRICTION_mm_s).press_cN


def _finger_surfaces(program: Program) -> dict[str, str]:
    """Return the surfaces that a finger moves the cap along, each with its stroke.

    Not among them: surfaces of both strokes, which move the cap by themselves, and those of states that look
    at the speed of every instant, since what is learned belongs to whole strokes.
    """
    slow = [s for s in program.states if s.velocity is not Velocity.CONTINUOUS]
    press, release = {s.press for s in slow}, {s.release for s in slow}
    fast = {n for s in program.states if s.velocity is Velocity.CONTINUOUS for n in (s.press, s.release)}
    both = (press & release) | fast
    return {**dict.fromkeys(press - both, "press"), **dict.fromkeys(release - both, "release")}


def _add_rows(surface: Surface, known: LearnedRig, led: bool) -> Surface:
    """Return a surface with rows at the speeds that were learned, besides its own."""
    if not led:
        return surface
    speeds = sorted({*surface.velocity_mm_s, *known.residual.velocity_mm_s.tolist()})
    own = np.array(surface.velocity_mm_s)
    rows = np.array([np.interp(speeds, own, column) for column in surface.table_cN.T]).T
    return replace(surface, velocity_mm_s=tuple(speeds), force_cN=tuple(map(tuple, rows.tolist())))


def _residual_cN(
    known: LearnedRig, stroke: str, surface: Surface, x_mm: FloatArray, travel_mm: float
) -> FloatArray:
    """Return what the rig has taught on another button, as far as it is the inertia that they share.

    What is left at slow speeds is that button's own: carried to another one, it raises the error.
    """
    speeds = np.maximum(surface.velocity_mm_s, FRICTION_mm_s)
    press, release = known.rows_cN(x_mm, speeds, travel_mm)
    # 1 where the inertia is well above twice the spread of what buttons leave, 0 below
    clear = (inertia_cN(known.rig, speeds) / (2 * Learning().common_cN)) ** 4
    part = clear / (1 + clear)
    return np.asarray(part[:, np.newaxis] * (press if stroke == "press" else release))


def _returns(surface: Surface) -> bool:
    """Return whether a surface is to bring the cap back to the top: it pushes up there."""
    return bool((surface.table_cN[:, 0] >= 0).all())


def _scale_bias(state: State, gain: float) -> State:
    return replace(state, bias_cN=state.bias_cN / gain, bias_end_cN=state.bias_end_cN / gain)


def _with_tables(program: Program, table_cN: Table) -> Program:
    x_mm = np.arange(round(program.travel_mm / STEP_mm) + 1, dtype=np.float64) * STEP_mm
    return replace(program, surfaces=tuple(_on(s, x_mm, table_cN) for s in program.surfaces))


def _on(surface: Surface, x_mm: FloatArray, table_cN: Table) -> Surface:
    table = np.array([surface.row_cN(row, x_mm) for row in range(len(surface.velocity_mm_s))])
    rows = np.round(table_cN(surface, x_mm, table), DIGITS_cN) + 0.0
    forces = tuple(map(tuple, rows.tolist()))
    return replace(surface, displacement_mm=tuple(x_mm.tolist()), force_cN=forces)
