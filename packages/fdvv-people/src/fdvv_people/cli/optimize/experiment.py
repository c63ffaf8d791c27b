"""fdvv optimize experiment: training, a week, validation, and the statistics of it."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import kept_on_interrupt
from fdvv.errors import DeviceError
from fdvv_people.cli.optimize.options import engine_option, rig_option

if TYPE_CHECKING:
    from fdvv_people.optimize.experiment.experiment import ExperimentResult, Stage
    from fdvv_people.optimize.experiment.winner import RenderedWinner


@click.command()
@ui.option(
    "--folder",
    required=True,
    type=ui.PATH,
    help="Folder of the experiment; name it again to go on where it stopped.",
)
@ui.option("--people", type=click.IntRange(3, 1000), default=10, help="How many simulated people take part.")
@ui.option("--trials", type=click.IntRange(1, 1000), default=27, help="Of a training.")
@ui.option("--presses", type=click.IntRange(2, 1000), default=20, help="Of a trial.")
@ui.option("--rounds", type=click.IntRange(1, 20), default=2, help="How often each button appears per level.")
@engine_option
@ui.option(
    "--prior",
    "priors",
    multiple=True,
    type=ui.FOLDER,
    help="Begin every training from what others did: a finished fdvv optimize population --grid; "
    "give it twice, one of each level.",
)
@rig_option
@ui.option("--seed", type=ui.COUNT, default=0, help="Of everything random.")
@ui.option("--processes", type=click.IntRange(1, 256), help="All processors by default; same results.")
@ui.option(
    "--winner/--no-winner",
    default=True,
    help="Render the winning design on a simulated rig and capture it as a model.",
)
@ui.json_option
def experiment(
    folder: Path, engine: tuple[str, dict[str, Any]], priors: tuple[Path, ...], processes: int | None,
    winner: bool, as_json: bool, **options: Any,
) -> None:  # fmt: skip
    """Run the paper's whole experiment on simulated people.

    Everybody trains at both levels; a week later the design found meets four MX switches and a random design
    in counter-balanced order. The folder then holds every trial, report.html, result.json and, with --winner,
    winner.fdvv.json. Ctrl-C or a kill loses no finished trial; the same command goes on.
    """
    from fdvv.parallel.open import open_executor
    from fdvv_people.optimize.experiment.experiment import judge_experiment, run_experiment
    from fdvv_people.optimize.experiment.html import write_experiment
    from fdvv_people.optimize.experiment.setup import ExperimentSetup
    from fdvv_people.optimize.run.begin import experiment_prior

    ui.check_folder(folder)
    begun_s = time.perf_counter()
    prior = experiment_prior(priors, options["seed"])
    setup = ExperimentSetup(engine=engine[0], options=engine[1], prior=prior, **options)
    kept = f"stopped; every finished trial is in {folder}, the same command goes on"
    with ui.stages() as stage, kept_on_interrupt(kept), open_executor(processes) as executor:
        result = run_experiment(folder, setup, executor, stage)
        rendered = _rendered(result, folder, stage) if winner else None
        stage("report", 0, 1)
        document = write_experiment(folder, result, judge_experiment(result), rendered)
        stage("report", 1, 1)
    if as_json:
        ui.print_json(document)
    else:
        _print(document, folder, time.perf_counter() - begun_s)


def _rendered(result: ExperimentResult, folder: Path, stage: Stage) -> RenderedWinner | None:
    from fdvv.model.file import save_model
    from fdvv_people.optimize.experiment.winner import render_best

    stage("winner", 0, 1)
    try:
        found = render_best(result)
    except DeviceError as error:
        ui.print_warnings([str(error)])
        return None
    save_model(found.captured.model, folder / "winner.fdvv.json")
    stage("winner", 1, 1)
    return found


def _print(document: dict[str, Any], folder: Path, time_s: float) -> None:
    statistics = document["statistics"]
    count = ui.counted(len(document["observations"]), "observation")
    click.echo(f"{count} of {document['people']} simulated people, engine {document['engine']}")
    means = [[one[k] for k in ("button", "level", "mean_ms", "people_sd_ms")] for one in statistics["means"]]
    ui.print_table(["button", "level", "mean ms", "SD ms"], means, left=2, digits={"mean ms": 1, "SD ms": 1})
    for effect in statistics["anova"]["effects"]:
        ui.print_wrapped(effect_line(effect))
    rows = [
        [one["second"], one["difference"]["value"], *(_p(one[k]) for k in ("p", "holm_p", "bonferroni_p"))]
        for one in statistics["pairs"]
        if one["first"] == "optimal"
    ]
    ui.print_table(["optimal minus", "ms", "p", "Holm", "Bonferroni"], rows, digits={"ms": 1})
    click.echo(f"simulated; kept in {folder} (report.html, result.json), {time_s:.0f} s")


def effect_line(effect: dict[str, Any]) -> str:
    """Write one effect of the analysis of variance, corrected."""
    df = ", ".join(ui.number(effect[key], 2) for key in ("corrected_effect_df", "corrected_error_df"))
    test = f"F({df}) = {effect['F']:.2f}, p {_p(effect['corrected_p'])}"
    return f"{effect['name']}: {test}, generalized eta2 {effect['generalized_eta2']:.3f}"


def _p(p: float) -> str:
    return "< .001" if p < 0.001 else f"{p:.3f}"
