"""Controller tuning as device settings, and program images."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import exp, pi
from pathlib import Path
from typing import TYPE_CHECKING

from fdvv.button.open import open_button
from fdvv.compensation.method import Tuning
from fdvv.device import open as device_open
from fdvv.device.contract import Device, ForceLoopDevice
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.model.surface import ForceSurface
from fdvv.protocol.messages import CN64_PER_cN, MM_S16_PER_mm_s
from fdvv.protocol.tables import IMAGE_BYTES, IMAGE_MAGIC, ForceLoopGains, Settings
from fdvv.twin.files import load_finger, load_rig
from fdvv.units import cN_from_N

if TYPE_CHECKING:
    from fdvv.vibration.exciter import KnownExciter

TUNED = ("predictor_q16", "lead_us", "brake_lead_us", "drag_q13", "friction_cN64", "friction_mm_s16")
"""Settings that a tuning determines; the others belong to the rig."""


def settings_with(settings: Settings, tuning: Tuning) -> Settings:
    """Return settings with a tuning, at their tick; ``paced`` is sent with each upload instead.

    A tuning without bandwidth only turns the filter off, which disables the rest. Raises InputError
    if the firmware cannot hold the tuning.
    """
    if not tuning.bandwidth_Hz:
        return replace(settings, predictor_q16=0)
    # 1 cN64 per mm_s16 in N s/m: a force in cN64 over a speed in mm_s16
    drag_q13 = float(cN_from_N(tuning.drag_N_s_m)) * CN64_PER_cN / (1000 * MM_S16_PER_mm_s) * 2**13
    kept = exp(-2e-6 * pi * tuning.bandwidth_Hz * settings.tick_us)
    wanted = {
        "predictor_q16": max(1, round((1 - kept) * 2**16)),
        "lead_us": round(1e6 * tuning.lead_s),
        "brake_lead_us": round(1e6 * tuning.brake_lead_s),
        "drag_q13": round(drag_q13),
        "friction_cN64": round(CN64_PER_cN * tuning.friction_cN),
        "friction_mm_s16": round(MM_S16_PER_mm_s * tuning.friction_mm_s),
    }
    try:
        return replace(settings, **wanted)
    except ModelError as error:
        reason = f"is beyond a device's settings: {error}"
        raise InputError("tuning", str(tuning), reason, "ask for less of it") from error


def tune(device: Device, tuning: Tuning) -> bool:
    """Apply a tuning to a device; return whether it was configured, and so lost its table.

    A device whose settings would not change is left alone. What was configured persists after a session.
    """
    wanted = settings_with(device.settings(), tuning)
    changed = wanted != device.settings()
    if changed:
        device.configure(wanted)
    # to configure a device opens its loop
    return _close_loop(device, tuning.loop) or changed


def _close_loop(device: Device, gains: ForceLoopGains | None) -> bool:
    if not isinstance(device, ForceLoopDevice):
        if gains is None:
            return False
        raise DeviceError(
            f"{device.info().name}: has no force loop; learn with --method rig-aware, "
            "or name a --rig with [load_cell]"
        )
    if gains == device.loop:
        return False
    device.close_loop(gains)
    return True


def open_device(name: str, rig: Path | None = None, finger: Path | None = None, seed: int = 0) -> Device:
    """Open a device by name (fdvv.device.open.KINDS); rig and finger are TOML files of simulated ones.

    seed makes random numbers repeatable. Raises InputError or DeviceError.
    """
    made = load_rig(rig) if rig else None, load_finger(finger) if finger else None
    return device_open.open_device(name, *made, seed)


MAGIC = IMAGE_MAGIC.to_bytes(4, "little")
STEP_mm = 0.05  # as ForceSurface.of_model: the paper's bin; 4 mm take 81 of a board's 255 columns


def program_image(
    button: str, velocities_mm_s: Sequence[float], exciter: KnownExciter | None = None
) -> bytes:
    """Return the image of a program: that of a file, or one that renders a button's own force.

    button : a program image (its first bytes are FDVP), a program as `open_program` opens it, which must be
    accepted, else what `open_button` opens; its force is sampled at these speeds, with the weight of what
    moves but not compensated for any rig, its vibrations and key points go along.
    exciter : if it is known, the slots of vibrations are those of its inverse; a finished image stays as it
    is. Raises InputError.
    """
    # a table of forces, all that most work uploads, needs no program
    from fdvv.program.button import button_program
    from fdvv.program.check import require_accepted
    from fdvv.program.compile import compile_program
    from fdvv.program.library import names_program, open_program
    from fdvv.program.render_vibration import converter

    path = Path(button)
    if path.is_file() and path.stat().st_size <= IMAGE_BYTES and path.read_bytes()[:4] == MAGIC:
        return path.read_bytes()
    convert = converter(exciter) if exciter else None
    if names_program(button):
        program = open_program(button)
        require_accepted(program)
        return compile_program(program, convert=convert).image
    model = open_button(button)
    if not model.of("press"):
        raise InputError(button, "curves", "it has no press, there is nothing to render", "merge one into it")
    surface = ForceSurface.of_model(model, sorted(velocities_mm_s), STEP_mm)
    return compile_program(button_program(model, surface), convert=convert).image
