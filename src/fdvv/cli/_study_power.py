"""fdvv study power."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._output import (
    Finite,
    json_option,
    number,
    print_json,
    print_table,
    print_wrapped,
    stages,
)

if TYPE_CHECKING:
    from fdvv.study import Estimate, ProxySettings
    from fdvv.workflow import StudyPower

MOST_PEOPLE = 500


class PeopleRange(click.ParamType[tuple[int, ...]]):
    """A number of people, or a range of them: 12, 6-40."""

    name = "N|N-M"

    def convert(
        self, value: object, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, ...]:
        """Read it as the numbers that are meant."""
        if isinstance(value, tuple):
            return value
        found = re.fullmatch(r"(\d{1,4})(?:-(\d{1,4}))?", str(value).strip())
        low, high = (int(found[1]), int(found[2] or found[1])) if found else (0, 0)
        if not 2 <= low <= high <= MOST_PEOPLE:
            self.fail(f"{value!r} is no number of people from 2 to {MOST_PEOPLE}, as 12 or 6-40.", param, ctx)
        return tuple(range(low, high + 1))


set_option = click.option(
    "--set",
    "changes",
    multiple=True,
    metavar="NAME=VALUE",
    help="Change a constant of the proxies, as weber_ratio=0.15.",
)


@click.command()
@click.argument("file", type=click.Path(path_type=Path, exists=True))
@click.option("--people", type=PeopleRange(), default="6-40", show_default=True, help="In the study.")
@click.option(
    "--studies",
    type=click.IntRange(100, 100_000),
    default=2000,
    show_default=True,
    help="That are simulated; more make the intervals narrower.",
)
@click.option(
    "--difference",
    type=Finite(min=0, max=20),
    metavar="JND",
    help="Assume one difference for all buttons, in just noticeable differences, not what proxies feel.",
)
@set_option
@click.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, show_default=True,
              help="Repeats the simulated answers.")  # fmt: skip
@json_option
def power(
    file: Path,
    people: tuple[int, ...],
    studies: int,
    difference: float | None,
    changes: tuple[str, ...],
    seed: int,
    as_json: bool,
) -> None:
    """Tell how many people a study needs: the power of its claim, by simulated participants.

    FILE is a study's file, or its folder. The whole study is simulated many times, and the claim is tested in
    each as it will be in the real one. Proxies plan a study; what they say is never evidence.
    """
    from fdvv.workflow import study_power

    settings = proxy_settings(changes)
    with stages() as tell:
        found = study_power(file, people, studies, seed, settings, difference, tell)
    if as_json:
        print_json(found.to_dict())
        return
    _show(found)


def proxy_settings(changes: tuple[str, ...]) -> ProxySettings:
    """Give the proxies with their changes. Raises BadParameter on one that cannot be."""
    from fdvv.errors import ModelError
    from fdvv.study import ProxySettings

    settings = ProxySettings()
    for text in changes:
        name, _, value = text.partition("=")
        try:
            settings = settings.changed(name, float(value))
        except (ValueError, ModelError) as error:
            reason = error if isinstance(error, ModelError) else f"{text!r} is no NAME=VALUE with a number"
            raise click.BadParameter(str(reason), param_hint="--set") from None
    return settings


def _show(found: StudyPower) -> None:
    report = found.to_dict()
    claim = report["claim"]
    click.echo(f"simulated: {report['study']}, {claim['more']} above {claim['less']} in {claim['measure']}")
    print_wrapped(
        f"{report['studies']} simulated studies; test: {report['test']}, alpha {claim['alpha']:g}. Proxies "
        "plan a study and prove nothing."
    )
    if found.plan.kind == "preference":
        print_wrapped(f"Nobody knows what people like: the proxies are told that most like {claim['more']}.")
    click.echo("")
    _show_items(report, claim["more"], claim["less"])
    click.echo("")
    _show_rows(found)
    click.echo("")
    print_wrapped(f"For a power of 0.8 the proxies ask for {_asked(found)}; {found.plan.people} are planned.")


def _asked(found: StudyPower) -> str:
    """Tell how many people are enough, as far as the table tells it."""
    enough = found.table.enough()
    if enough is None:
        return "more people than that"
    return f"{enough} people" + (" at most" if enough == found.table.rows[0].people else "")


def _show_items(report: dict[str, Any], more: str, less: str) -> None:
    """Print how far the stimuli are apart, and what the proxies answer."""
    keys = ("total_JND", "force_JND", "speed_JND", "vibration_JND")
    words = ("right", "wrong") if report["kind"] == "abx" else (more, less)
    told = {"for": f"% {words[0]}", "equal": "% equal", "against": f"% {words[1]}"}
    shares = [key for key in told if report["items"][0][key] is not None]
    print_table(
        ["simulated", "JND", "force", "speed", "vibration", *(told[key] for key in shares)],
        [
            [one["item"], *(number(one[key]) for key in keys), *(_percent(one[key]) for key in shares)]
            for one in report["items"]
        ],
    )


def _show_rows(found: StudyPower) -> None:
    columns = ["people", "power", "95 %", "false: alike", "false: split", "found JND", "as % of answers"]
    print_table(
        columns,
        [
            [
                str(row.people),
                number(row.power.value),
                _interval(row.power),
                number(row.false_nothing.value, 3),
                number(row.false_split.value, 3),
                number(row.detectable_JND),
                _percent(row.detectable_share),
            ]
            for row in found.table.rows
        ],
    )
    print_wrapped(
        "false: claims where nobody feels a difference, or as many people lean each way. found: the smallest "
        "difference, alike on all buttons, with a power of 0.8."
    )


def _interval(of: Estimate) -> str:
    return f"{number(of.low)} to {number(of.high)}"


def _percent(share: float | None) -> str:
    return "–" if share is None or not math.isfinite(share) else f"{100 * share:.1f}"
