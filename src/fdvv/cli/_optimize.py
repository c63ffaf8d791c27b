"""fdvv optimize: run, resume, replay, report; experiment and population stand beside."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._optimize_experiment import experiment
from fdvv.cli._optimize_options import engine_option, level_option, rig_option
from fdvv.cli._optimize_population import add_population
from fdvv.cli._optimize_strip import Play, on_strip, strip_options
from fdvv.cli._output import (
    check_folder,
    check_output,
    counted,
    json_option,
    number,
    print_json,
    print_table,
    print_warnings,
    progress,
)

if TYPE_CHECKING:
    from fdvv.optimize import Trial
    from fdvv.workflow import OptimizeSession

LAST = 8
"""Trials that are printed; --json has all."""
folder_argument = click.argument("folder", type=click.Path(path_type=Path, exists=True, file_okay=False))


@click.group()
def optimize() -> None:
    """Find the button that makes a person perform best.

    Everything here is played by simulated people who press the twin; in the studio a person plays. FOLDER is
    that of a run: every trial is in it before anybody tries it, so a run may be killed at any moment.
    """


@optimize.command()
@click.option(
    "--folder", required=True, type=click.Path(path_type=Path), help="New or empty folder of the run."
)
@click.option(
    "--space",
    default="paper",
    show_default=True,
    help="Designs there are: paper, or a button whose numbers are varied: a built-in one or a file.",
)
@click.option(
    "--vary",
    multiple=True,
    default=("FDV",),
    show_default=True,
    help="Of a button: FDV, FDVV or single numbers; repeatable.",
)
@click.option(
    "--within",
    metavar="RIG",
    help="Only designs that this rig can render: a *.rig.json, or a shipped one's name.",
)
@click.option("--prior", type=click.Path(path_type=Path, exists=True, file_okay=False),
              help="Begin from what others did: a finished fdvv optimize population --grid.")  # fmt: skip
@click.option("--task", default="temporal-pointing", show_default=True, help="What is played.")
@level_option
@engine_option("gp")
@click.option("--trials", type=click.IntRange(1, 100_000), default=30, show_default=True,
              help="How many designs are tried.")  # fmt: skip
@click.option("--presses", type=click.IntRange(2, 1000), default=20, show_default=True, help="Of a trial.")
@click.option("--person", type=click.IntRange(min=0), default=0, show_default=True,
              help="Seed that the simulated person is drawn with.")  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of the run.")
@rig_option
@strip_options
@json_option
def run(folder: Path, strip: str | None, device: str, as_json: bool, **asked: Any) -> None:
    """Begin an optimisation and play it to its end, with a simulated person or on an LED strip.

    The same options give the same trials. Ctrl-C stops between two trials; fdvv optimize resume goes on.
    """
    from fdvv.workflow import begin_run

    check_folder(folder)
    wanted = _asked(strip=strip, **asked)
    with on_strip(strip, device) as play, begin_run(folder, wanted) as session:
        _play(session, play, as_json)


@optimize.command()
@folder_argument
@strip_options
@json_option
def resume(folder: Path, strip: str | None, device: str, as_json: bool) -> None:
    """Go on with the run in FOLDER that was stopped or killed; the next design is as if it had not been."""
    from fdvv.workflow import OptimizeSession

    with on_strip(strip, device) as play, OptimizeSession.open(folder) as session:
        _play(session, play, as_json)


@optimize.command()
@folder_argument
@json_option
def replay(folder: Path, as_json: bool) -> None:
    """Suggest every trial of a run anew from its seed, and tell whether each is the same.

    Exit status 1 if one is not: another version of a library, or a folder that was changed by hand.
    """
    from fdvv.workflow import OptimizeSession, replay_differences

    with OptimizeSession.open(folder) as session:
        engine, made = session.setup.engine, session.trials
    different = [trial.number for trial in replay_differences(folder)]
    suggested = sum(trial.origin == engine for trial in made)
    if as_json:
        print_json({"engine": engine, "suggested": suggested, "different": different, "same": not different})
    elif not different:
        click.echo(f"{engine} suggests {counted(suggested, 'trial')} again, each the same")
    if different:
        numbers = ", ".join(map(str, different))
        click.echo(f"fdvv: {folder}: {engine} now suggests otherwise at trial {numbers}", err=True)
        raise click.exceptions.Exit(1)


@optimize.command()
@folder_argument
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="The *.html to write; in the folder if none."
)
@json_option
def report(folder: Path, output: Path | None, as_json: bool) -> None:
    """Write the run in FOLDER as a page: the design found, the scores, every trial."""
    from fdvv.plot import write_report
    from fdvv.workflow import OptimizeSession, optimize_html, optimize_report

    check_output(output, ".html")
    path = output or folder / "report.html"
    with OptimizeSession.open(folder) as session:
        write_report(path, optimize_html(session))
        document = optimize_report(session)
    if as_json:
        print_json({**document, "report": str(path)})
    else:
        click.echo(f"written to {path}")


optimize.add_command(experiment)
add_population(optimize)


def _asked(
    engine: tuple[str, dict[str, Any]], trials: int, person: int, strip: str | None, **asked: Any
) -> Any:
    """Gather what is asked for; on a real strip a human plays."""
    from fdvv.workflow import POINTING, RunAsked

    if strip and asked["task"] != POINTING:
        raise click.UsageError(f"on a strip one plays {POINTING}, not {asked['task']}")
    name, options = engine
    simulated = person if strip in (None, "host") else None
    return RunAsked(engine=name, options=options, budget=trials, person=simulated, **asked)


def _play(session: OptimizeSession, play: Play | None, as_json: bool) -> None:
    """Play a run to its end and print it; on Ctrl-C say how to go on."""
    from fdvv.workflow import optimize_report, player_of

    print_warnings(session.warnings)
    budget = session.setup.budget
    with progress("trials", budget) as move:
        try:
            if play is None:
                player_of(session.setup).play(session, lambda trial: _told(trial, budget, move))
            else:
                for trial in play(session):
                    _told(trial, budget, move)
        except KeyboardInterrupt:
            kept = counted(len(session.trials), "trial")
            raise KeyboardInterrupt(
                f"stopped with {kept} kept; go on with: fdvv optimize resume {session.folder}"
            ) from None
    document = optimize_report(session)
    if as_json:
        print_json(document)
    else:
        _print(session, document)


def _told(trial: Trial, budget: int, move: Any) -> None:
    move(trial.number + 1, budget)
    if trial.reason:
        print_warnings([f"trial {trial.number} failed: {trial.reason}"])


def _print(session: OptimizeSession, document: dict[str, Any]) -> None:
    trials = document["trials"]
    about = f"{document['task']}, {document['level']}" if document["level"] else document["task"]
    told = " (simulated)" if document["simulated"] else ""
    click.echo(f"{about}{told}, engine {document['engine']}, {counted(len(trials), 'trial')}")
    rows = [
        [str(t["number"]), t["state"], number(t["score"], 1), number(t["error"], 1)] for t in trials[-LAST:]
    ]
    name = session.problem.objectives[0].name
    print_table(["trial", "state", name, "error"], rows, left=2)
    if document["best"]:
        told = ", ".join(f"{key} {value:.2f}" for key, value in document["best"].items())
        click.echo(f"recommended: {told}")
    click.echo(f"kept in {session.folder}")
