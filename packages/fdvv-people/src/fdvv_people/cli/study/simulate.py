"""fdvv study simulate."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import kept_on_interrupt
from fdvv.errors import ModelError

if TYPE_CHECKING:
    from fdvv_people.study.simulation.people import ProxySettings
    from fdvv_people.study.simulation.study_power import StudyPower

MOST_PEOPLE = 500
FORMATS = {"minutes": ".0f", "days": ".1f"}
"""Of the columns of what simulated participants did."""


class PeopleRange(click.ParamType[tuple[int, ...]]):
    """A number of people, or a range of them: 12, 6-40."""

    name = "N|N-M"

    def convert(
        self, value: object, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, ...]:
        if isinstance(value, tuple):
            return value
        found = re.fullmatch(r"(\d{1,4})(?:-(\d{1,4}))?", str(value).strip())
        low, high = (int(found[1]), int(found[2] or found[1])) if found else (0, 0)
        if not 2 <= low <= high <= MOST_PEOPLE:
            self.fail(f"{value!r} is no number of people from 2 to {MOST_PEOPLE}, as 12 or 6-40.", param, ctx)
        return tuple(range(low, high + 1))


set_option = ui.option(
    "--set",
    "changes",
    multiple=True,
    metavar="NAME=VALUE",
    help="A constant of the proxies, as weber_ratio=0.15.",
)


@click.command()
@click.argument("file", type=ui.EXISTING)
@ui.option("--people", type=PeopleRange(), default="6-40", help="In the study.")
@ui.option(
    "--studies", type=click.IntRange(100, 100_000), default=2000, help="More make the intervals narrower."
)
@ui.option(
    "--difference",
    type=ui.Finite(min=0, max=20),
    metavar="JND",
    help="Assume one difference for all buttons, in just noticeable differences, not what proxies feel.",
)
@set_option
@ui.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, help="Repeats the simulated answers.")
@ui.json_option
def power(
    file: Path, difference: float | None, changes: tuple[str, ...], as_json: bool, **options: Any
) -> None:
    """Estimate how many people a study needs: the power of its claim, by simulated participants.

    FILE is a study's file, or its folder. The whole study is simulated many times, and the claim is tested in
    each as it will be in the real one. Proxies plan a study; what they say is never evidence.
    """
    from fdvv_people.study.kind import kind_of
    from fdvv_people.study.simulation.study_power import study_power

    kind_of(file).require("power", file)
    settings = proxy_settings(changes)
    with ui.stages() as tell:
        found = study_power(file, **options, settings=settings, given_JND=difference, progress=tell)
    if as_json:
        ui.print_json(found.to_dict())
        return
    _show_power(found)


def proxy_settings(changes: tuple[str, ...]) -> ProxySettings:
    """Return the proxies with their changes. Raises BadParameter on one that cannot be."""
    from fdvv_people.study.simulation.people import ProxySettings

    settings = ProxySettings()
    for text in changes:
        name, _, value = text.partition("=")
        try:
            settings = settings.changed(name, float(value))
        except (ValueError, ModelError) as error:
            reason = error if isinstance(error, ModelError) else f"{text!r} is no NAME=VALUE with a number"
            raise click.BadParameter(str(reason), param_hint="--set") from None
    return settings


def _show_power(found: StudyPower) -> None:
    report = found.to_dict()
    claim = report["claim"]
    click.echo(f"simulated: {report['study']}, {claim['more']} above {claim['less']} in {claim['measure']}")
    ui.print_wrapped(
        f"{report['studies']} simulated studies; test: {report['test']}, alpha {claim['alpha']:g}. Proxies "
        "plan a study and prove nothing."
    )
    if found.plan.kind == "preference":
        ui.print_wrapped(f"Nobody knows what people like: the proxies assume that most like {claim['more']}.")
    click.echo("")
    _show_items(report, claim["more"], claim["less"])
    click.echo("")
    _show_rows(found)
    click.echo("")
    enough = found.table.enough()
    needed = "more people than that" if enough is None else f"{enough} people"
    # fewer than the first number of people were not tried
    most = " at most" if enough == found.table.rows[0].people else ""
    ui.print_wrapped(
        f"For a power of 0.8 the proxies ask for {needed}{most}; {found.plan.people} are planned."
    )


def _show_items(report: dict[str, Any], more: str, less: str) -> None:
    from fdvv_people.study.plan.tasks import task_of

    keys = ("total_JND", "force_JND", "speed_JND", "vibration_JND")
    words = (more, less) if task_of(report["kind"]).names_stimulus else ("right", "wrong")
    headings = {"for": f"% {words[0]}", "equal": "% equal", "against": f"% {words[1]}"}
    shares = [key for key in headings if report["items"][0][key] is not None]
    ui.print_table(
        ["simulated", "JND", "force", "speed", "vibration", *(headings[key] for key in shares)],
        [
            [one["item"], *(one[key] for key in keys), *(_percent(one[key]) for key in shares)]
            for one in report["items"]
        ],
    )


def _show_rows(found: StudyPower) -> None:
    columns = ["people", "power", "95 %", "false: alike", "false: split", "found JND", "as % of answers"]
    ui.print_table(
        columns,
        [
            [
                *(row.people, row.power.value, f"{ui.number(row.power.low)} to {ui.number(row.power.high)}"),
                *(row.false_nothing.value, row.false_split.value),
                *(row.detectable_JND, _percent(row.detectable_share)),
            ]
            for row in found.table.rows
        ],
        digits={"false: alike": 3, "false: split": 3},
    )
    ui.print_wrapped(
        "false: claims where nobody feels a difference, or as many people lean each way. found: the smallest "
        "difference, alike on all buttons, with a power of 0.8."
    )


def _percent(share: float | None) -> str:
    return "–" if share is None or not math.isfinite(share) else f"{100 * share:.1f}"


@click.command()
@click.argument("folder", type=ui.FOLDER)
@ui.option("--people", type=click.IntRange(1, 500), help="That are to be done; by default as planned.")
@ui.option("--fast", is_flag=True, help="Press nothing: nothing is known of what was rendered then.")
@set_option
@ui.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, help="Repeats the simulated participants.")
@ui.json_option
def simulate(
    folder: Path, people: int | None, fast: bool, changes: tuple[str, ...], seed: int, as_json: bool
) -> None:
    """Run a whole frozen study with simulated participants: pages, trials, breaks, every answer kept.

    FOLDER is a study's that has no people. It tries the study out and its analysis, before anybody's time is
    spent; a study with simulated participants takes no people any more. What proxies answer is marked as
    simulated wherever it is kept or shown, and is never evidence. Of a timing study they train, come back
    after the gap and press every button on the twin; --fast and --set are for the other kinds.
    """
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.simulation.sessions import Simulation, simulate_study

    simulation = Simulation(seed, proxy_settings(changes), not fast)
    study = Study.open(folder)
    kept = f"interrupted; who was done is kept in {folder}, the same command goes on"
    with kept_on_interrupt(kept), ui.progress("simulated people", 1) as tell:
        found = simulate_study(study, people, simulation, tell)
    rows = [study.kind.session_row(session) for session in found.sessions]
    if as_json:
        pressed = {"pressed": not fast} if study.kind.feels else {}
        about = {**pressed, "simulated": True, "study": study.plan.name, "fingerprint": study.fingerprint}
        ui.print_json({"sessions": rows, "finished": found.finished, **about})
        return
    click.echo(
        f"simulated: {study.plan.name}, {ui.counted(len(found.finished), 'simulated participant')} done"
    )
    _show_sessions(rows)
    if fast and study.kind.feels:
        ui.print_wrapped("Nothing was pressed: no force is known of any trial.")
    ui.print_wrapped(f"Unseal the {study.kind.proxy_data} with: fdvv study unseal {study.folder}")


def _show_sessions(rows: Sequence[Mapping[str, object]]) -> None:
    if rows:
        columns = ["simulated", *list(rows[0])[1:]]
        click.echo("")
        ui.print_table(
            columns, [[format(cell, FORMATS.get(name, "")) for name, cell in row.items()] for row in rows]
        )
        click.echo("")
