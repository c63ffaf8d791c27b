"""Options that the commands of fdvv optimize share."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from fdvv import extras
from fdvv.cli import ui
from fdvv.cli.options import remote

if TYPE_CHECKING:
    from fdvv_people.optimize.problem import Trial
    from fdvv_people.optimize.run.session import Optimization


strip_options = ui.options(
    ui.option(
        "--strip",
        metavar="DEVICE",
        help="LED strip that a person plays on: serial:PORT, or host (simulated).",
    ),
    ui.option("--device", default="host", help="With --strip: the rig that renders designs."),
)

Play = Callable[["Optimization"], "Iterator[Trial]"]


@contextmanager
def on_strip(strip: str | None, device: str) -> Iterator[Play | None]:
    """Open strip and rig before a run is begun; give what plays it there, None where no strip is asked for.

    InputError, DeviceError, BuildError.
    """
    if strip is None:
        yield None
        return
    present = extras.load("presenters", "strip")
    with remote(device) as rig, present(strip, rig, _wait) as play:
        yield play


def _wait(trial: Trial) -> None:
    click.prompt(f"trial {trial.number}: press Enter when ready", default="", show_default=False, err=True)


class EngineType(click.ParamType[tuple[str, dict[str, Any]]]):
    """An engine's name, with options in braces if there are any: gp, or 'gp:{"startup": 5}'."""

    name = "engine"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, dict[str, Any]]:
        if isinstance(value, tuple):
            return value
        name, _, text = str(value).partition(":")
        try:
            options = json.loads(text) if text else {}
        except ValueError as error:
            self.fail(f"the options of {name} are no JSON object ({error})", param, ctx)
        if not isinstance(options, dict):
            self.fail(f"the options of {name} are no JSON object", param, ctx)
        return name, options


ENGINE = "Suggests designs (docs/explanation/optimisation.md); name:{JSON} for options."
engine_option = ui.option("--engine", type=EngineType(), default="gp", help=ENGINE)
run_engine_option = ui.option(
    "--engine", type=EngineType(), help=f"{ENGINE} gp, or preference-line with --task preference."
)

level_option = ui.choice_option("--level", ("easy", "hard"), help="Of the task.")

group_option = ui.choice_option(
    "--group",
    ("paper", "diverse"),
    help="Of simulated people: as in the paper, or with best buttons that differ.",
)

ON_STRIP = ("lost_ratio",)
"""What a strip can score of --also: it measures no force and asks nothing."""

also_option = ui.option(
    "--also",
    multiple=True,
    type=click.Choice((*ON_STRIP, "effort_N_s", "liking")),
    help="Another wish beside the task's own; repeatable. The run ends with a front of compromises.",
)


class WeightType(click.ParamType[tuple[str, float]]):
    """An objective and how much it counts, as liking=2."""

    name = "objective=weight"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, float]:
        if isinstance(value, tuple):
            return value
        name, _, text = str(value).partition("=")
        try:
            return name, float(text)
        except ValueError:
            self.fail(f"{value}: write an objective and a number, as liking=2", param, ctx)


weight_option = ui.option(
    "--weight",
    "weights",
    multiple=True,
    type=WeightType(),
    help="How much a wish counts for the recommended compromise, as liking=2; repeatable. None: the knee.",
)

rig_option = ui.option(
    "--rig", default="ideal", help="Shipped rig that renders designs; ideal does so exactly."
)
