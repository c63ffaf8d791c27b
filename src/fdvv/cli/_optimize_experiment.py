"""fdvv optimize experiment: training, a week, validation, and the statistics of it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._optimize_options import engine_option, rig_option
from fdvv.cli._output import (
    check_folder,
    counted,
    json_option,
    number,
    print_json,
    print_table,
    print_warnings,
    print_wrapped,
    stages,
)

if TYPE_CHECKING:
    from fdvv.workflow import ExperimentResult, RenderedWinner, Stage

P_COLUMNS = ("p", "holm_p", "bonferroni_p")
REPORT, MODEL, RESULT = "report.html", "winner.fdvv.json", "result.json"


@click.command()
@click.option("--folder", required=True, type=click.Path(path_type=Path),
              help="Folder of the experiment; name it again to go on where it stopped.")  # fmt: skip
@click.option("--people", type=click.IntRange(3, 1000), default=10, show_default=True,
              help="How many simulated people take part.")  # fmt: skip
@click.option("--trials", type=click.IntRange(1, 1000), default=27, show_default=True, help="Of a training.")
@click.option("--presses", type=click.IntRange(2, 1000), default=20, show_default=True, help="Of a trial.")
@click.option("--rounds", type=click.IntRange(1, 20), default=2, show_default=True,
              help="How often each button appears per level.")  # fmt: skip
@engine_option("gp")
@click.option("--prior", "priors", multiple=True,
              type=click.Path(path_type=Path, exists=True, file_okay=False),
              help="Begin every training from what others did: a finished fdvv optimize population --grid; "
              "give it twice, one of each level.")  # fmt: skip
@rig_option
@click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of everything random."
)
@click.option("--processes", type=click.IntRange(1, 256), help="All processors by default; same results.")
@click.option("--winner/--no-winner", default=True, show_default=True,
              help="Render the winning design on a simulated rig and capture it as a model.")  # fmt: skip
@json_option
def experiment(
    folder: Path, engine: tuple[str, dict[str, Any]], priors: tuple[Path, ...], processes: int | None,
    winner: bool, as_json: bool, **asked: Any,
) -> None:  # fmt: skip
    """Run the paper's whole experiment on simulated people.

    Everybody trains at both levels; a week later the design found meets four MX switches and a random design
    in counter-balanced order. The folder then holds every trial, report.html, result.json and, with --winner,
    winner.fdvv.json. Ctrl-C or a kill loses no finished trial; the same command goes on.
    """
    check_folder(folder)
    from fdvv.workflow import (
        ExperimentSetup,
        experiment_prior,
        judge_experiment,
        open_executor,
        run_experiment,
        write_experiment,
    )

    begun_s = time.perf_counter()
    prior = experiment_prior(priors, asked["seed"])
    setup = ExperimentSetup(engine=engine[0], options=engine[1], prior=prior, **asked)
    with stages() as stage, _kept(folder), open_executor(processes) as executor:
        result = run_experiment(folder, setup, executor, stage)
        rendered = _rendered(result, folder, stage) if winner else None
        stage("report", 0, 1)
        document = write_experiment(folder, result, judge_experiment(result), rendered)
        stage("report", 1, 1)
    if as_json:
        print_json(document)
    else:
        _print(document, folder, time.perf_counter() - begun_s)


@contextmanager
def _kept(folder: Path) -> Iterator[None]:
    """Say on Ctrl-C how to go on."""
    try:
        yield
    except KeyboardInterrupt:
        told = f"stopped; every finished trial is in {folder}, the same command goes on"
        raise KeyboardInterrupt(told) from None


def _rendered(result: ExperimentResult, folder: Path, stage: Stage) -> RenderedWinner | None:
    """Render the winner on its rig and keep what was captured; tell why if no rig can."""
    from fdvv.errors import DeviceError
    from fdvv.model import save_model
    from fdvv.workflow import render_best

    stage("winner", 0, 1)
    try:
        found = render_best(result)
    except DeviceError as error:
        print_warnings([str(error)])
        return None
    save_model(found.captured.model, folder / MODEL)
    stage("winner", 1, 1)
    return found


def _print(document: dict[str, Any], folder: Path, time_s: float) -> None:
    """Print means, effects and the pairs of the optimised button."""
    statistics = document["statistics"]
    count = counted(len(document["observations"]), "observation")
    click.echo(f"{count} of {document['people']} simulated people, engine {document['engine']}")
    rows = [
        [one["button"], one["level"], *(number(one[k], 1) for k in ("mean_ms", "people_sd_ms"))]
        for one in statistics["means"]
    ]
    print_table(["button", "level", "mean ms", "SD ms"], rows, left=2)
    for effect in statistics["anova"]["effects"]:
        print_wrapped(effect_line(effect))
    rows = [
        [
            one["second"],
            number(one["difference"]["value"], 1),
            *(_p(one[k]) for k in ("p", "holm_p", "bonferroni_p")),
        ]
        for one in statistics["pairs"]
        if one["first"] == "optimal"
    ]
    print_table(["optimal minus", "ms", "p", "Holm", "Bonferroni"], rows)
    click.echo(f"simulated; kept in {folder} ({REPORT}, {RESULT}), {time_s:.0f} s")


def effect_line(effect: dict[str, Any]) -> str:
    """Write one effect of the analysis of variance, corrected."""
    df = ", ".join(number(effect[key], 2) for key in ("corrected_effect_df", "corrected_error_df"))
    told = f"F({df}) = {effect['F']:.2f}, p {_p(effect['corrected_p'])}"
    return f"{effect['name']}: {told}, generalized eta2 {effect['generalized_eta2']:.3f}"


def _p(p: float) -> str:
    return "< .001" if p < 0.001 else f"{p:.3f}"
