"""Runs of engines side by side: who met whom, what was reached after so many evaluations. Simulated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from fdvv.units import FloatArray

SEEDS, PEOPLE = 20, 30
Level = Literal["easy", "hard"]
LEVELS: tuple[Level, ...] = ("easy", "hard")
LOOKS = (1, 2, 3, 5, 8, 10, 12, 15, 18, 21, 25, 30)
"""After how many evaluations a recommendation is judged."""
BUDGET, BASELINE = 30, "gp-ei"
SMOOTHED = f"{BASELINE}, mean"
"""The baseline's own trials, its answer the design with the best posterior mean instead of the best score."""


@dataclass(frozen=True)
class Run:
    """A variant on one seed, person and level."""

    variant: str
    number: int
    level: str

    @property
    def seed(self) -> int:
        """Get which seed, from 0, the engine and the presses have."""
        return self.number % SEEDS

    @property
    def person(self) -> int:
        """Get the person; over 60 runs seeds and people form pairs that do not come again within 600."""
        return (self.number + self.number // 60) % PEOPLE


def common(found: Mapping[Run, list[float]]) -> dict[Run, list[float]]:
    """Keep the seeds, people and levels that every variant has met: only these can be compared."""
    variants = {run.variant for run in found}
    met = {
        (number, level)
        for number, level in {(run.number, run.level) for run in found}
        if all(Run(name, number, level) in found for name in variants)
    }
    return {run: values for run, values in found.items() if (run.number, run.level) in met}


def curves(found: Mapping[Run, Sequence[float]], variant: str, level: str) -> FloatArray:
    """Gather what a variant reached, (runs, evaluations)."""
    return np.array([v for run, v in found.items() if (run.variant, run.level) == (variant, level)])


def reached_after(found: Mapping[Run, Sequence[float]], variant: str, level: str, count: int) -> FloatArray:
    """Return what a variant reached after so many evaluations, (runs,)."""
    return curves(found, variant, level)[:, LOOKS.index(count)]


def needed(reached: FloatArray, final: float) -> int | None:
    """Return after how many evaluations the median is at least as good as a final one, and stays so."""
    good = np.median(reached, axis=0) <= final
    stays = np.logical_and.accumulate(good[::-1])[::-1]
    return LOOKS[int(np.argmax(stays))] if stays.any() else None


def table(found: Mapping[Run, Sequence[float]]) -> str:
    """Write the comparison as a Markdown table."""
    half = BUDGET // 2
    lines = [
        f"| engine | level | runs | after {half}: median (5-95 %) ms | after {BUDGET} "
        "| as good as the baseline's final |",
        "|---|---|---|---|---|---|",
    ]
    for level in LEVELS:
        final = float(np.median(curves(found, BASELINE, level)[:, -1]))
        for name in dict.fromkeys(run.variant for run in found):
            reached = curves(found, name, level)
            whole = reached.shape[1] == len(LOOKS)
            last = _spread(reached[:, -1]) if whole else "-"
            after = needed(reached, final)
            summary = f"after {after}" if after else f"not within {BUDGET if whole else half}"
            reach = f"{len(reached)} | {_spread(reached_after(found, name, level, half))} | {last}"
            lines.append(f"| {name} | {level} | {reach} | {summary} |")
    return "\n".join(lines)


def paired(found: Mapping[Run, Sequence[float]], variant: str, level: str) -> str:
    """Return on how many pairs of runs a variant is at least as good after half the evaluations."""
    gains = [
        found[Run(BASELINE, run.number, level)][-1] - values[LOOKS.index(BUDGET // 2)]
        for run, values in found.items()
        if (run.variant, run.level) == (variant, level)
    ]
    share = 100 * np.mean(np.array(gains) >= 0)
    summary = f"better or equal on {share:.0f} % of {len(gains)}; gain {_spread(np.array(gains))} ms"
    return f"{variant}, {level}: {summary}"


def _spread(values: FloatArray) -> str:
    low, middle, high = np.percentile(values, [5, 50, 95])
    return f"{middle:.1f} ({low:.1f}-{high:.1f})"


def draw(found: Mapping[Run, Sequence[float]], path: Path) -> None:
    """Draw medians over evaluations, one panel a level."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4.2), layout="constrained")
    for axes, level in zip(figure.subplots(1, 2, sharey=True), LEVELS, strict=True):
        for name in dict.fromkeys(run.variant for run in found):
            reached = curves(found, name, level)
            n = LOOKS[: reached.shape[1]]
            (line,) = axes.plot(
                n, np.median(reached, axis=0), label=name, lw=2.5 if name == BASELINE else 1.3
            )
            if name in (BASELINE, "gp, warm"):
                low, high = np.percentile(reached, [5, 95], axis=0)
                axes.fill_between(n, low, high, alpha=0.12, color=line.get_color(), lw=0)
        axes.set(title=f"{level}, simulated", xlabel="evaluations", ylim=(None, 150))
        axes.axhline(np.median(curves(found, BASELINE, level)[:, -1]), color="grey", lw=0.8, ls=":")
    figure.axes[0].set_ylabel("expected asynchrony (ms)")
    figure.axes[1].legend(fontsize=7)
    figure.savefig(path)
