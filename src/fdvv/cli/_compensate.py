"""fdvv compensate and probe."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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
)
from fdvv.cli._session_options import beside, guided, open_session, session_options


@click.command()
@click.argument("button")
@session_options
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
    folder: Path | None,
    pace_ratio: float,
    rounds: int,
    presses: int,
    literal: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Learn the actuation that makes a rig feel like a model.

    BUTTON is a built-in, a *.fdvv.json file or a measured file. The paper's iterative law presses until
    its rounds are done; its errors are those the rig measured while it learned. Judge with fdvv probe.

    Ctrl-C stops the device; the same command goes on with a session where it stopped. A press that cannot
    be used, because it stopped short, paused or missed its speed, is told with the reason and made again.
    """
    check_output(output, ".actuation.json")
    from fdvv.compensate import PaperLaw
    from fdvv.workflow import compensate as learn
    from fdvv.workflow import open_model, save_actuation

    make = PaperLaw.literal if literal else PaperLaw
    law = make(rounds=rounds, presses_per_round=presses)
    model = open_model(button)
    default = beside(output, button, "session")
    session = open_session(folder, device, (seed, rig, finger), pace_ratio, default)
    with guided(session, device, as_json) as (found, view, guide):
        result = learn(found, model, velocities_mm_s, law, view.done, session, guide)
    if output:
        save_actuation(result, output)
    _print({**result.to_dict(), **_receipt(result)}, as_json)
    if output and not as_json:
        click.echo(f"written to {output}")


@click.command()
@click.argument("button")
@click.argument("actuation", required=False, type=click.Path(path_type=Path, exists=True, dir_okay=False))
@session_options
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
    folder: Path | None,
    pace_ratio: float,
    presses: int,
    bound_cN: float | None,
    as_json: bool,
) -> None:
    """Measure on fresh presses how well a rig renders a model.

    BUTTON is what should be felt; ACTUATION the file that fdvv compensate wrote (without it what
    learning starts from: the model's own force). Errors are in true displacement, median over the
    presses. Use another --seed than for learning.
    """
    from fdvv.compensate import Tuning
    from fdvv.workflow import load_actuation, open_model, uncompensated
    from fdvv.workflow import probe as judge

    model = open_model(button)
    learned = load_actuation(actuation) if actuation else None
    method = learned.method if learned else "not compensated"
    if learned and learned.model_name != model.name:
        print_warnings([f"{actuation} was learned for {learned.model_name}, not for {model.name}"])
    default = beside(actuation, button, "probe-session")
    session = open_session(folder, device, (seed, rig, finger), pace_ratio, default)
    with guided(session, device, as_json) as (found, view, guide):
        surface = learned.surface if learned else uncompensated(found, model, velocities_mm_s)
        tuning = learned.outcome.tuning if learned else Tuning()
        result = judge(
            found, model, surface, velocities_mm_s, presses, view.done, method, session, guide, tuning
        )
    document = {**result.to_dict(), **_receipt(result)}
    _print(document, as_json)
    worst = max(document["curves"], key=lambda c: c["mean_error_cN"])
    if bound_cN is not None and worst["mean_error_cN"] > bound_cN:
        reason = f"mean error of {worst['mean_error_cN']:.2f} cN exceeds the bound of {bound_cN:g} cN"
        click.echo(f"fdvv: {_curve_name(worst)}: {reason}", err=True)
        raise click.exceptions.Exit(1)


def _receipt(result: Any) -> dict[str, Any]:
    return {"receipt": result.receipt.to_dict()} if result.receipt else {}


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
