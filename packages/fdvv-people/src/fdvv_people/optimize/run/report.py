"""What an optimisation came to: its figures by name, as ``fdvv optimize --json`` prints them, and a page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv._version import __version__
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.report import style
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg
from fdvv.units import FloatArray
from fdvv_people.optimize.problem import Answer, Trial, TrialState
from fdvv_people.optimize.run.ending import final_report
from fdvv_people.optimize.run.front import front_report, front_section, score_label, score_text
from fdvv_people.optimize.run.state import RunState
from fdvv_people.optimize.run.verdict import at_bound, retest_of, retests_of, verdict_sentence
from fdvv_people.optimize.space import Design
from fdvv_people.report.score_figures import TrainingScores, plot_training

if TYPE_CHECKING:
    from matplotlib.axes import Axes


STEP_mm = 0.02  # a clicky switch falls within 50 um (docs/explanation/library.md): a coarser step blunts it
ACTUATION: Any = {"color": style.PALETTE[2], "linestyle": (0, (4, 2)), "linewidth": 1.4}
VIBRATION: Any = {"color": style.PALETTE[1], "linestyle": (0, (1, 1.5)), "linewidth": 1.6}


@dataclass(frozen=True, eq=False)
class DesignPanel:
    """One design.

    Attributes
    ----------
    title : of the panel. model : the button. points : (n, 2) control points, mm and cN; None: none are drawn.
    """

    title: str
    model: FDVVModel
    points: FloatArray | None = None


@style.in_house_style
def plot_designs(panels: Sequence[DesignPanel], columns: int = 2, simulated: bool = False) -> Any:
    """Draw designs in a grid with common scales: force of the press, actuation and onset of vibration.

    Returns the (rows, columns) array of axes. ModelError without a design.
    """
    if not panels:
        raise ModelError("a figure of designs needs at least one")
    rows = -(-len(panels) // columns)
    fig = style.new_figure(4.0 * columns + 0.4, 2.35 * rows + 0.6)
    axes = fig.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for number, ax in enumerate(axes.flat):
        ax.set_visible(number < len(panels))
    for ax, panel in zip(axes.flat, panels, strict=False):
        _draw_design(ax, panel)
        style.set_titles(ax, style.name_text(panel.title), simulated or panel.model.provenance.simulated)
    for number, ax in enumerate(axes.flat):
        ax.set_xlabel(style.DISPLACEMENT if number + columns >= len(panels) else "")
        ax.tick_params(labelbottom=number + columns >= len(panels))
        ax.set_ylabel(style.FORCE if number % columns == 0 else "")
    axes[0, 0].set_ylim(bottom=0.0)
    _legend(axes, panels)
    return axes


def _draw_design(ax: Axes, panel: DesignPanel) -> None:
    model = panel.model
    x = np.arange(0.0, model.travel_mm + STEP_mm / 2, STEP_mm)
    force = model.of(Stroke.PRESS)[0].force_cN(x)
    ax.plot(x, force, color=style.PALETTE[0], linewidth=1.8)
    if panel.points is not None:
        ax.plot(*panel.points.T, "o", color=style.PALETTE[0], markerfacecolor="white", markersize=5.5)
    if model.actuation_mm is not None:
        ax.axvline(model.actuation_mm, **ACTUATION)
    for vibration in model.vibrations:
        if vibration.stroke is Stroke.PRESS:
            ax.axvline(vibration.onset_mm, **VIBRATION)


def _legend(axes: Any, panels: Sequence[DesignPanel]) -> None:
    """Name curve, points and marks once for all, below."""
    handles = [style.handle("force of the press", color=style.PALETTE[0])]
    if any(panel.points is not None for panel in panels):
        look: Any = {"linestyle": "", "marker": "o", "color": style.PALETTE[0], "markerfacecolor": "white"}
        handles.append(style.handle("control point", **look))
    handles += [style.handle("activation", **ACTUATION), style.handle("vibration", **VIBRATION)]
    labels = [str(item.get_label()) for item in handles]
    axes[0, 0].figure.legend(handles, labels, loc="outside lower center", ncols=len(handles))


SIMULATED = "a simulated person pressed the twin; no human and no hardware took part"
COMPARED = "a simulated person with a taste of their own answered; no human and no hardware took part"


def optimize_report(session: RunState) -> dict[str, Any]:
    """Return trials, the recommended design and how the run was made; units are in the names.

    front : of several objectives, see `front_report`. retests : see `Retest`, by objective.
    at_bound : its values that are the least or the most allowed. retest, against_fixed : see `Retest`;
    against_switches : see `AgainstSwitches`; None of none. final_means : of all that was played at the end.
    verdict, ending : in sentences. lines, comparisons : of the search, where it asks for these. answers : of
    its retest.
    """
    setup, best, retest = session.setup, session.recommended(), retest_of(session)
    asks = session.asks_for
    return {
        "space": session.space.name,
        "engine": setup.engine,
        "task": setup.task,
        "level": setup.level,
        "seed": setup.seed,
        "objective": session.problem.objectives[0].name,
        "objectives": [one.name for one in session.problem.objectives],
        "budget": setup.budget,
        "finished": session.finished,
        "trials": [trial_report(trial) for trial in session.trials if asks == "trial"],
        "lines": [line_report(trial) for trial in session.trials if asks == "line"],
        "comparisons": [comparison_report(trial) for trial in session.trials if asks == "comparison"],
        "best": best,
        "at_bound": at_bound(session.space, best, session.start) if best else {},
        "front": front_report(session),
        "retest": asdict(retest) if retest else None,
        "retests": {name: asdict(one) for name, one in retests_of(session).items()},
        "verdict": verdict_sentence(session),
        "answers": list(session.retest_answers),
        **final_report(session),
        "simulated": setup.simulated,
    }


def trial_report(trial: Trial) -> dict[str, Any]:
    """Return a trial: score is that of its first objective, null unless it is done."""
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


def line_report(trial: Trial) -> dict[str, Any]:
    """Return a line: best is which of its stops is liked best, from 0; None before somebody said it."""
    return {"number": trial.number, "stops": trial.designs, "best": trial.best[0] if trial.best else None}


def comparison_report(trial: Trial) -> dict[str, Any]:
    first, second = trial.designs
    return {"number": trial.number, "first": first, "second": second, "answer": trial.answer}


def optimize_html(session: RunState) -> str:
    """Write the page of a run. Needs matplotlib (BuildError without it)."""
    report, setup = optimize_report(session), session.setup
    sections = [
        _verdict(report),
        front_section(session),
        _found(session, report),
        _scores(session),
        _answers(session) if setup.preference else _trials(session),
    ]
    footer = f"fdvv {__version__}; engine {setup.engine}, seed {setup.seed}, begun {setup.created}"
    notice = COMPARED if setup.preference else SIMULATED
    shown = [section for section in sections if section is not None]
    summary = f"Space {session.space.name}, engine {setup.engine}: {_counts(session)}."
    return render_html(
        f"Optimisation: {setup.title}", summary, shown, footer, notice if setup.simulated else None
    )


def _counts(session: RunState) -> str:
    budget = session.setup.budget
    if session.setup.preference:
        return f"{session.answered} of {budget} {session.asks_for}s answered"
    return f"{len(session.trials)} of {budget} trials, {session.answered} of them scored"


def control_points(design: dict[str, float]) -> FloatArray | None:
    """Return the control points of a design of the paper's space, (3, 2) in mm and cN; None elsewhere."""
    try:
        return np.array([(design[f"x{i}_mm"], design[f"y{i}_cN"]) for i in (1, 2, 3)])
    except KeyError:
        return None


def _verdict(report: dict[str, Any]) -> Section | None:
    if report["verdict"] is None:
        return None
    text, means = [report["verdict"], *report["ending"]], report["final_means"]
    if pairs := report["answers"]:
        played = f"Start and result were compared {len(pairs)} times, blind, in a drawn order."
        text.append(f'{played} {pairs.count(Answer.EQUAL)} answers were "equal" and count for neither.')
    if not means:
        return Section("Verdict", tuple(text))
    most = max(one["trials"] for one in means)
    text.append(f"All were played again, blind, in {most} blocks of drawn order; each block has each once.")
    names = report["objectives"]
    rows = tuple(
        (one["name"], str(one["trials"]), *(score_text(one["means"][name], name) for name in names))
        for one in means
    )
    columns = ("played", "trials", *(f"mean {score_label(name)}" for name in names))
    return Section("Verdict", tuple(text), (), (Table(columns, rows),))


def _found(session: RunState, report: dict[str, Any]) -> Section:
    """Show the recommended design beside the one that was begun from."""
    best, start = report["best"], session.start
    if best is None or start is None:
        known = "answered" if session.setup.preference else "scored"
        return Section("Design found", (f"Nothing is {known} yet.",))
    # another program's own numbers are no buttons to draw
    figures = () if session.setup.space.kind == "own" else (_designs_svg(session, start, best),)
    limits = {one.name: (f"{one.low:.2f}", f"{one.high:.2f}") for one in session.space.parameters}
    rows = tuple((name, f"{start[name]:.2f}", f"{best[name]:.2f}", *limits[name]) for name in limits)
    by_scores = "expected scores, given all trials, not by the luckiest score"
    by_answers = "expected liking, given all answers, not by the last one"
    text = [f"The recommendation is by {by_answers if session.setup.preference else by_scores}."]
    for name, which in report["at_bound"].items():
        text.append(f"{name} is the {which} allowed: a better design may lie beyond.")
    columns = ("parameter", "start", "recommended", "least", "most")
    return Section("Design found", tuple(text), figures, (Table(columns, rows),))


def _designs_svg(session: RunState, start: dict[str, float], best: dict[str, float]) -> str:
    panels = [
        DesignPanel(name, session.model(design, name), control_points(design))
        for name, design in ((session.setup.start_name, start), ("recommended", best))
    ]
    axes = plot_designs(panels, simulated=session.setup.simulated)
    return figure_svg(axes, "First and recommended design")


def _scores(session: RunState) -> Section | None:
    """Draw the first objective over the trials; nothing before the first score."""
    name = session.problem.objectives[0].name
    values = [t.scores[name].value if t.scores else np.nan for t in session.trials]
    if not np.isfinite(values).any():
        return None
    panel = TrainingScores(session.setup.level or session.setup.task, np.array([values]))
    axes = plot_training([panel], score_label(name), simulated=session.setup.simulated)
    return Section("Scores", (), (figure_svg(axes, "Score of every trial"),))


def _answers(session: RunState) -> Section:
    """List what was liked best of every line, or better of every two."""
    rows = [
        (str(trial.number), _which(trial, trial.best), *_cells(session, liked_design(trial)))
        for trial in session.trials
        if trial.best
    ]
    columns = (session.asks_for, "liked best", *map(score_label, session.space.names))
    return Section("Answers", (), (), (Table(columns, tuple(rows)),))


def _which(trial: Trial, best: Sequence[int]) -> str:
    """Write which designs of a trial are liked best."""
    if len(best) > 1:
        return "equal"
    count = len(trial.designs)
    return "AB"[best[0]] if count == 2 else f"{best[0] + 1} of {count}"


def liked_design(trial: Trial) -> Design | None:
    """Return the one design of a trial that is liked best; None where there is no difference."""
    return trial.designs[trial.best[0]] if trial.best and len(trial.best) == 1 else None


def _cells(session: RunState, design: Design | None) -> list[str]:
    """Write the numbers of a design for a table; a dash for each of none."""
    if design is None:
        return ["–"] * len(session.space.names)
    return [f"{design[name]:.{0 if name.endswith('_cN') else 2}f}" for name in session.space.names]


def _trials(session: RunState) -> Section:
    objectives = [one.name for one in session.problem.objectives]
    more = tuple(score_label(name) for name in objectives[1:])
    columns = (
        "trial",
        "state",
        "score",
        "error",
        *more,
        *(score_label(name) for name in session.space.names),
    )
    rows = []
    for trial in session.trials:
        report = trial_report(trial)
        scored = ("–" if report[key] is None else f"{report[key]:.1f}" for key in ("score", "error"))
        others = (score_text(report["scores"].get(name), name) for name in objectives[1:])
        rows.append((str(trial.number), report["state"], *scored, *others, *_cells(session, trial.design)))
    failed = tuple(
        f"Trial {t.number} failed: {t.reason}." for t in session.trials if t.state is TrialState.FAILED
    )
    return Section("Trials", failed, (), (Table(columns, tuple(rows)),))
