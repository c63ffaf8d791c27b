"""A button in a running MuJoCo simulation: a passive force from the model itself, at every step."""

from __future__ import annotations

import bisect
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from fdvv.errors import BuildError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv_haptics.mjcf import CAP_g, fine_surface, scene_xml

TABLE_mm = 0.002
TABLE_SPEEDS = 21
POSITION_STAGE = 1
"""mjSTAGE_POS: the sensor needs positions only."""
TURN_mm_s = 2.0
"""Below this speed press and release are mixed: a jump of force at rest would make the cap chatter."""


class MujocoButton:
    """A button that MuJoCo asks for its force: with callbacks in ``attached()``, or with ``apply()``.

    Attributes
    ----------
    xml : a scene of its own: body, slide joint ``button`` and sensors ``button_displacement`` (m),
        ``button_velocity`` (m/s) and ``button_closed``: 1 while the contact is closed, with its hysteresis.
    joint : name of the joint it acts on; its contact's sensor is called that and ``_closed``.
    slot : of the data's userdata, where the contact is remembered; in a scene that has no userdata the button
        remembers it itself, and then serves one simulation.
    closed : whether the contact was closed when last asked.
    """

    def __init__(
        self, model: FDVVModel, cap_mass_g: float = CAP_g, joint: str = "button", slot: int = 0
    ) -> None:
        if not model.of(Stroke.PRESS):
            raise ModelError(f"model {model.name!r} has no press curve, MuJoCo's joint needs one")
        self.xml = scene_xml(model, cap_mass_g, None)
        self.joint, self.slot, self.closed = joint, slot, False
        self._close_mm = model.actuation_mm
        self._open_mm = model.reset_mm if model.reset_mm is not None else model.actuation_mm
        table = fine_surface(model, TABLE_mm, TABLE_SPEEDS)
        # lists of floats: of single numbers Python reads them faster than arrays
        self._speeds: list[float] = table.velocity_mm_s.tolist()
        self._press: list[list[float]] = table.press_cN.tolist()
        self._release: list[list[float]] = table.release_cN.tolist()

    def force_cN(self, displacement_mm: float, velocity_mm_s: float) -> float:
        """Return the force against the finger.

        velocity_mm_s : signed, positive on the press.
        From the model's own curves, tabulated every 2 µm; within 2 mm/s of rest press and release are mixed.
        """
        at = self._place(displacement_mm, abs(velocity_mm_s))
        press, release = _read(self._press, *at), _read(self._release, *at)
        share = 0.5 + 0.5 * max(-1.0, min(1.0, velocity_mm_s / TURN_mm_s))
        return share * press + (1 - share) * release

    def _place(self, x_mm: float, v_mm_s: float) -> tuple[int, float, int, float]:
        last = len(self._press[0]) - 2
        column = max(0, min(last, int(x_mm / TABLE_mm)))
        across = max(0.0, min(1.0, x_mm / TABLE_mm - column))
        row = max(0, min(len(self._speeds) - 2, bisect.bisect_right(self._speeds, v_mm_s) - 1))
        step = self._speeds[row + 1] - self._speeds[row]
        return row, max(0.0, min(1.0, (v_mm_s - self._speeds[row]) / step)), column, across

    def passive(self, model: Any, data: Any) -> None:
        """Subtract the button's force from the joint's passive forces: MuJoCo's ``mjcb_passive``."""
        dof, force_N = self._ask(model, data)
        data.qfrc_passive[dof] -= force_N

    def apply(self, model: Any, data: Any) -> None:
        """Set the joint's applied force for the next step: for loops that want no callback.

        Call it before every ``mj_step``; force and ``closed`` then are those of the step's beginning. MuJoCo
        clears the contact's sensor in the step, as it does without a callback. model, data : MuJoCo's own.
        """
        dof, force_N = self._ask(model, data)
        data.qfrc_applied[dof] = -force_N
        self._switch(model, data)

    def sense(self, model: Any, data: Any, stage: int) -> None:
        """Write whether the contact is closed into its sensor: MuJoCo's ``mjcb_sensor``."""
        if stage == POSITION_STAGE:
            self._switch(model, data)

    def _ask(self, model: Any, data: Any) -> tuple[int, float]:
        joint = model.joint(self.joint)
        dof = int(joint.dofadr[0])
        x_mm = 1000.0 * float(data.qpos[joint.qposadr[0]])
        return dof, 0.01 * self.force_cN(x_mm, 1000.0 * float(data.qvel[dof]))

    def _switch(self, model: Any, data: Any) -> None:
        if self._close_mm is None or self._open_mm is None:
            return
        remembered = data.userdata.size > self.slot
        before = bool(data.userdata[self.slot]) if remembered else self.closed
        x_mm = 1000.0 * float(data.qpos[model.joint(self.joint).qposadr[0]])
        self.closed = x_mm >= self._close_mm or (before and x_mm > self._open_mm)
        if remembered:
            data.userdata[self.slot] = self.closed
        with suppress(KeyError):
            data.sensordata[model.sensor(f"{self.joint}_closed").adr[0]] = self.closed

    @contextmanager
    def attached(self) -> Iterator[None]:
        """Install the callbacks while a block runs, beside those that are there, which are put back.

        Callbacks of MuJoCo are of the whole process: all models that step meanwhile must have the joint, and
        none can be compiled; make the model first. Several buttons of one scene are attached one within the
        other. Raises BuildError without MuJoCo.
        """
        mujoco = require_mujoco()
        passive, sense = mujoco.get_mjcb_passive(), mujoco.get_mjcb_sensor()
        mujoco.set_mjcb_passive(_both(passive, self.passive))
        mujoco.set_mjcb_sensor(_both(sense, self.sense))
        try:
            yield
        finally:
            mujoco.set_mjcb_passive(passive)
            mujoco.set_mjcb_sensor(sense)


def _both(first: Callable[..., None] | None, then: Callable[..., None]) -> Callable[..., None]:
    def call(*arguments: Any) -> None:
        if first:
            first(*arguments)
        then(*arguments)

    return call


def mujoco_button(model: FDVVModel, cap_mass_g: float = CAP_g) -> MujocoButton:
    """Make a button for MuJoCo whose force is the model's, on press and release and at every velocity.

    Raises ModelError if the model has no press curve.
    """
    return MujocoButton(model, cap_mass_g)


def require_mujoco() -> Any:
    """Import MuJoCo; BuildError with the install command where it is absent."""
    try:
        import mujoco
    except ImportError as error:
        raise BuildError("this needs MuJoCo; install it with: pip install mujoco") from error
    return mujoco


def _read(table: list[list[float]], row: int, down: float, column: int, across: float) -> float:
    low, high = table[row], table[row + 1]
    slow = low[column] + across * (low[column + 1] - low[column])
    fast = high[column] + across * (high[column + 1] - high[column])
    return slow + down * (fast - slow)
