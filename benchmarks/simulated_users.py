"""What simulated people get of the paper's buttons, and what that hangs on. Simulated; about six minutes.

Run as ``python -m benchmarks.simulated_users``, with ``--parts speed,paper,sweep,designs,noise,people`` for
some of it. `paper` fits the paper's twelve means with at most three global numbers; `people` judges the
timing of real people who tapped, split by person, and needs ../shared/data.
"""

from __future__ import annotations

import argparse
import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.paper_means import (
    PAPER_BUTTONS,
    PAPER_MEANS_ms,
    PAPER_SPREADS_ms,
    PaperFit,
    PaperModel,
    PaperPresses,
    PaperStudy,
    adapted_ms,
    fit_paper,
    press_table,
)
from benchmarks.people_calibration import (
    fit_timing,
    force_spread_ratio,
    pooled_log_likelihood,
    read_taps,
    spread_error_ratio,
    timing_log_likelihood,
)
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.people.user import SimulatedUser, draw_users
from fdvv_people.task.pointing import TemporalPointing

GAINS = (0.0, 0.05, 0.1, 0.3)
BLOCKS = 20
"""Means of 20 presses behind each of the paper's numbers: 10 people, 2 rounds."""


def speed() -> None:
    """Time a score of 20 presses, of a design met before and of a new one."""
    space, user, task = paper_space(), SimulatedUser(), TemporalPointing("easy")
    score_design(task, load_builtin("mx-brown"), user, 0)
    same = [_score_ms(task, load_builtin("mx-brown"), user, seed) for seed in range(20)]
    places = np.random.default_rng(0).random((20, len(space.names)))
    designs = [paper_model(design) for design in space.of_unit(places)]
    new = [_score_ms(task, model, user, 0) for model in designs]
    reported = f"{np.median(same):.1f} ms of processor, of a new random design {np.median(new):.1f}"
    print(f"a score of 20 presses: {reported}")


def _score_ms(task: TemporalPointing, model: FDVVModel, user: SimulatedUser, seed: int) -> float:
    begun = time.process_time()
    score_design(task, model, user, seed)
    return 1e3 * (time.process_time() - begun)


def paper() -> None:
    """Fit the twelve means: the easy level alone, both, and with people who adapt."""
    model = PaperModel(PaperStudy())
    print("mean asynchrony, ms:" + " ".join(f"{name:>8}" for name in PAPER_BUTTONS))
    for level, means in PAPER_MEANS_ms.items():
        print(_row(f"paper, {level}", np.array(means)))
        print(_row("  its STD / sqrt(20)", np.array(PAPER_SPREADS_ms[level]) / np.sqrt(BLOCKS)))
    _print_fit("easy fitted, zone of 10 px given", fit_paper(model, ("easy",), 10.0))
    _print_fit("easy fitted, no zone", fit_paper(model, ("easy",), 0.5))
    for gain in GAINS:
        model.gain = gain
        _print_fit(f"all twelve, three numbers, gain {gain:g}", fit_paper(model))
    _switches()


def _row(label: str, values: FloatArray) -> str:
    return f"{label:<22}" + " ".join(f"{value:8.1f}" for value in values)


def _print_fit(label: str, fit: PaperFit) -> None:
    numbers = f"bias {fit.bias_ms:.0f} ms, pace {fit.pace_mm_s:.0f} mm/s, zone {fit.zone_px:.1f} px"
    print(f"\n{label}: {numbers}")
    for level in fit.means_ms:
        reported = "fitted" if level in fit.levels else "PREDICTED"
        print(_row(f"  {level}, {reported}", fit.means_ms[level]))
        print(_row(f"  off (rms {fit.error_ms(level):.1f})", fit.residuals_ms(level)))


def _switches() -> None:
    """Ask whether the paper's four switches differ by more than chance, if its STD is between block means."""
    from scipy.stats import chi2

    for level, means in PAPER_MEANS_ms.items():
        four, spread = np.array(means[1:5]), np.array(PAPER_SPREADS_ms[level][1:5])
        for count in (BLOCKS, BLOCKS // 2):
            odd = float(np.sum((four - four.mean()) ** 2 / (spread**2 / count)))
            print(f"four switches alike, {level}, n {count}: chi2 {odd:.1f}, p {chi2.sf(odd, 3):.2f}")


def sweep() -> None:
    """Vary one number of the middle person at a time."""
    middle = SimulatedUser()
    changes: list[dict[str, float]] = [{}]
    changes += [{"adaptation_ratio": gain} for gain in GAINS]
    changes += [{"percept_ms": value} for value in (5.0, 60.0)]
    changes += [{"impact_mm_s": value} for value in (50.0, 800.0)]
    changes += [{"vibration_m_s2": value} for value in (1.0, 50.0)]
    changes += [{"stiffness_N_m": value} for value in (260.0, 1000.0)]
    changes += [{"pace_mm_s": value} for value in (60.0, 80.0, 130.0, 180.0)]
    changes += [{"push_cN": value} for value in (80.0, 200.0)]
    print("easy level, ms          four switches   best - switches   random - switches")
    for change in changes:
        label = ", ".join(f"{name} {value:g}" for name, value in change.items()) or "as drawn"
        switches, best, random = _outcome(replace(middle, **change))  # type: ignore[arg-type]
        print(f"{label:<24}{switches:10.1f}{best - switches:16.1f}{random - switches:19.1f}", flush=True)


def _outcome(middle: SimulatedUser) -> tuple[float, float, float]:
    presses = PaperPresses.of(PaperStudy(people=6, designs=25, presses=4, middle=middle), middle.pace_mm_s)
    task, gain = TemporalPointing("easy"), middle.adaptation_ratio
    means = presses.means_ms(lambda table: adapted_ms(table, task, middle.bias_ms, gain, 100, 0))
    return float(np.mean(means[1:5])), float(means[0]), float(means[5])


def designs() -> None:
    """Report which parameters of the paper's space go with the middle person's asynchrony."""
    from scipy.stats import spearmanr

    user, task, space = SimulatedUser(), TemporalPointing("easy"), paper_space()
    drawn = space.of_unit(np.random.default_rng(5).random((300, len(space.names))))
    tables = [press_table(paper_model(design), user, 4, 0) for design in drawn]
    for gain in (0.0, user.adaptation_ratio, 0.2):
        found = np.array([adapted_ms(table, task, 0.0, gain, 60, 0) for table in tables])
        ranks = spearmanr(space.to_unit(drawn), found).statistic[-1, :-1]
        print(f"gain {gain:g}: best {found.min():.0f} ms, middle {np.median(found):.0f}; rank correlation")
        pairs = zip(space.names, ranks, strict=True)
        print("  " + ", ".join(f"{name} {rank:+.2f}" for name, rank in pairs))
        best = drawn[int(np.argmin(found))]
        print("  best: " + ", ".join(f"{name} {value:.1f}" for name, value in best.items()))


def noise() -> None:
    """Report the noise of a 20-press score, and how people differ."""
    for level in PAPER_MEANS_ms:
        for gain in (0.0, SimulatedUser().adaptation_ratio):
            _print_noise(TemporalPointing(level), gain)


def _print_noise(task: TemporalPointing, gain: float) -> None:
    model = load_builtin("mx-brown")
    users = [replace(user, adaptation_ratio=gain) for user in draw_users(20)]
    scores = [[score_design(task, model, u, seed)["asynchrony_ms"] for seed in range(4)] for u in users]
    table = np.array([[score.value for score in row] for row in scores])
    reported = np.mean([score.error or 0.0 for row in scores for score in row])
    within = np.sqrt(np.mean(np.var(table, axis=1, ddof=1)))
    between = np.std(table.mean(axis=1), ddof=1)
    print(f"{task.level}, gain {gain:g}, mx-brown: mean {table.mean():.1f} ms; a score scatters by", end=" ")
    print(f"{within:.1f} (reported {reported:.1f}), people by {between:.1f}")


def people() -> None:
    """Judge the timing of people who tapped on people the fit never saw."""
    folder = Path(os.environ.get("FDVV_SHARED", "../shared")) / "data"
    files = sorted((folder / "baath-sync-tapping").glob("*.csv"))
    if not files:
        print(f"left out: no tapping data in {folder}")
        return
    taps = read_taps(files[0])
    periods = np.array(taps.periods_ms)
    print("log-likelihood of a held-out tap, nats; and rms log ratio of spreads")
    for fold in range(3):
        out = taps.people[fold::3]
        known, unknown = taps.of([one for one in taps.people if one not in out]), taps.of(out)
        fit = fit_timing(known)
        odds = timing_log_likelihood(fit, unknown), pooled_log_likelihood(known, unknown)
        pooled = np.full(periods.size, known.late_ms.std())
        guesses = (fit.clock_ratio * periods, pooled, SimulatedUser().clock_ratio * periods)
        errors = " / ".join(f"{spread_error_ratio(guess, unknown):.2f}" for guess in guesses)
        print(f"  people {out}: clock {odds[0]:.2f}, one normal {odds[1]:.2f}; spreads {errors}")
    print("  (spreads by the fitted clock / one for all / the published clock)")
    print(f"  all: {fit_timing(taps)}")
    logs = folder / "forcepeaks-tapping"
    ratios = {who: force_spread_ratio(sorted(logs.glob(f"{who}*raw.dat"))) for who in ("SS02", "SS05")}
    print(f"spread of tap force within a trial, of its mean: {ratios}; assumed 0.15")


PARTS = {"speed": speed, "paper": paper, "sweep": sweep, "designs": designs, "noise": noise, "people": people}


def main() -> None:
    """Print the parts that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--parts", default=",".join(PARTS))
    print("simulated")
    for name in parser.parse_args().parts.split(","):
        print(f"\n-- {name}")
        PARTS[name]()


if __name__ == "__main__":
    main()
