"""fdvv optimize: run, resume, replay, report; experiment and population have modules of their own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from msgspec.structs import asdict

from fdvv.cli import ui
from fdvv.cli.settings import settings_options
from fdvv_people.cli.optimize.options import (
    ON_STRIP,
    Play,
    also_option,
    group_option,
    level_option,
    on_strip,
    rig_option,
    run_engine_option,
    strip_options,
    weight_option,
)
from fdvv_people.optimize.run.settings import RunSettings

if TYPE_CHECKING:
    from fdvv_people.optimize.problem import Trial
    from fdvv_people.optimize.run.session import Optimization

LAST = 8
"""Trials that are printed; --json has all."""
folder_argument = click.argument("folder", type=ui.FOLDER)


MODULES = {
    "experiment": "fdvv_people.cli.optimize.experiment",
    "group": "fdvv_people.cli.optimize.group",
    "population": "fdvv_people.cli.optimize.population",
}


@click.group(cls=ui.LazyGroup, modules=MODULES)
def optimize() -> None:
    """Find the button that makes a person perform best.

    Everything here is played by simulated people who press the twin; in the studio a person plays. FOLDER is
    that of a run: every trial is in it before anybody tries it, so a run may be killed at any moment.
    """


@optimize.command()
@ui.option("--folder", required=True, type=ui.PATH, help="New or empty folder of the run.")
@ui.option(
    "--space",
    help="paper, or a button whose numbers are varied, built in or a file: mx-clear, but paper with --prior.",
)
@ui.option(
    "--vary", multiple=True, default=("FDV",), help="Of a button: FDV, FDVV or single numbers; repeatable."
)
@ui.option("--buttons", is_flag=True, help="Of the paper's space: only designs that are buttons.")
@ui.option("--wide", is_flag=True, help="Of a button: also what no real button is like.")
@settings_options(RunSettings)
@ui.option(
    "--switch",
    "switches",
    multiple=True,
    metavar="BUTTON",
    help="Played at the end too, and the best fixed design of the paper's space; repeatable. none: the start "
    "alone, as for a real person. With a simulated one all four shipped switches.",
)
@ui.option(
    "--within", metavar="RIG", help="Only designs that this rig can render: a *.rig.json or a shipped one."
)
@ui.option(
    "--prior", type=ui.FOLDER, help="Begin from what others did: a finished fdvv optimize population --grid."
)
@ui.option(
    "--task",
    default="temporal-pointing",
    help="What is played: temporal-pointing, tapping, accuracy; or preference, to say what is liked better.",
)
@also_option
@weight_option
@level_option
@run_engine_option
@ui.option("--person", type=ui.COUNT, default=0, help="Seed that the simulated person is drawn with.")
@group_option
@ui.option("--seed", type=ui.COUNT, default=0, help="Of the run.")
@rig_option
@strip_options
@ui.verbose_option
@ui.json_option
def run(folder: Path, strip: str | None, device: str, verbose: bool, as_json: bool, **arguments: Any) -> None:
    """Begin an optimisation and play it to its end, with a simulated person or on an LED strip.

    The same options give the same trials. Ctrl-C stops between two trials; fdvv optimize resume goes on.
    """
    from fdvv_people.optimize.run.begin import begin_run

    ui.check_folder(folder)
    wanted = _request(strip=strip, **arguments)
    with on_strip(strip, device) as play, begin_run(folder, wanted) as session:
        _play(session, play, as_json, verbose)


@optimize.command()
@folder_argument
@strip_options
@ui.verbose_option
@ui.json_option
def resume(folder: Path, strip: str | None, device: str, verbose: bool, as_json: bool) -> None:
    """Go on with the run in FOLDER that was stopped or killed; the next design is as if it had not been."""
    from fdvv_people.optimize.run.session import Optimization

    with on_strip(strip, device) as play, Optimization.open(folder) as session:
        _play(session, play, as_json, verbose)


@optimize.command()
@folder_argument
@ui.json_option
def replay(folder: Path, as_json: bool) -> None:
    """Suggest every trial of a run anew from its seed, and tell whether each is the same.

    Exit status 1 if one is not: another version of a library, or a folder that was changed by hand.
    """
    from fdvv_people.optimize.run.replay import replay_differences
    from fdvv_people.optimize.run.session import Optimization

    with Optimization.open(folder) as session:
        engine, asks_for = session.setup.engine, session.asks_for
        suggested = sum(trial.origin == engine for trial in session.trials)
    different = [trial.number for trial in replay_differences(folder)]
    if as_json:
        ui.print_json(
            {"engine": engine, "suggested": suggested, "different": different, "same": not different}
        )
    elif not different:
        click.echo(f"{engine} suggests {ui.counted(suggested, asks_for)} again, each the same")
    if different:
        numbers = ", ".join(map(str, different))
        raise ui.failed(f"{folder}: {engine} now suggests otherwise at {asks_for} {numbers}")


@optimize.command()
@folder_argument
@ui.option("-o", "--output", type=ui.PATH, help="The *.html to write; in the folder if none.")
@ui.json_option
def report(folder: Path, output: Path | None, as_json: bool) -> None:
    """Write the run in FOLDER as a page: the design found, the scores, every trial."""
    from fdvv.report.report import write_report
    from fdvv_people.optimize.run.report import optimize_html, optimize_report
    from fdvv_people.optimize.run.session import Optimization

    ui.check_output(output, ".html")
    path = output or folder / "report.html"
    with Optimization.open(folder) as session:
        write_report(path, optimize_html(session))
        document = optimize_report(session)
    if as_json:
        ui.print_json({**document, "report": str(path)})
    else:
        click.echo(f"written to {path}")


def _request(
    engine: tuple[str, dict[str, Any]] | None,
    settings: RunSettings,
    person: int,
    strip: str | None,
    **arguments: Any,
) -> Any:
    from fdvv_people.optimize.run.begin import RunRequest
    from fdvv_people.optimize.run.player import POINTING

    if strip and arguments["task"] != POINTING:
        raise click.UsageError(f"on a strip one plays {POINTING}, not {arguments['task']}")
    if strip and (gone := [name for name in arguments["also"] if name not in ON_STRIP]):
        raise click.UsageError(f"on a strip {gone[0]} is not measured; play it in the studio")
    arguments["weights"] = dict(arguments.pop("weights"))
    name, options = engine or (None, {})
    simulated = person if strip in (None, "host") else None
    switches = arguments.pop("switches") or None
    chosen = {**arguments, **asdict(settings)}
    return RunRequest(engine=name, options=options, person=simulated, switches=switches, **chosen)


def _play(session: Optimization, play: Play | None, as_json: bool, verbose: bool) -> None:
    from fdvv_people.optimize.run.assessor import assessor_of
    from fdvv_people.optimize.run.player import played_min, player_of
    from fdvv_people.optimize.run.report import optimize_report

    ui.print_warnings(session.warnings)
    at_end = session.retest_left + len(session.retests)
    budget = session.setup.budget + at_end
    if not session.setup.simulated:
        search, end = (f"{played_min(session.setup, n):.0f} min" for n in (session.setup.budget, at_end))
        ui.print_stderr(
            f"presses take {search} for {session.setup.budget} trials, {end} for {at_end} at the end"
        )
    with ui.progress(f"{session.asks_for}s", budget) as move:
        try:
            if session.setup.preference:
                assessor_of(session.setup).play(session, lambda: move(_count(session), budget))
            elif play is None:
                player_of(session.setup).play(session, lambda trial: _on_trial(trial, budget, move, verbose))
            else:
                for trial in play(session):
                    _on_trial(trial, budget, move, verbose)
        except KeyboardInterrupt:
            kept = ui.counted(_count(session), session.asks_for)
            raise KeyboardInterrupt(
                f"stopped with {kept} kept; go on with: fdvv optimize resume {session.folder}"
            ) from None
    document = optimize_report(session)
    if as_json:
        ui.print_json(document)
    else:
        _print(session, document)


def _count(session: Optimization) -> int:
    """Return how many trials there are, of comparisons those that are answered, in the retest too."""
    return session.answered + len(session.retest_answers) if session.setup.preference else len(session.trials)


def _on_trial(trial: Trial, budget: int, move: Any, verbose: bool) -> None:
    move(trial.number + 1, budget)
    if verbose and trial.scores:
        scores = ", ".join(f"{name} {score.value:.1f}" for name, score in trial.scores.items())
        ui.print_stderr(f"trial {trial.number}: {scores}")
    if trial.reason:
        ui.print_warnings([f"trial {trial.number} failed: {trial.reason}"])


def _print(session: Optimization, document: dict[str, Any]) -> None:
    trials = document["trials"]
    click.echo(
        f"{session.setup.title}{ui.simulated(document['simulated'])}, engine {document['engine']}, "
        f"{ui.counted(session.answered if session.setup.preference else len(trials), session.asks_for)}"
    )
    if session.setup.several:
        _print_front(document)
    elif not session.setup.preference:
        rows = [[t[key] for key in ("number", "state", "score", "error")] for t in trials[-LAST:]]
        name = document["objective"]
        ui.print_table(["trial", "state", name, "error"], rows, left=2, digits={name: 1, "error": 1})
    if document["best"]:
        at = {name: f" (the {which} allowed)" for name, which in document["at_bound"].items()}
        values = (f"{key} {value:.2f}{at.get(key, '')}" for key, value in document["best"].items())
        click.echo(f"recommended: {', '.join(values)}")
    click.echo(f"kept in {session.folder}")
    if document["verdict"]:
        for sentence in (document["verdict"], *document["ending"]):
            ui.print_wrapped(sentence)
        ui.print_wrapped(f"next: {_next_step(session)}")


def _print_front(document: dict[str, Any]) -> None:
    """Print the compromises, each value a posterior mean with its standard deviation."""
    from fdvv_people.optimize.run.front import front_mark, score_digits

    names = document["objectives"]
    rows = [
        [
            row["number"],
            front_mark(row) or "–",
            *((row["expected"][name], row["error"][name]) for name in names),
        ]
        for row in document["front"]
    ]
    digits = {name: score_digits(name) for name in names}
    ui.print_table(["trial", "compromise", *names], rows, left=2, digits=digits)


def _next_step(session: Optimization) -> str:
    from fdvv_people.optimize.run.ending import beaten_by
    from fdvv_people.optimize.run.verdict import verdict_kind

    if beaten := beaten_by(session):
        return f"take {beaten}; fdvv optimize report {session.folder} draws the designs"
    if verdict_kind(session) in ("better", "mixed"):
        return f"fdvv optimize report {session.folder} draws both designs"
    again = f"--trials {2 * session.setup.budget}"
    return f"keep {session.setup.start_name}, or search longer in a new folder with {again}"
