"""What is known of another program's format, and how an extra writes and reads it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from fdvv.formats.exchange.exported import Exported
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Mode, Vibration

Follow = Literal["press", "both"]
"""What MuJoCo's springs draw: the presses, which people feel first, or the middle of both strokes."""


@dataclass(frozen=True)
class ExportSettings:
    """Settings of an export; each format uses those that concern it.

    Attributes
    ----------
    stroke, velocity_mm_s : of the vibration, or of the press where a format holds one: the slowest by
        default, with MuJoCo the mean of all.
    step_mm : between the samples of a curve.
    follow : what MuJoCo's springs draw.
    cap_mass_g : of the body in MuJoCo.
    degrees_per_mm : how far a knob turns for a millimetre.
    """

    stroke: Stroke = Stroke.PRESS
    velocity_mm_s: float | None = None
    step_mm: float = 0.01
    follow: Follow = "press"
    cap_mass_g: float = 1.0
    degrees_per_mm: float = 10.0


@dataclass(frozen=True)
class ExportFormat:
    """A format: its name, the file's ending, what is written, and what it is of.

    mark : what the first bytes of such a JSON file contain, by which an import detects it; empty if it cannot
        be imported.
    """

    name: str
    suffix: str
    about: str
    of: Literal["button", "vibration", "recording"]
    mark: bytes = b""


@dataclass(frozen=True)
class VibrationRead:
    """What a file holds of a vibration.

    Attributes
    ----------
    modes, duration_s : as a Vibration has them.
    assumptions : what the file does not tell and what was taken instead, one sentence each.
    notes : what else a person should know of the reading.
    """

    modes: tuple[Mode, ...]
    duration_s: float
    assumptions: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ButtonFormat(ExportFormat):
    """A format of an extra that a button is written in.

    needs_press : whether a model without a press curve is refused.
    """

    write: Callable[[FDVVModel, ExportSettings], Exported]
    needs_press: bool = False


@dataclass(frozen=True, kw_only=True)
class VibrationFormat(ExportFormat):
    """A format of an extra that a vibration is written in and read from.

    Attributes
    ----------
    write : called with the vibration, a name and the date of the file, ISO 8601.
    read : called with a path or a file's bytes, and what 1 stands for in m/s2, None for what the file says.
    """

    write: Callable[[Vibration, str, str], Exported]
    read: Callable[[Path | bytes, float | None], VibrationRead]
