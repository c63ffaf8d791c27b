"""fdvv compensate and probe."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import (
    exciter_option,
    jnds_option,
    knowledge_options,
    law_of,
    opened_exciter,
    opened_jnds,
    sensor_option,
)
from fdvv.cli.rendering.session import Pressing, beside, session_options
from fdvv.cli.settings import settings_options
from fdvv.force_text import ForceTitle, force_text
from fdvv.rendering.settings import CompensateSettings, ProbeSettings

if TYPE_CHECKING:
    from fdvv.rendering.probe import ProbeResult


@click.command()
@click.argument("button")
@session_options
@settings_options(CompensateSettings)
@knowledge_options
@ui.option("-o", "--output", type=ui.PATH, help="The *.actuation.json to write.")
@ui.json_option
def compensate(
    button: str,
    pressing: Pressing,
    settings: CompensateSettings,
    save_rig: Path | None,
    output: Path | None,
    as_json: bool,
    **files: Path | None,
) -> None:
    """Learn the actuation that makes a rig feel like a model.

    BUTTON is a built-in, a *.fdvv.json file or a measured file. The method rig-aware identifies the rig from
    a few presses, lets the controller look ahead and push against the rig's own forces, and learns what is
    left; paper is the iterative law of the paper. Errors are those the rig measured while it learned. Judge
    with fdvv probe.

    What a rig has taught is kept with --save-rig. --rig-known begins another button, or an edited one, from
    there: nothing is identified, and with --rounds 0 nothing is pressed at all.

    Ctrl-C stops the device; the same command goes on with a session where it stopped. A press that cannot
    be used, because it stopped short, paused or missed its speed, is reported with the reason and made again.
    """
    from fdvv.button.open import open_button
    from fdvv.rendering.compensate import compensate as learn

    ui.check_output(output, ".actuation.json")
    ui.check_output(save_rig, ".rig.json")
    law, speeds = law_of(settings, save_rig=save_rig, **files), settings.velocities_mm_s
    model, pressing = open_button(button), pressing.on_recommended_rig()
    if files["sensor"]:
        from fdvv.compensation.identification.prior_file import check_range

        check_range(files["sensor"], model, speeds)
    session = pressing.session(settings, beside(output, button, "session"))
    with pressing.guided(session, as_json) as (found, view, guide):
        result = learn(found, model, speeds, law, view.done, session, guide)
    if output:
        from fdvv.rendering.actuation_file import save_actuation

        save_actuation(result, output)
    if save_rig and result.learned_rig:
        from fdvv.compensation.identification.rig_file import save_rig as keep

        keep(result.learned_rig, save_rig)
    _print({**result.to_dict(), **_receipt(result)}, as_json)
    if not as_json:
        ui.print_written(output, save_rig)


@click.command()
@click.argument("button")
@click.argument("actuation", required=False, type=ui.FILE)
@session_options
@settings_options(ProbeSettings)
@exciter_option
@sensor_option
@jnds_option
@ui.option(
    "--figure", type=ui.PATH, help="Draw force and what is noticed of it into this .svg, .png or .pdf."
)
@ui.option("--report", type=ui.PATH, help="Write figures, tables and sources into this .html.")
@ui.option(
    "--max-mean-error-cN",
    "bound_cN",
    type=ui.Force(min=0),
    help="Exit status 1 above this mean error of a curve.",
)
@ui.json_option
def probe(
    button: str,
    actuation: Path | None,
    pressing: Pressing,
    settings: ProbeSettings,
    exciter: Path | None,
    sensor: Path | None,
    jnds_from: Path | None,
    figure: Path | None,
    report: Path | None,
    bound_cN: float | None,
    as_json: bool,
) -> None:
    """Measure on fresh presses how well a rig renders a model.

    BUTTON is what should be felt; ACTUATION the file that fdvv compensate wrote (without it what
    learning starts from: the model's own force). Errors are in true displacement, median over the
    presses. Use another --seed than for learning.

    Where the model has vibrations and the rig an exciter, as many presses follow that play them; their onset,
    strength, spectrum and likeness are measured on the cap. JND is what a finger would just notice, by the
    literature or by your own people (--jnds); docs/explanation/noticeable.md.
    """
    from fdvv.button.open import open_button
    from fdvv.compensation.identification.prior_file import check_range
    from fdvv.compensation.method import Tuning
    from fdvv.rendering.actuation_file import load_actuation
    from fdvv.rendering.compensate import fit_cell, start_surface
    from fdvv.rendering.evaluation.verdict import headline
    from fdvv.rendering.evaluation.vibration_presses import Playback
    from fdvv.rendering.probe import probe as judge

    ui.check_output(figure, *ui.FIGURES)
    ui.check_output(report, ".html")
    jnds = opened_jnds(jnds_from)
    playback = Playback(settings.vibrating, opened_exciter(exciter))
    model, pressing, speeds = open_button(button), pressing.on_recommended_rig(), settings.velocities_mm_s
    sheet = check_range(sensor, model, speeds) if sensor else None
    learned = load_actuation(actuation) if actuation else None
    method = learned.method if learned else "not compensated"
    if learned and learned.model_name != model.name:
        ui.print_warnings([f"{actuation} was learned for {learned.model_name}, not for {model.name}"])
    session = pressing.session(settings, beside(actuation, button, "probe-session"))
    with pressing.guided(session, as_json) as (found, view, guide):
        fit_cell(found, sheet.cell if sheet else None)
        surface = learned.surface if learned else start_surface(found, model, speeds)
        tuning = learned.outcome.tuning if learned else Tuning()
        about = (method, session, guide, tuning, playback if playback.presses else None)
        known = learned.known_rig if learned else None
        pressed = (found, model, surface, speeds, settings.presses, view.done)
        result = judge(*pressed, *about, known_rig=known, jnds=jnds)
    document = {**result.to_dict(), **_receipt(result)}
    _draw(result, figure, report)
    if as_json:
        ui.print_json(document)
    else:
        _print_probe(document, headline(result.curves))
        ui.print_written(figure, report)
    worst = max(document["curves"], key=lambda c: c["mean_error_cN"])
    if bound_cN is not None and worst["mean_error_cN"] > bound_cN:
        reason = (
            f"mean error of {force_text(worst['mean_error_cN'], '.2f')} exceeds the bound of "
            f"{force_text(bound_cN)}"
        )
        raise ui.failed(f"{ui.curve_name(worst)}: {reason}")


def _receipt(result: Any) -> dict[str, Any]:
    return {"receipt": result.receipt.to_dict()} if result.receipt else {}


def _draw(result: ProbeResult, figure: Path | None, report: Path | None) -> None:
    if figure:
        from fdvv.rendering.evaluation.probe_figures import method_curves
        from fdvv.rendering.figures import plot_rendering

        curves = method_curves({"rendered": result.curves}, result.simulated)
        ui.save_figure(plot_rendering(curves, title=result.model_name)[0, 0].figure, figure)
    if report:
        from fdvv.rendering.evaluation.probe_report import probe_report
        from fdvv.report.report import write_report

        write_report(report, probe_report(result))


def _print_head(document: dict[str, Any]) -> None:
    on = f"{document['model']} on {document['device']}{ui.simulated(document['simulated'])}"
    played = document.get("vibration_presses", 0)
    more = f", {played} more with the vibration" if played else ""
    click.echo(f"{on}, {ui.counted(document['presses'], 'press')}{more}")
    ui.print_wrapped(f"method: {document['method']}")


def _print_probe(document: dict[str, Any], result: str) -> None:
    _print_head(document)
    ui.print_wrapped(result)
    columns = [
        "curve",
        *map(ForceTitle, ("mean {}", "max {}", "ripple {}")),
        "> 1 JND",
        "at achieved",
        "to 0.6 mm",
        "with vibration",
    ]
    ui.print_table(columns, [_probe_row(c) for c in document["curves"]])
    asked = [c for c in document["curves"] if "level_JND" in c["vibration"]]
    if asked:
        keys = ("onset_ms", "level_dB", "own_dB", "likeness", "total_JND")
        ui.print_table(
            ["vibration", "late ms", "level dB", "cap alone dB", "likeness", "JND"],
            [[ui.curve_name(c), *(c["vibration"][key] for key in keys)] for c in asked],
            digits={"late ms": 1, "level dB": 1, "cap alone dB": 1},
        )
    ui.print_wrapped(document["verdict"])
    ui.print_wrapped(f"Next: {document['next_step']}")
    _print_skipped(document)


def _probe_row(curve: dict[str, Any]) -> list[Any]:
    shares = ("force", "force_at_achieved_speed", "force_to_entry", "total")
    found = curve["noticeable"]
    return [
        ui.curve_name(curve),
        *(curve[key] for key in ("mean_error_cN", "max_error_cN", "force_ripple_cN")),
        *(f"{100 * found[key]['above_ratio']:.0f} %" for key in shares),
    ]


def _print(document: dict[str, Any], as_json: bool) -> None:
    if as_json:
        ui.print_json(document)
        return
    _print_head(document)
    pressed = [
        c for c in document["curves"] if c["error_cN"] and math.isfinite(c["max_error_cN"] or math.nan)
    ]
    if pressed:
        mean_cN = sum(c["mean_error_cN"] for c in pressed) / len(pressed)
        largest_cN = max(c["max_error_cN"] for c in pressed)
        click.echo(f"mean error {force_text(mean_cN, '.1f')}, largest {force_text(largest_cN, '.1f')}")
    ui.print_table(
        ["curve", *map(ForceTitle, ("first {}", "last {}", "mean {}", "max {}"))],
        [
            [
                ui.curve_name(c),
                *((c["error_cN"][0], c["error_cN"][-1]) if c["error_cN"] else (None, None)),
                c["mean_error_cN"],
                c["max_error_cN"],
            ]
            for c in document["curves"]
        ],
    )
    if not document["presses"]:
        click.echo("nothing was pressed: the mean is what was left on the button that taught the rig")
    _print_skipped(document)


def _print_skipped(document: dict[str, Any]) -> None:
    if document["skipped"]:
        count, last = ui.counted(len(document["skipped"]), "press"), document["skipped"][-1]
        ui.print_warnings([f"{count} skipped; the last: {last}"])
