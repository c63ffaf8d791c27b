"""The front of a run of several objectives: in figures by name, as a table, as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fdvv.report import style
from fdvv.report.report import Section, Table
from fdvv.report.svg import figure_svg
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.state import RunState

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def front_report(session: RunState) -> list[dict[str, Any]]:
    """Return the compromises of a run, best in the first objective first; empty where there is one objective.

    expected, error : by objective, the posterior mean and its SD. recommended : the one that is retested.
    start : it is the design that the run began with.
    """
    if not session.setup.several:
        return []
    found, start = session.recommended(), session.start
    return [
        {
            "number": trial.number,
            "parameters": trial.design,
            "expected": {name: score.value for name, score in trial.scores.items()},
            "error": {name: score.error for name, score in trial.scores.items()},
            "recommended": trial.design == found,
            "start": trial.design == start,
        }
        for trial in session.front().trials
    ]


def front_section(session: RunState) -> Section | None:
    """Write the front as a section of a page; None where there is none."""
    rows = front_report(session)
    if not rows:
        return None
    names = [one.name for one in session.problem.objectives]
    text = (
        "No tried design is better than one of these in every wish. Values are expected, by all trials, "
        "with one standard deviation: as measured, a noisy front looks better than it is.",
        _said(session),
    )
    table = Table(
        ("trial", *(score_label(name) for name in names), ""),
        tuple((str(row["number"]), *(_cell(row, name) for name in names), front_mark(row)) for row in rows),
    )
    return Section("Compromises", text, (figure_svg(plot_front(session), "Front of compromises"),), (table,))


def _said(session: RunState) -> str:
    if weights := session.setup.weights:
        by = ", ".join(f"{name} {weight:g}" for name, weight in weights.items())
        return f"Recommended: the best by weights ({by}), unless a person took another."
    return (
        "Recommended: the one nearest to the best of every wish at once, each in parts of its range over the "
        "front, unless a person took another."
    )


def front_mark(row: dict[str, Any]) -> str:
    """Write what is special about a row of the front."""
    return ", ".join(name for name in ("recommended", "start") if row[name])


def _cell(row: dict[str, Any], name: str) -> str:
    return f"{score_text(row['expected'][name], name)} ± {score_text(row['error'][name], name)}"


UNITS = {"_N_s": "N s", "_cN_mm": "cN/mm"}
"""Of names whose unit has two parts."""


def score_label(name: str) -> str:
    """Write the name of an objective or a parameter for an axis: asynchrony_ms is asynchrony (ms)."""
    end = next((end for end in UNITS if name.endswith(end)), f"_{name.rpartition('_')[2]}")
    words = name.removesuffix(end)
    return f"{words.replace('_', ' ')} ({UNITS.get(end, end[1:])})" if words != name else name


def score_digits(name: str) -> int:
    """Return after how many digits a score is cut."""
    return 1 if name.endswith("_ms") else 2


def score_text(value: float | None, name: str) -> str:
    """Write a score without its unit; a dash for None."""
    return "–" if value is None else f"{value:.{score_digits(name)}f}"


@style.in_house_style
def plot_front(session: RunState) -> Any:
    """Draw every further objective over the first: trials as measured, and the front's expected values.

    Returns the (panels,) array of axes.
    """
    first, *others = (one.name for one in session.problem.objectives)
    axes = style.new_figure(4.6 * len(others), 3.6).subplots(1, len(others), squeeze=False)[0]
    for ax, other in zip(axes, others, strict=True):
        _draw(ax, session, first, other)
        ax.set_xlabel(score_label(first))
        ax.set_ylabel(score_label(other))
        style.set_titles(ax, f"{score_label(other)} over {score_label(first)}", session.setup.simulated)
    axes[0].legend()
    return axes


def _draw(ax: Axes, session: RunState, first: str, other: str) -> None:
    def at(trial: Trial) -> tuple[float, float]:
        return trial.scores[first].value, trial.scores[other].value

    done = [trial for trial in session.trials if trial.state is TrialState.DONE]
    ax.plot(*zip(*map(at, done), strict=True), "o", color=style.QUIET, markersize=4, label="as measured")
    front, found = session.front().trials, session.recommended()
    expected: Any = {
        "fmt": "o",
        "color": style.PALETTE[0],
        "markersize": 5.5,
        "label": "front, expected values",
    }
    errors: Any = [[trial.scores[name].error for trial in front] for name in (first, other)]
    x, y = zip(*map(at, front), strict=True)
    ax.errorbar(x, y, xerr=errors[0], yerr=errors[1], elinewidth=1.0, **expected)
    if taken := [at(trial) for trial in front if trial.design == found]:
        ring: Any = {"color": style.PALETTE[1], "fillstyle": "none", "markersize": 12, "markeredgewidth": 2}
        ax.plot(*taken[0], "o", label="recommended", **ring)
