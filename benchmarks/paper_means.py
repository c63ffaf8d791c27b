"""The paper's twelve means out of presses on the twin, with three global numbers at most. Simulated."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from fdvv.errors import InputError, ModelError
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.press_simulator import PressSimulator, known_rig
from fdvv_people.optimize.people.simulate import Hand
from fdvv_people.optimize.people.user import SimulatedUser, UserSettings, aim_s, draw_users, timing_spread_s
from fdvv_people.task.pointing import LOST_ms, TemporalPointing

PAPER_BUTTONS = ("optimal", "clear", "brown", "black", "red", "random")
"""Buttons of the paper's validation, in the order of its table."""
PAPER_MEANS_ms: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {
        "easy": (65.8, 83.6, 88.04, 81.65, 84.28, 100.78),
        "hard": (77.3, 93.43, 97.48, 96.9, 96.65, 108.22),
    }
)
"""Mean asynchrony of PAPER_BUTTONS: 10 people, 2 rounds of 20 presses (CHI 2020)."""
PAPER_SPREADS_ms: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {
        "easy": (6.15, 7.65, 7.82, 6.19, 6.75, 6.89),
        "hard": (6.89, 7.56, 7.69, 7.61, 6.36, 8.77),
    }
)
"""The paper's STD of each; of what, it does not say."""


def folded_normal_mean(mean: npt.ArrayLike, spread: npt.ArrayLike) -> FloatArray:
    """Return the mean of |x| for normal x; both broadcast, spread above 0 (Leone et al. 1961)."""
    from scipy.special import erf

    mu, sigma = np.asarray(mean, float), np.asarray(spread, float)
    around = sigma * math.sqrt(2 / math.pi) * np.exp(-0.5 * (mu / sigma) ** 2)
    return np.asarray(around + mu * erf(mu / (sigma * math.sqrt(2))))


@dataclass(frozen=True, eq=False)
class PressTable:
    """Presses, simulated; every column (n,), times from the onset of the movement.

    Attributes
    ----------
    user : who pressed. key_s : when the key went down; NaN: never, or before the movement.
    felt_s, felt_spread_s : when the press was felt, and how well.
    """

    user: SimulatedUser
    key_s: FloatArray
    felt_s: FloatArray
    felt_spread_s: FloatArray

    def halves(self) -> tuple[PressTable, PressTable]:
        """Split it in two, the later presses second."""
        columns = (self.key_s, self.felt_s, self.felt_spread_s)
        parts = zip(*(np.array_split(column, 2) for column in columns), strict=True)
        first, second = (PressTable(self.user, *part) for part in parts)
        return first, second


def press_table(
    model: FDVVModel, user: SimulatedUser, count: int, seed: int, rig: str = "ideal"
) -> PressTable:
    """Press count times; a design that cannot be held never activates. InputError on an unknown rig."""
    known_rig(rig)
    try:
        hand = Hand(PressSimulator(model, user, rig), np.random.default_rng([seed, user.number]))
    except (InputError, ModelError):
        return PressTable(user, np.full(count, np.nan), np.zeros(count), np.ones(count))
    rows = []
    for _ in range(count):
        press = hand.press()
        if press is None:
            rows.append((np.nan, 0.0, 1.0))
            continue
        key = press.keys_s[0] if press.keys_s and not press.early else np.nan
        rows.append((key, press.percept.time_s, press.percept.spread_s))
    return PressTable(user, *np.array(rows).T)


def expected_ms(table: PressTable, task: TemporalPointing, bias_ms: float) -> float:
    """Return the mean asynchrony of one who does not adapt: folded normals about the table's presses."""
    user = table.user
    spread_s = np.hypot(timing_spread_s(user, task.cue_s, task.period_s), 1e-3 * user.motor_ms)
    late_ms = bias_ms + user.bias_ms - user.anticipated_ms + 1e3 * (aim_s(user, task.zone_s) + table.key_s)
    counted = np.minimum(folded_normal_mean(late_ms, 1e3 * spread_s), LOST_ms)
    return float(np.mean(np.where(np.isnan(counted), LOST_ms, counted)))


def adapted_ms(
    table: PressTable, task: TemporalPointing, bias_ms: float, gain: float, runs: int, seed: int
) -> float:
    """Return the mean asynchrony of one who adapts by this gain: runs of the task on presses of the table."""
    user, random = table.user, np.random.default_rng([seed, table.user.number])
    spread_s = np.hypot(timing_spread_s(user, task.cue_s, task.period_s), 1e-3 * user.motor_ms)
    which = random.integers(table.key_s.size, size=(task.rounds, runs))
    scatter, touch = random.standard_normal((2, task.rounds, runs))
    aim, plan = aim_s(user, task.zone_s), np.full(runs, -1e-3 * user.anticipated_ms)
    counted = np.empty((task.rounds, runs))
    for i in range(task.rounds):
        moved_s = plan + spread_s * scatter[i]
        felt_s = moved_s + table.felt_s[which[i]] + table.felt_spread_s[which[i]] * touch[i]
        counted[i] = np.abs(1e3 * (aim + moved_s + table.key_s[which[i]]) + bias_ms + user.bias_ms)
        plan = plan - gain * felt_s
    return float(np.mean(np.where(counted < LOST_ms, counted, LOST_ms)))


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
        """Return the mean score of PAPER_BUTTONS, (6,).

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
        """Return the mean asynchrony of PAPER_BUTTONS, (6,)."""
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
        """Return model - paper, (6,)."""
        return np.asarray(self.means_ms[level] - np.array(PAPER_MEANS_ms[level]))

    def error_ms(self, level: str) -> float:
        """Return the root of the mean squared residual."""
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
    fitted = {level: means(best, level) for level in PAPER_MEANS_ms}
    return PaperFit(tuple(levels), float(best[0]), float(np.exp(best[1])), zone, found, fitted)
