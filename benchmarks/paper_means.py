"""The paper's twelve means out of presses on the twin, with three global numbers at most. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.model import FDVVModel, load_builtin
from fdvv.optimize import (
    PAPER_BUTTONS,
    PAPER_MEANS_ms,
    SimulatedUser,
    TemporalPointing,
    UserSettings,
    draw_users,
    paper_model,
    paper_space,
)
from fdvv.units import FloatArray
from fdvv.workflow._press_table import PressTable, adapted_ms, expected_ms, press_table

PACES_mm_s = (60.0, 75.0, 90.0, 110.0, 140.0, 180.0)
"""Where presses are made; between, means are interpolated over the logarithm of pace."""
ADAPTING_RUNS = 40


@dataclass(frozen=True)
class PaperStudy:
    """How the paper's study is simulated.

    Attributes
    ----------
    people : as many. presses : on each button, an even number.
    designs : of the paper's space that each person tries. seed : of people, presses, designs.
    middle : the person in the middle. rig : that is pressed.
    """

    people: int = 10
    presses: int = 6
    designs: int = 40
    seed: int = 0
    middle: SimulatedUser = field(default_factory=SimulatedUser)
    rig: str = "ideal"

    def users(self, pace_mm_s: float) -> tuple[SimulatedUser, ...]:
        """Draw the people, the middle one pressing at this pace; biases are about 0."""
        middle = replace(self.middle, pace_mm_s=pace_mm_s, bias_ms=0.0)
        return draw_users(self.people, self.seed, UserSettings(middle))

    def drawn(self, user: SimulatedUser) -> list[FDVVModel]:
        """Draw designs of the paper's space for a person, evenly at random."""
        space = paper_space()
        places = np.random.default_rng([self.seed, user.number]).random((self.designs, len(space.names)))
        return [paper_model(design) for design in space.of_unit(places)]

    def pressed(self, model: FDVVModel, user: SimulatedUser) -> PressTable:
        """Let a person press a button."""
        return press_table(model, user, self.presses, self.seed, self.rig)


@dataclass(frozen=True, eq=False)
class PaperPresses:
    """Presses on the paper's buttons, simulated.

    Attributes
    ----------
    switches : by name, a table for each person. tried : for each person, a table for each random design.
    """

    switches: Mapping[str, Sequence[PressTable]]
    tried: Sequence[Sequence[PressTable]]

    @classmethod
    def of(cls, study: PaperStudy, pace_mm_s: float) -> PaperPresses:
        """Let everybody press the four switches and random designs of their own."""
        users = study.users(pace_mm_s)
        models = {name: load_builtin(f"mx-{name}") for name in PAPER_BUTTONS[1:5]}
        switches = {name: [study.pressed(model, user) for user in users] for name, model in models.items()}
        return cls(switches, [[study.pressed(model, user) for model in study.drawn(user)] for user in users])

    def means_ms(self, score: Callable[[PressTable], float]) -> FloatArray:
        """Give the mean score of PAPER_BUTTONS, (6,).

        The optimal button is each person's best of those tried, about as many as the paper's people tried:
        chosen by the first half of its presses and scored by the second, so that luck does not count.
        """
        halves = [[table.halves() for table in tables] for tables in self.tried]
        first = np.array([[score(one) for one, _ in row] for row in halves])
        second = np.array([[score(other) for _, other in row] for row in halves])
        best = second[np.arange(len(halves)), np.argmin(first, axis=1)]
        switches = [np.mean([score(table) for table in found]) for found in self.switches.values()]
        return np.array([best.mean(), *switches, second.mean()])


class PaperModel:
    """The twelve means by three global numbers: bias (ms), pace (mm/s), width of the zone (px)."""

    def __init__(self, study: PaperStudy | None = None, gain: float = 0.0) -> None:
        self.study, self.gain = study or PaperStudy(), gain
        self._presses = [PaperPresses.of(self.study, pace) for pace in PACES_mm_s]

    def means_ms(self, level: str, bias_ms: float, pace_mm_s: float, zone_px: float) -> FloatArray:
        """Give the mean asynchrony of PAPER_BUTTONS, (6,)."""
        task = TemporalPointing(level, zone_px=zone_px)
        at = float(np.interp(np.log(pace_mm_s), np.log(PACES_mm_s), np.arange(len(PACES_mm_s))))
        low = min(int(at), len(PACES_mm_s) - 2)

        def score(table: PressTable) -> float:
            return self._score(table, task, bias_ms)

        slow, fast = (self._presses[i].means_ms(score) for i in (low, low + 1))
        return np.asarray((1 - (at - low)) * slow + (at - low) * fast)

    def _score(self, table: PressTable, task: TemporalPointing, bias_ms: float) -> float:
        if self.gain == 0:
            return expected_ms(table, task, bias_ms)
        return adapted_ms(table, task, bias_ms, self.gain, ADAPTING_RUNS, self.study.seed)


@dataclass(frozen=True)
class PaperFit:
    """Global numbers and what they give.

    Attributes
    ----------
    levels : that were fitted. bias_ms, pace_mm_s, zone_px : the numbers.
    fitted : which of them. means_ms : of PAPER_BUTTONS by level, fitted or not.
    """

    levels: tuple[str, ...]
    bias_ms: float
    pace_mm_s: float
    zone_px: float
    fitted: tuple[str, ...]
    means_ms: dict[str, FloatArray]

    def residuals_ms(self, level: str) -> FloatArray:
        """Give model - paper, (6,)."""
        return np.asarray(self.means_ms[level] - np.array(PAPER_MEANS_ms[level]))

    def error_ms(self, level: str) -> float:
        """Give the root of the mean squared residual."""
        return float(np.sqrt(np.mean(self.residuals_ms(level) ** 2)))


def fit_paper(
    model: PaperModel, levels: Sequence[str] = ("easy", "hard"), zone_px: float | None = None
) -> PaperFit:
    """Fit the means of some levels by least squares; zone_px None: fitted too, which needs both levels.

    The other level is predicted with the same numbers.
    """
    from scipy.optimize import least_squares

    start = [40.0, np.log(100.0)] + ([10.0] if zone_px is None else [])
    low, high = [-200.0, np.log(PACES_mm_s[0]), 0.5], [400.0, np.log(PACES_mm_s[-1]), 90.0]

    def means(numbers: FloatArray, level: str) -> FloatArray:
        zone = float(numbers[2]) if zone_px is None else zone_px
        return model.means_ms(level, float(numbers[0]), float(np.exp(numbers[1])), zone)

    def miss(numbers: FloatArray) -> FloatArray:
        return np.concatenate([means(numbers, level) - np.array(PAPER_MEANS_ms[level]) for level in levels])

    bounds = (low[: len(start)], high[: len(start)])
    best = least_squares(
        miss, start, bounds=bounds, diff_step=[1e-3] * len(start), x_scale=[10.0, 0.2, 5.0][: len(start)]
    ).x
    found = ("bias_ms", "pace_mm_s", "zone_px")[: len(start)]
    zone = float(best[2]) if zone_px is None else zone_px
    told = {level: means(best, level) for level in PAPER_MEANS_ms}
    return PaperFit(tuple(levels), float(best[0]), float(np.exp(best[1])), zone, found, told)
