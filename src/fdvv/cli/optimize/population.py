"""fdvv optimize population."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli._executor_options import check_executor, executor_options, kept_on_interrupt
from fdvv.cli._output import json_option, print_json, print_table, progress


def add_population(group: click.Group) -> None:
    """Add the command to `fdvv optimize`."""
    group.add_command(population)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--people", type=click.IntRange(1, 1_000_000), default=100, show_default=True,
              help="How many are simulated.")  # fmt: skip
@click.option("--level", type=click.Choice(["easy", "hard"]), default="easy", show_default=True,
              help="How fast the bullet is.")  # fmt: skip
@click.option("--engine", default="gp", show_default=True, help="Of every person's run.")
@click.option(
    "--budget", type=click.IntRange(1, 1000), default=30, show_default=True, help="Trials of each person."
)
@click.option(
    "--grid",
    type=click.IntRange(1, 100_000),
    help="No runs: everybody scores so many designs of an even net.",
)
@click.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, show_default=True,
              help="Of people, engines and presses.")  # fmt: skip
@click.option(
    "--shift", "shifts", multiple=True, metavar="NAME=RATIO", help="Other people, as pace_mm_s=1.3."
)
@click.option("--rig", default="ideal", show_default=True, help="Shipped rig that is pressed.")
@click.option(
    "--prior",
    type=click.Path(path_type=Path, exists=True, file_okay=False),
    help="Finished --grid run of other people that every engine begins from.",
)
@executor_options
@json_option
def population(
    folder: Path,
    people: int,
    level: str,
    engine: str,
    budget: int,
    grid: int | None,
    seed: int,
    shifts: tuple[str, ...],
    rig: str,
    prior: Path | None,
    processes: int | None,
    workers: int | None,
    cluster: str | None,
    as_json: bool,
) -> None:
    """Optimise a button for every one of many simulated people, or score a grid of designs by all.

    FOLDER keeps every part that is done: whatever ended the run, the same command goes on with it. The result
    is the same however many processes work on it. Everything is simulated.
    """
    from fdvv.workflow import open_executor, read_grid, run_population

    check_executor(processes, workers, cluster)
    plan = _plan(people, level, engine, budget, grid, seed, shifts, rig)
    trials = read_grid(prior).prior() if prior else ()
    with (
        kept_on_interrupt(folder),
        open_executor(processes, workers, cluster) as executor,
        progress("people" if grid is None else "grid", plan.chunks) as tell,
    ):
        result = run_population(folder, plan, executor, trials, tell)
    _show(result.summary(), folder, as_json)


def _plan(
    people: int, level: str, engine: str, budget: int, grid: int | None, seed: int,
    shifts: tuple[str, ...], rig: str,
) -> Any:  # fmt: skip
    """Make the plan, and refuse at once what no process could work on."""
    from fdvv.optimize import TemporalPointing, engine_of, paper_model, paper_space
    from fdvv.workflow import PopulationPlan, play

    engine_of(engine)
    found = PopulationPlan(
        kind="optimize" if grid is None else "grid",
        people=people,
        seed=seed,
        shifts=dict(_shift(text) for text in shifts),
        level="easy" if level == "easy" else "hard",
        rig=rig,
        engine=engine,
        budget=budget,
        designs=grid or 1,
    )
    middle = paper_model(paper_space().of_unit([[0.5] * 8])[0])
    play(TemporalPointing(level, rounds=1), middle, found.user(0), seed, rig=rig)
    return found


def _shift(text: str) -> tuple[str, float]:
    name, _, ratio = text.partition("=")
    try:
        value = float(ratio)
    except ValueError:
        value = 0.0
    if not 0 < value <= 100:
        raise click.BadParameter(f"{text!r} is no NAME=RATIO with a ratio above 0", param_hint="--shift")
    return name, value


def _show(summary: dict[str, Any], folder: Path, as_json: bool) -> None:
    if as_json:
        print_json(summary)
        return
    plan = summary["plan"]
    click.echo(f"{plan['people']} simulated people, {plan['level']}: {folder}")
    names = {
        "judged_ms": "asynchrony ms",
        "against_ms": f"of {plan['against']} ms",
        "gain_percent": "gain %",
        "mean_ms": "mean of a design ms",
    }
    rows = [
        [names[key], *(f"{summary[key][part]:.1f}" for part in ("median", "low", "high"))]
        for key in names
        if key in summary
    ]
    print_table(["simulated", "median", "5 %", "95 %"], rows)
