"""fdvv optimize population."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.cli.options import Workers, executor_options
from fdvv_people.cli.optimize.options import group_option


@click.command()
@click.argument("folder", type=ui.PATH)
@ui.option("--people", type=click.IntRange(1, 1_000_000), default=100, help="How many are simulated.")
@ui.choice_option("--level", ("easy", "hard"), help="How fast the bullet is.")
@ui.option("--engine", default="gp", help="Of every person's run.")
@ui.option("--budget", type=click.IntRange(1, 1000), default=30, help="Trials of each person.")
@ui.option(
    "--grid", type=click.IntRange(1, 100_000), help="Score a grid of so many designs instead of optimising."
)
@ui.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, help="Of people, engines and presses.")
@group_option
@ui.option("--buttons", is_flag=True, help="Only designs that are buttons.")
@ui.option("--shift", "shifts", multiple=True, metavar="NAME=RATIO", help="Other people, as pace_mm_s=1.3.")
@ui.option("--rig", default="ideal", help="Shipped rig that is pressed.")
@ui.option(
    "--prior", type=ui.FOLDER, help="Finished --grid run of other people that every engine begins from."
)
@executor_options
@ui.json_option
def population(
    folder: Path, grid: int | None, prior: Path | None, where: Workers, as_json: bool, **options: Any
) -> None:
    """Optimise a button for every one of many simulated people, or score a grid of designs by all.

    FOLDER keeps every part that is done: whatever ended the run, the same command goes on with it. The result
    is the same however many processes work on it. Everything is simulated.
    """
    from fdvv_people.optimize.population.population import run_population
    from fdvv_people.optimize.run.begin import read_grid

    plan = _plan(grid=grid, **options)
    trials = read_grid(prior).prior() if prior else ()
    label = "people" if grid is None else "grid"
    with where.at_work(folder, label, plan.chunks) as (executor, tell):
        result = run_population(folder, plan, executor, trials, tell)
    _show(result.summary(), folder, as_json)


def _plan(grid: int | None, level: str, engine: str, shifts: tuple[str, ...], **options: Any) -> Any:
    from fdvv_people.optimize.engines.registry import check_engine, engine_of
    from fdvv_people.optimize.paper_space import paper_model, paper_space
    from fdvv_people.optimize.people.simulate import simulate_task
    from fdvv_people.optimize.population.plan import PopulationPlan
    from fdvv_people.optimize.run.player import POINTING
    from fdvv_people.task.pointing import TemporalPointing

    check_engine(engine, POINTING)
    engine_of(engine)
    found = PopulationPlan(
        kind="optimize" if grid is None else "grid",
        shifts=dict(_shift(text) for text in shifts),
        level="easy" if level == "easy" else "hard",
        engine=engine,
        designs=grid or 1,
        **options,
    )
    # one round by one person refuses a rig or a shift that cannot be, before hundreds are begun
    middle = paper_model(paper_space().of_unit([[0.5] * 8])[0])
    simulate_task(TemporalPointing(level, rounds=1), middle, found.user(0), found.seed, rig=found.rig)
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
        ui.print_json(summary)
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
        [name, *(f"{summary[key][part]:.1f}" for part in ("median", "low", "high"))]
        for key, name in names.items()
        if key in summary
    ]
    ui.print_table(["simulated", "median", "5 %", "95 %"], rows)
