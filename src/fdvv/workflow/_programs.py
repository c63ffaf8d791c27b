"""Programs for a device, from whatever a person names."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import ForceSurface
from fdvv.program import button_program, compile_program, require_accepted
from fdvv.protocol import IMAGE_BYTES, IMAGE_MAGIC
from fdvv.vibration import KnownExciter
from fdvv.workflow._open import open_model
from fdvv.workflow._open_program import names_program, open_program
from fdvv.workflow._vibration_slots import converter

MAGIC = IMAGE_MAGIC.to_bytes(4, "little")
STEP_mm = 0.05


def program_image(
    button: str, velocities_mm_s: Sequence[float], exciter: KnownExciter | None = None
) -> bytes:
    """Give the image of a program: that of a file, or one that follows a button's own force.

    button : a program image (its first bytes are FDVP), a program as `open_program` opens it, which must be
    accepted, else what `open_model` opens; its force is sampled at these speeds, with the weight of what
    moves but not compensated for any rig, its vibrations and key points go along.
    exciter : if it is known, the slots of vibrations are those of its inverse; a finished image stays as it
    is. Raises InputError.
    """
    path = Path(button)
    if path.is_file() and path.stat().st_size <= IMAGE_BYTES and path.read_bytes()[:4] == MAGIC:
        return path.read_bytes()
    convert = converter(exciter) if exciter else None
    if names_program(button):
        program = open_program(button)
        require_accepted(program)
        return compile_program(program, convert=convert).image
    model = open_model(button)
    if not model.of("press"):
        raise InputError(button, "curves", "it has no press, there is nothing to render", "merge one into it")
    surface = ForceSurface.of_model(model, sorted(velocities_mm_s), STEP_mm)
    return compile_program(button_program(model, surface), convert=convert).image
