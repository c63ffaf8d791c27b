"""What an optimisation came to: its figures by name, as ``fdvv optimize --json`` prints them, and a page."""

from __future__ import annotations

from typing import Any

import numpy as np

from fdvv import __version__
from fdvv.errors import ModelError
from fdvv.optimize import Trial, TrialState
from fdvv.plot import (
    DesignPanel,
    Section,
    Table,
    TrainingScores,
    figure_svg,
    plot_designs,
    plot_training,
    render_html,
)
from fdvv.units import FloatArray
from fdvv.workflow._optimize_session import OptimizeSession

SIMULATED = "a simulated person pressed the twin; no human and no hardware took part"


def optimize_report(session: OptimizeSession) -> dict[str, Any]:
    """Give trials, the recommended design and how the run was made; units are in the names."""
    setup = session.setup
    return {
        "space": session.space.name,
        "engine": setup.engine,
        "task": setup.task,
        "level": setup.level,
        "seed": setup.seed,
        "budget": setup.budget,
        "finished": session.finished,
        "trials": [trial_report(trial) for trial in session.trials],
        "best": best_of(session),
        "simulated": setup.simulated,
    }


def trial_report(trial: Trial) -> dict[str, Any]:
    """Give a trial: score is that of its first objective, null unless it is done."""
    first = next(iter(trial.scores.values()), None)
    return {
        "number": trial.number,
        "parameters": trial.design,
        "score": first.value if first else None,
        "error": first.error if first else None,
        "scores": {name: score.value for name, score in trial.scores.items()},
        "state": str(trial.state),
        "origin": trial.origin,
        "suggested": trial.suggested,
        "reason": trial.reason or None,
    }


def best_of(session: OptimizeSession) -> dict[str, float] | None:
    """Give the recommended design; None as long as nothing is done, or with several objectives."""
    if len(session.problem.objectives) > 1:
        return None
    try:
        return session.best()
    except ModelError:
        return None


def optimize_html(session: OptimizeSession) -> str:
    """Write the page of a run. Needs matplotlib (BuildError without it)."""
    report, setup = optimize_report(session), session.setup
    done = [t for t in session.trials if t.state is TrialState.DONE]
    counts = f"{len(session.trials)} of {setup.budget} trials, {len(done)} of them scored"
    title = f"{setup.task}, {setup.level}" if setup.level else setup.task
    sections = [_found(session, report["best"]), _scores(session), _trials(session)]
    footer = f"fdvv {__version__}; engine {setup.engine}, seed {setup.seed}, begun {setup.created}"
    told = [section for section in sections if section is not None]
    summary = f"Space {session.space.name}, engine {setup.engine}: {counts}."
    return render_html(
        f"Optimisation: {title}", summary, told, footer, SIMULATED if setup.simulated else None
    )


def control_points(design: dict[str, float]) -> FloatArray | None:
    """Give the control points of a design of the paper's space, (3, 2) in mm and cN; None elsewhere."""
    try:
        return np.array([(design[f"x{i}_mm"], design[f"y{i}_cN"]) for i in (1, 2, 3)])
    except KeyError:
        return None


def _found(session: OptimizeSession, best: dict[str, float] | None) -> Section:
    """Show the recommended design beside the one that was begun from."""
    if best is None:
        return Section("Design found", ("Nothing is scored yet, or there are several objectives.",))
    start = session.setup.start or session.trials[0].design
    panels = [
        DesignPanel(name, session.model(design, name), control_points(design))
        for name, design in (("first design", dict(start)), ("recommended", best))
    ]
    svg = figure_svg(plot_designs(panels, simulated=session.setup.simulated), "First and recommended design")
    rows = tuple((name, f"{start[name]:.2f}", f"{best[name]:.2f}") for name in session.space.names)
    text = ("The recommendation is by what the engine believes of all trials, not by the luckiest score.",)
    return Section("Design found", text, (svg,), (Table(("parameter", "first", "recommended"), rows),))


def _scores(session: OptimizeSession) -> Section | None:
    """Draw the first objective over the trials; nothing before the first score."""
    name = session.problem.objectives[0].name
    values = [t.scores[name].value if t.scores else np.nan for t in session.trials]
    if not np.isfinite(values).any():
        return None
    panel = TrainingScores(session.setup.level or session.setup.task, np.array([values]))
    axes = plot_training([panel], score_label(name), simulated=session.setup.simulated)
    return Section("Scores", (), (figure_svg(axes, "Score of every trial"),))


def score_label(name: str) -> str:
    """Write an objective's name for an axis: asynchrony_ms is asynchrony (ms)."""
    words, _, unit = name.rpartition("_")
    return f"{words.replace('_', ' ')} ({unit})" if words else name


def _trials(session: OptimizeSession) -> Section:
    columns = ("trial", "state", "score", "error", *(score_label(name) for name in session.space.names))
    rows = []
    for trial in session.trials:
        told = trial_report(trial)
        values = (_value_text(name, trial.design[name]) for name in session.space.names)
        scored = ("–" if told[key] is None else f"{told[key]:.1f}" for key in ("score", "error"))
        rows.append((str(trial.number), told["state"], *scored, *values))
    failed = tuple(
        f"Trial {t.number} failed: {t.reason}." for t in session.trials if t.state is TrialState.FAILED
    )
    return Section("Trials", failed, (), (Table(columns, tuple(rows)),))


def _value_text(name: str, value: float) -> str:
    return f"{value:.0f}" if name.endswith("_cN") else f"{value:.2f}"
