"""The ``*.rig.json`` file: an identified rig as versioned plain JSON, and the residual learned on it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from pathlib import Path

import msgspec
import numpy as np

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import InputError, ModelError
from fdvv.io.documents import Kind, Layout, decode, document, pretty, read_document, to_plain
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.surface import ForceSurface
from fdvv.units import Column, FloatArray, Table


@dataclass(frozen=True, eq=False)
class LearnedRig:
    """A rig and the residual learned from presses on it, independent of the button.

    Attributes
    ----------
    rig : the model of the rig.
    residual : command (cN) added to that of the model, by displacement and speed, press and release.
    travel_mm : of the button it was learned on; for another one displacement is scaled by the travels.
    error_cN : (2, s) mean error left at the residual's speeds, press and release, as the rig measured it.
    """

    rig: RigModel = field(metadata={"key": "known"})
    residual: ForceSurface
    travel_mm: float
    error_cN: FloatArray

    def __post_init__(self) -> None:
        errors = np.ascontiguousarray(self.error_cN, dtype=np.float64)
        object.__setattr__(self, "error_cN", errors)
        shape = (2, self.residual.velocity_mm_s.size)
        if errors.shape != shape or not (np.isfinite(errors).all() and self.travel_mm > 0):
            raise ModelError(f"a learned rig needs {shape} finite errors and a travel above 0 mm")

    def rows_cN(
        self, grid_mm: FloatArray, speeds_mm_s: FloatArray, travel_mm: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return the residual on another grid, for other speeds and travel: (s, n) press and release."""
        displacement_mm = grid_mm * self.travel_mm / travel_mm
        own = self.residual.displacement_mm
        press, release = (
            self._between(np.stack([np.interp(displacement_mm, own, row) for row in table]), speeds_mm_s)
            for table in (self.residual.press_cN, self.residual.release_cN)
        )
        return press, release

    def error_at_cN(self, speeds_mm_s: FloatArray) -> FloatArray:
        """Return the mean error to expect at other speeds, (2, s)."""
        own = self.residual.velocity_mm_s
        return np.stack([np.interp(speeds_mm_s, own, row) for row in self.error_cN])

    def _between(self, rows: FloatArray, speeds_mm_s: FloatArray) -> FloatArray:
        """Interpolate rows, (s, n), linearly in the square of speed; the last one is held.

        Below the slowest they approach one level at rest, where no inertia varies over displacement: the
        median of the first two rows extrapolated to speed 0.
        """
        squares, wanted = self.residual.velocity_mm_s**2, speeds_mm_s**2
        if squares.size > 1 and wanted.min() < squares[0]:
            still = np.median(rows[0] - (rows[1] - rows[0]) * squares[0] / (squares[1] - squares[0]))
            rows = np.vstack([np.full(rows.shape[1], still), rows])
            squares = np.concatenate([[0.0], squares])
        return np.stack([np.interp(wanted, squares, column) for column in rows.T], axis=1)


LIMIT_bytes = 4_000_000  # 5 kB with a learned speed, 3.2 kB for each more: room for a thousand
_REMEDY = "identify the rig again"
RIG = Kind("fdvv-rig", 1, "an identified rig", _REMEDY)


class LearnedRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The residual learned on a rig; names as in LearnedRig and its residual."""

    travel_mm: float
    displacement_mm: Column
    velocity_mm_s: Column
    press_cN: Table
    release_cN: Table
    error_cN: tuple[list[float], list[float]]


class _Learned(msgspec.Struct):
    """The part of a rig's file that is beside its model."""

    learned: LearnedRecord | None = None


LATER = ("stick_cN", "side_ratio", "own_cN", "own_step_mm", "at_bound", "misfit")
"""Fields that the first files lack."""
RIG_FIELDS = frozenset(f.name for f in fields(RigModel) if f.name not in LATER)
"""Fields that every file states."""
LAYOUT = Layout(needed=RIG_FIELDS, beside=("$.format", "$.version", "$.learned"))


def save_rig(rig: RigModel | LearnedRig, path: Path | str) -> None:
    """Write a rig, or a learned rig, to a ``*.rig.json`` file, atomically. Raises OSError."""
    numbers = document(rig.rig if isinstance(rig, LearnedRig) else rig, RIG)
    if isinstance(rig, LearnedRig):
        tables = to_plain(rig.residual)
        numbers["learned"] = {"travel_mm": rig.travel_mm, **tables, "error_cN": rig.error_cN.tolist()}
    write_atomic(Path(path), pretty(numbers) + "\n")


def load_rig(path: Path | str) -> RigModel:
    """Read a rig from a ``*.rig.json`` file. Raises InputError, also if it cannot be read."""
    return _read(path)[0]


def load_learned_rig(path: Path | str) -> LearnedRig:
    """Read a learned rig from a file. Raises InputError, also if the file holds the model alone."""
    _, learned = _read(path)
    if learned is None:
        reason = "holds the rig's model, but nothing learned on it"
        raise InputError(path, "$.learned", reason, "save it with fdvv compensate --save-rig")
    return learned


def _read(path: Path | str) -> tuple[RigModel, LearnedRig | None]:
    text = read_limited(path, LIMIT_bytes, "pass a *.rig.json file")
    rig, learned = read_document(text, path, RIG, _decode)
    try:
        return rig, _build_learned_rig(rig, learned) if learned else None
    except ValueError as error:  # rows of different lengths, or values that no surface has
        raise InputError(path, "$.learned", str(error), _REMEDY) from error


def _decode(data: bytes) -> tuple[RigModel, LearnedRecord | None]:
    return decode(data, RigModel, LAYOUT), msgspec.json.decode(data, type=_Learned).learned


def _build_learned_rig(rig: RigModel, learned: LearnedRecord) -> LearnedRig:
    grid = learned.displacement_mm, learned.velocity_mm_s
    surface = ForceSurface(*grid, learned.press_cN, learned.release_cN)
    return LearnedRig(rig, surface, learned.travel_mm, np.array(learned.error_cN))
