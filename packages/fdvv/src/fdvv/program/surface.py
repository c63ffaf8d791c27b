"""Surfaces of force on displacement and velocity, the even grids an image holds, and a rig's limits."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.program.condition import Name
from fdvv.protocol.messages import CN64_PER_cN, MM_S16_PER_mm_s, UM16_PER_mm
from fdvv.protocol.tables import SURFACE_DISPLACEMENTS, Settings
from fdvv.protocol.tables import Surface as ImageSurface
from fdvv.units import FloatArray

DIGITS_cN = 4  # an image counts in 1/64 cN: more digits make a file longer and change nothing
STEP_mm = 0.02  # below the 0.05 mm over which a bump is measured; an image takes the columns it needs
COARSEST_um16 = 16_000  # 1 mm, the widest step of an image (step_um16 in protocol/fdvv.toml)
FINEST_um16 = 16  # 1 um, its narrowest
START_um16 = ImageSurface.LIMITS["start_um16"]


@dataclass(frozen=True)
class Surface:
    """A named table of force, bilinear between its points, its edges held outside.

    Attributes
    ----------
    name : how states refer to it.
    displacement_mm : rising, at least 2, in any steps.
    force_cN : a row of as many forces per velocity; positive against the finger, negative pulls the cap down.
    velocity_mm_s : rising from 0 or more, one per row.
    """

    name: Name
    displacement_mm: Annotated[tuple[float, ...], Meta(min_length=2)]
    force_cN: Annotated[tuple[tuple[float, ...], ...], Meta(min_length=1)]
    velocity_mm_s: Annotated[tuple[float, ...], Meta(min_length=1)] = (0.0,)

    def __post_init__(self) -> None:
        check_name(self.name)
        object.__setattr__(self, "displacement_mm", tuple(map(float, self.displacement_mm)))
        object.__setattr__(self, "velocity_mm_s", tuple(map(float, self.velocity_mm_s)))
        rows = tuple(tuple(map(float, row)) for row in self.force_cN)
        object.__setattr__(self, "force_cN", rows)
        self._check_rising(self.displacement_mm, "displacement_mm", 2)
        self._check_rising(self.velocity_mm_s, "velocity_mm_s", 1)
        if self.velocity_mm_s[0] < 0:
            raise ModelError(f"surface {self.name!r}: velocity_mm_s starts below 0: {self.velocity_mm_s[0]}")
        if len(rows) != len(self.velocity_mm_s):
            got = f"got {len(rows)} for {len(self.velocity_mm_s)}"
            raise ModelError(f"surface {self.name!r}: one row of force_cN per velocity, {got}")
        count = len(self.displacement_mm)
        for row in rows:
            if len(row) != count:
                got = f"got {len(row)} for {count}"
                raise ModelError(f"surface {self.name!r}: one force per displacement, {got}")
        if not np.isfinite(rows).all():
            raise ModelError(f"surface {self.name!r}: force_cN must be finite")

    def _check_rising(self, numbers: tuple[float, ...], field: str, least: int) -> None:
        if len(numbers) < least or not np.isfinite(numbers).all() or np.any(np.diff(numbers) <= 0):
            raise ModelError(f"surface {self.name!r}: {field} must be {least} or more rising numbers")

    @property
    def table_cN(self) -> FloatArray:
        """Return the forces as an array, (velocities, displacements)."""
        return np.array(self.force_cN)

    def row_cN(self, row: int, displacement_mm: FloatArray) -> FloatArray:
        """Evaluate one row at displacements, in their shape."""
        forces: FloatArray = np.interp(displacement_mm, self.displacement_mm, self.force_cN[row])
        return forces

    def force_along_cN(self, displacement_mm: FloatArray, velocity_mm_s: float = 0.0) -> FloatArray:
        """Evaluate the surface along displacements at one velocity, in their shape."""
        velocities = self.velocity_mm_s
        fast = bisect_right(velocities, velocity_mm_s)
        if fast in (0, len(velocities)):
            return self.row_cN(max(0, fast - 1), displacement_mm)
        slow_cN, fast_cN = (self.row_cN(row, displacement_mm) for row in (fast - 1, fast))
        span_mm_s = velocities[fast] - velocities[fast - 1]
        return slow_cN + (fast_cN - slow_cN) / span_mm_s * (velocity_mm_s - velocities[fast - 1])

    def force_at_cN(self, displacement_mm: float, velocity_mm_s: float = 0.0) -> float:
        """Evaluate the surface at one place."""
        return float(self.force_along_cN(np.array([displacement_mm]), velocity_mm_s)[0])


def check_name(name: str) -> None:
    """Raise ModelError unless name is text of 1 to 40 printable characters without spaces at its ends."""
    if not name or name != name.strip() or len(name) > 40 or not name.isprintable():
        raise ModelError(f"a name is 1 to 40 printable characters without spaces at its ends, got {name!r}")


def line(name: str, *points: tuple[float, float]) -> Surface:
    """Make a surface of (displacement_mm, force_cN) points, the same at every velocity."""
    places, forces = zip(*points, strict=True)
    return Surface(name, places, (forces,))


def flat(name: str, force_cN: float) -> Surface:
    """Make a surface of one force everywhere."""
    return line(name, (0.0, force_cN), (1.0, force_cN))


def of_model(
    model: FDVVModel,
    stroke: Stroke | str,
    name: str | None = None,
    velocity_mm_s: Sequence[float] | None = None,
    step_mm: float = STEP_mm,
) -> Surface:
    """Sample one stroke of a model from 0 to its travel in even steps; without a release the press serves.

    velocity_mm_s are the rows; by default those of the model's curves. Forces are rounded to 1e-4 cN.
    Raises ModelError if the model has no press curve.
    """
    serving = Stroke(stroke) if model.of(stroke) else Stroke.PRESS
    rows = tuple(velocity_mm_s or model.velocities_mm_s(serving) or (0.0,))
    # a travel of whole steps must not get one more because of its last bit
    count = max(2, math.ceil(model.travel_mm / step_mm - 1e-9) + 1)
    x_mm = np.round(np.arange(count) * step_mm, 6)
    table = model.force_cN(x_mm[np.newaxis, :], np.array(rows)[:, np.newaxis], serving)
    return _of_table(name or str(Stroke(stroke)), x_mm, np.array(rows), table)


def of_surface(surface: ForceSurface, stroke: Stroke | str, name: str | None = None) -> Surface:
    """Take one stroke of a table, for instance of one that a compensation learned."""
    named = name or str(Stroke(stroke))
    return _of_table(named, surface.displacement_mm, surface.velocity_mm_s, surface.table_cN(stroke))


def _of_table(name: str, x_mm: FloatArray, v_mm_s: FloatArray, table_cN: FloatArray) -> Surface:
    # adding 0 turns -0.0 into 0.0, so that equal tables are equal files
    rounded = np.round(table_cN, DIGITS_cN) + 0.0
    return Surface(name, tuple(x_mm.tolist()), tuple(map(tuple, rounded.tolist())), tuple(v_mm_s.tolist()))


def scaled(surface: Surface, name: str, ratio_of_mm_s: Mapping[float, float]) -> Surface:
    """Make the slowest row of a surface depend on velocity: at each given one, so many times itself."""
    row = np.array(surface.force_cN[0])
    speeds = np.array(sorted(ratio_of_mm_s))
    rows = np.array([ratio * row for _, ratio in sorted(ratio_of_mm_s.items())])
    return _of_table(name, np.array(surface.displacement_mm), speeds, rows)


def raised(surface: Surface, name: str, points: Sequence[tuple[float, float]]) -> Surface:
    """Add lines between (displacement_mm, force_cN) points to every row, at the surface's own points."""
    places, forces = (np.array(column, dtype=float) for column in zip(*sorted(points), strict=True))
    x_mm = np.array(surface.displacement_mm)
    table = surface.table_cN + np.interp(x_mm, places, forces, left=0.0, right=0.0)
    return _of_table(name, x_mm, np.array(surface.velocity_mm_s), table)


CONTACT_mm = 0.09
RETURNING_cN = 10.0
"""Force that brings a cap back: twice the friction that a program is checked with."""


def returning(surface: Surface) -> Surface:
    """Raise every force below RETURNING_cN to it, but for the contact in the first 0.1 mm.

    A real button is returned by its spring; its curve at speed may fall to nothing near the top, where the
    finger leaves the cap behind, and a rig that followed it would leave its cap there.
    """
    beyond = np.array(surface.displacement_mm) > CONTACT_mm
    table = np.where(beyond, np.maximum(surface.table_cN, RETURNING_cN), surface.table_cN)
    return _of_table(surface.name, np.array(surface.displacement_mm), np.array(surface.velocity_mm_s), table)


@dataclass(frozen=True, eq=False)
class Grid:
    """A surface as an image holds it.

    Attributes
    ----------
    start_um16, step_um16 : first column and distance between two, 1/16 µm.
    velocities_mm_s16 : (rows,) 1/16 mm/s.
    forces_cN64 : (rows, columns) 1/64 cN.
    error_cN : largest distance between the surface and the lines between its columns, before rounding.
    rounding_cN : largest distance that rounding moved a column.
    """

    start_um16: int
    step_um16: int
    velocities_mm_s16: tuple[int, ...]
    forces_cN64: tuple[tuple[int, ...], ...]
    error_cN: float
    rounding_cN: float

    @property
    def columns(self) -> int:
        return len(self.forces_cN64[0])


def place_um16(place_mm: float) -> int:
    return round(place_mm * UM16_PER_mm)


def speed_mm_s16(speed_mm_s: float) -> int:
    return round(speed_mm_s * MM_S16_PER_mm_s)


def counts_cN64(force_cN: float) -> int:
    return round(force_cN * CN64_PER_cN)


class Candidates:
    """The even grids a surface may be given, and what each costs; measured once, when it is asked for."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        self._points_mm = np.array(surface.displacement_mm)
        self._source_cN = surface.table_cN
        self.start_um16 = place_um16(surface.displacement_mm[0])
        # inner points only: up to the last one, grid and surface hold the same end
        self.span_um16 = max(place_um16(surface.displacement_mm[-1]) - self.start_um16, FINEST_um16)
        fewest = max(2, -(-self.span_um16 // COARSEST_um16) + 1)
        most = min(SURFACE_DISPLACEMENTS, self.span_um16 // FINEST_um16 + 1)
        self.columns = range(fewest, max(fewest, most) + 1)
        self._known_cN: dict[int, float] = {}

    def _step_um16(self, columns: int) -> int:
        return -(-self.span_um16 // (columns - 1))

    def _places_mm(self, columns: int) -> FloatArray:
        step_mm = self._step_um16(columns) / UM16_PER_mm
        return np.asarray(self.start_um16 / UM16_PER_mm + step_mm * np.arange(columns))

    def _table_cN(self, columns: int) -> FloatArray:
        places = self._places_mm(columns)
        after = np.clip(np.searchsorted(self._points_mm, places), 1, self._points_mm.size - 1)
        before_mm, after_mm = self._points_mm[after - 1], self._points_mm[after]
        part = np.clip((places - before_mm) / (after_mm - before_mm), 0.0, 1.0)
        table: FloatArray = (1 - part) * self._source_cN[:, after - 1] + part * self._source_cN[:, after]
        return table

    def _error_cN(self, columns: int) -> float:
        """Compare at the surface's own points: between straight lines nothing can be worse."""
        if columns not in self._known_cN:
            places, points = self._places_mm(columns), self._points_mm
            held = [np.interp(points, places, np.interp(places, points, row)) for row in self._source_cN]
            self._known_cN[columns] = float(np.max(np.abs(np.array(held) - self._source_cN)))
        return self._known_cN[columns]

    def coarsest(self, bound_cN: float) -> int:
        """Return the fewest columns within the bound; where none is, the best there are."""
        fewest = next((n for n in self.columns if self._error_cN(n) <= bound_cN), None)
        return min(self.columns, key=self._error_cN) if fewest is None else fewest

    def grid(self, columns: int) -> Grid:
        """Sample the surface on that many columns."""
        exact = self._table_cN(columns) * CN64_PER_cN
        rounded = np.rint(exact)
        return Grid(
            self.start_um16,
            self._step_um16(columns),
            tuple(speed_mm_s16(v) for v in self.surface.velocity_mm_s),
            tuple(tuple(int(f) for f in row) for row in rounded),
            self._error_cN(columns),
            float(np.max(np.abs(rounded - exact))) / CN64_PER_cN,
        )


@dataclass(frozen=True)
class Limits:
    """The bounds that programs are compiled and checked against; the defaults are the paper's rig.

    Attributes
    ----------
    settings : of the controller: force limit, slew, tick, heat, latency of the vibration board.
    largest_travel_mm : deepest place of the bottom stop; the paper's 6.2.
    counts_per_m_s2 : converter counts of the vibration board per m/s² of the cap.
    grid_error_cN : what a coarser grid of a surface may cost while there is room.
    worst_grid_error_cN : what it may cost at most where room is short; beyond, the program is refused.
    mass_kg : what moves: coil, shaft, cap.
    damping_N_s_m : drag that is sure to be there: back-EMF of the coil at voltage drive, k_t²/R, and bushing.
    most_damping_N_s_m : the most it may be; only times depend on it.
    weight_cN : of what moves, along the stroke: 20 g in a rig that stands upright. Every state of an image
        carries it, so that forces are felt as they are written. 0 for a rig that lies and for learned forces.
    opposing_cN : largest force that may keep the cap down with the finger off: friction.
    rebound_ratio : speed after over speed before hitting a stop, at most.
    top_mm : above it the cap counts as returned: the rig's re-arming height.
    delay_us : from the middle of the readings to the new force.
    """

    settings: Settings = field(default_factory=Settings)
    largest_travel_mm: float = 6.2
    counts_per_m_s2: float = 100.0
    grid_error_cN: float = 0.1
    worst_grid_error_cN: float = 1.0
    mass_kg: float = 0.02
    damping_N_s_m: float = 4.0
    most_damping_N_s_m: float = 8.0
    weight_cN: float = 19.6
    opposing_cN: float = 5.0
    rebound_ratio: float = 0.3
    top_mm: float = 0.1
    delay_us: float = 800.0

    def __post_init__(self) -> None:
        positive = (
            "largest_travel_mm", "counts_per_m_s2", "grid_error_cN", "worst_grid_error_cN", "mass_kg",
            "damping_N_s_m", "most_damping_N_s_m", "top_mm", "delay_us",
        )  # fmt: skip
        for name in positive:
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise ModelError(f"{name} must be positive, got {getattr(self, name)}")
        if not np.isfinite(self.weight_cN):
            raise ModelError(f"weight_cN must be finite, got {self.weight_cN}")
        if not (np.isfinite(self.opposing_cN) and self.opposing_cN >= 0):
            raise ModelError(f"opposing_cN must be 0 or more, got {self.opposing_cN}")
        if not 0 <= self.rebound_ratio < 1:
            raise ModelError(f"rebound_ratio must be 0 to below 1, got {self.rebound_ratio}")

    @property
    def force_cN(self) -> float:
        """The largest force, both signs."""
        return self.settings.force_limit_cN64 / CN64_PER_cN

    @property
    def slew_cN_s(self) -> float:
        """Return the fastest change of the force."""
        return self.settings.slew_cN64_tick / CN64_PER_cN * 1e6 / self.settings.tick_us

    @property
    def stiffness_cN_mm(self) -> float:
        """Return the stiffness beyond which a held cap may buzz: damping over half a tick and the delay.

        The rule of the sampled wall, K < b / (T / 2 + t_d) (Colgate and Schenkel 1997, with delay).
        1 N/m is 0.1 cN/mm.
        """
        return 0.1 * self.damping_N_s_m / (1e-6 * (self.settings.tick_us / 2 + self.delay_us))

    def rise_K(self, force_cN: float) -> float:
        """Return how much warmer the coil ends if a force is held for ever, by the controller's own model."""
        counts = abs(force_cN) * CN64_PER_cN
        duty = min(1.0, counts * self.settings.duty_gain_q16 / 2**16 / 2**15)
        return self.settings.full_duty_rise_K * duty**2
