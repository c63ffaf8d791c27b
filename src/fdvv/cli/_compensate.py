"""fdvv compensate and probe."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fdvv.cli._output import (
    Finite,
    check_output,
    counted,
    json_option,
    number,
    print_json,
    print_table,
    print_warnings,
    print_wrapped,
    progress,
)

if TYPE_CHECKING:
    from fdvv.workflow import PressDone

Command = TypeVar("Command", bound=Callable[..., Any])


def device_options(command: Command) -> Command:
    """Add the options that choose a device and the speeds."""
    path = click.Path(path_type=Path, exists=True, dir_okay=False)
    options = (
        click.option("--device", default="twin", show_default=True, help="'twin' is simulated."),
        click.option("--rig", type=path, help="TOML file of the twin's rig (docs/reference/rig.md)."),
        click.option("--finger", type=path, help="TOML file of the twin's finger."),
        click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
                     help="Repeats the twin."),
        click.option("--velocity", "velocities_mm_s", type=Finite(min=5, max=500), multiple=True,
                     default=(50.0, 100.0, 150.0, 200.0), show_default=True, help="mm/s; repeatable."),
    )  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


@click.command()
@click.argument("button")
@device_options
@click.option("--rounds", type=click.IntRange(1, 20), default=4, show_default=True, help="Runs averaged.")
@click.option(
    "--presses", type=click.IntRange(1, 100), default=12, show_default=True, help="Per round and velocity."
)
@click.option("--literal", is_flag=True, help="The law exactly as printed, without additions.")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The *.actuation.json to write.")
@json_option
def compensate(
    button: str,
    device: str,
    rig: Path | None,
    finger: Path | None,
    seed: int,
    velocities_mm_s: tuple[float, ...],
    rounds: int,
    presses: int,
    literal: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Learn the actuation that makes a rig feel like a model.

    BUTTON is a built-in, a *.fdvv.json file or a measured file. The paper's iterative law presses until
    its rounds are done; its errors are those the rig measured while it learned. Judge with fdvv probe.
    """
    check_output(output, ".actuation.json")
    from fdvv.compensate import PaperLaw
    from fdvv.workflow import compensate as learn
    from fdvv.workflow import open_device, open_model, save_actuation

    make = PaperLaw.literal if literal else PaperLaw
    law = make(rounds=rounds, presses_per_round=presses)
    with progress("pressing", 1) as advance:
        result = learn(
            open_device(device, rig, finger, seed),
            open_model(button),
            velocities_mm_s,
            law,
            progress=_bar(advance),
        )
    if output:
        save_actuation(result, output)
    _print(result.to_dict(), as_json)
    if output and not as_json:
        click.echo(f"written to {output}")


@click.command()
@click.argument("button")
@click.argument("actuation", required=False, type=click.Path(path_type=Path, exists=True, dir_okay=False))
@device_options
@click.option("--presses", type=click.IntRange(1, 200), default=10, show_default=True, help="Per velocity.")
@click.option(
    "--max-mean-error-cN", "bound_cN", type=Finite(min=0),
    help="Exit with status 1 if a curve's mean error exceeds this.",
)  # fmt: skip
@json_option
def probe(
    button: str,
    actuation: Path | None,
    device: str,
    rig: Path | None,
    finger: Path | None,
    seed: int,
    velocities_mm_s: tuple[float, ...],
    presses: int,
    bound_cN: float | None,
    as_json: bool,
) -> None:
    """Measure on fresh presses how well a rig renders a model.

    BUTTON is what should be felt; ACTUATION the file that fdvv compensate wrote (without it what
    learning starts from: the model's own force). Errors are in true displacement, median over the
    presses. Use another --seed than for learning.
    """
    from fdvv.workflow import load_actuation, open_device, open_model, uncompensated
    from fdvv.workflow import probe as judge

    model = open_model(button)
    learned = load_actuation(actuation) if actuation else None
    rendering = open_device(device, rig, finger, seed)
    surface = learned.surface if learned else uncompensated(rendering, model, velocities_mm_s)
    method = learned.method if learned else "not compensated"
    if learned and learned.model_name != model.name:
        print_warnings([f"{actuation} was learned for {learned.model_name}, not for {model.name}"])
    with progress("probing", 1) as advance:
        result = judge(
            rendering,
            model,
            surface,
            velocities_mm_s,
            presses,
            _bar(advance),
            method,
        )
    document = result.to_dict()
    _print(document, as_json)
    worst = max(document["curves"], key=lambda c: c["mean_error_cN"])
    if bound_cN is not None and worst["mean_error_cN"] > bound_cN:
        reason = f"mean error of {worst['mean_error_cN']:.2f} cN exceeds the bound of {bound_cN:g} cN"
        click.echo(f"fdvv: {_curve_name(worst)}: {reason}", err=True)
        raise click.exceptions.Exit(1)


def _bar(advance: Callable[[int, int], None]) -> Callable[[PressDone], None]:
    """Turn presses into steps of a progress bar."""
    return lambda event: advance(event.presses_done, event.presses_total)


def _print(document: dict[str, Any], as_json: bool) -> None:
    """Print a report of errors per curve."""
    if as_json:
        print_json(document)
        return
    told = " (simulated)" if document["simulated"] else ""
    on = f"{document['model']} on {document['device']}{told}"
    click.echo(f"{on}, {counted(document['presses'], 'press')}")
    print_wrapped(f"method: {document['method']}")
    print_table(
        ["curve", "first cN", "last cN", "mean cN", "max cN"],
        [
            [
                _curve_name(c),
                *(
                    number(e)
                    for e in ((c["error_cN"][0], c["error_cN"][-1]) if c["error_cN"] else (None, None))
                ),
                number(c["mean_error_cN"]),
                number(c["max_error_cN"]),
            ]
            for c in document["curves"]
        ],
    )
    if document["skipped"]:
        count, last = counted(len(document["skipped"]), "press"), document["skipped"][-1]
        print_warnings([f"{count} skipped; the last: {last}"])


def _curve_name(curve: dict[str, Any]) -> str:
    return f"{curve['stroke']} {curve['velocity_mm_s']:g} mm/s"
