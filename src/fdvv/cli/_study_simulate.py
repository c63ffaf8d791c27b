"""fdvv study simulate."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli._output import counted, json_option, print_json, print_table, print_wrapped, progress
from fdvv.cli._study_power import proxy_settings, set_option

if TYPE_CHECKING:
    from fdvv.workflow import SimulatedStudy, Study


@click.command()
@click.argument("folder", type=click.Path(path_type=Path, exists=True, file_okay=False))
@click.option("--people", type=click.IntRange(1, 500), help="That are to be done; by default as planned.")
@click.option("--fast", is_flag=True, help="Press nothing: nothing is known of what was rendered then.")
@set_option
@click.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, show_default=True,
              help="Repeats the simulated participants.")  # fmt: skip
@json_option
def simulate(
    folder: Path, people: int | None, fast: bool, changes: tuple[str, ...], seed: int, as_json: bool
) -> None:
    """Run a whole frozen study with simulated participants: pages, trials, breaks, every answer kept.

    FOLDER is a study's that has no people. It tries the study out and its analysis, before anybody's time is
    spent; a study with simulated participants takes no people any more. What proxies answer is marked as
    simulated wherever it is kept or shown, and is never evidence.
    """
    from fdvv.workflow import Study, simulate_study

    settings = proxy_settings(changes)
    study = Study.open(folder)
    try:
        with progress("simulated people", 1) as tell:
            found = simulate_study(study, people, seed, not fast, settings, tell)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(
            f"interrupted; who was done is kept in {folder}, the same command goes on"
        ) from None
    if as_json:
        print_json({**asdict(found), "study": study.plan.name, "fingerprint": study.fingerprint})
        return
    _show(found, study)


def _show(found: SimulatedStudy, study: Study) -> None:
    click.echo(f"simulated: {study.plan.name}, {counted(len(found.finished), 'simulated participant')} done")
    if found.sessions:
        click.echo("")
        rows = [
            [one.person, str(one.trials), str(one.breaks), f"{one.minutes:.0f}"] for one in found.sessions
        ]
        print_table(["simulated", "trials", "breaks", "minutes"], rows)
        click.echo("")
    if not found.pressed:
        print_wrapped("Nothing was pressed: no force is known of any trial.")
    print_wrapped(f"Unseal the answers of the proxies with: fdvv study unseal {study.folder}")
