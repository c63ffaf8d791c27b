"""fdvv feasible."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import closing
from fdvv.cli.rendering.session import Pressing, beside, session_options
from fdvv.cli.settings import settings_options
from fdvv.force_text import ForceTitle, force_text, force_unit
from fdvv.rendering.settings import FeasibleSettings

if TYPE_CHECKING:
    from fdvv.model.model import FDVVModel
    from fdvv.rendering.probe import ProbeResult
    from fdvv.rendering.session import Session

NO_RIG = (
    "fdvv feasible needs --rig-known FILE.rig.json, what was learned from presses on this rig: "
    "identify it with fdvv compensate BUTTON --save-rig FILE.rig.json"
)


@click.command()
@click.argument("button")
@ui.option(
    "--rig-known", type=ui.FILE, help="*.rig.json of this rig, as fdvv compensate --save-rig writes it."
)
@session_options
@settings_options(FeasibleSettings)
@ui.option("--actuation", type=ui.FILE, help="Also press this *.actuation.json and show what was measured.")
@ui.option("--figure", type=ui.PATH, help="Draw every curve into this .svg, .png or .pdf.")
@ui.json_option
def feasible(
    button: str,
    rig_known: Path | None,
    pressing: Pressing,
    settings: FeasibleSettings,
    actuation: Path | None,
    figure: Path | None,
    as_json: bool,
) -> None:
    """Check whether a rig can render a button, and why not, before any upload.

    BUTTON is a built-in, a *.fdvv.json file or a measured file. For every stroke and speed: the force that
    is intended, the one this rig can reach within its limits, its lag and its loop, and the error to expect
    after compensation, an estimate. The device is asked for its settings only, unless --actuation is named.
    """
    from fdvv.button.open import open_button
    from fdvv.compensation.identification.rig_file import load_rig
    from fdvv.rendering.feasibility import feasibility, feasible_curves

    ui.check_output(figure, *ui.FIGURES)
    if rig_known is None:
        click.echo(NO_RIG)
        return
    model, known = open_button(button), load_rig(rig_known)
    pressing = pressing.on_recommended_rig()
    session = pressing.session(settings, beside(actuation, button, "feasible"))
    measured = _measure(session, pressing, settings, model, actuation, as_json) if actuation else None
    with closing(session.open_device(pressing.device)) as found:
        on_device, info = found.settings(), found.info()
    report = feasibility(model, known, on_device, settings.velocities_mm_s, measured, info)
    if figure:
        from fdvv.rendering.figures import plot_feasibility

        ui.save_figure(plot_feasibility(feasible_curves(report), title=model.name)[0, 0].figure, figure)
    if as_json:
        ui.print_json(report.to_dict())
    else:
        _print(report.to_dict())


def _measure(
    session: Session,
    pressing: Pressing,
    settings: FeasibleSettings,
    model: FDVVModel,
    actuation: Path,
    as_json: bool,
) -> ProbeResult:
    """Probe a learned table on the device."""
    from fdvv.rendering.actuation_file import load_actuation
    from fdvv.rendering.probe import probe

    learned, speeds = load_actuation(actuation), settings.velocities_mm_s
    with pressing.guided(session, as_json) as (found, view, guide):
        return probe(
            *(found, model, learned.surface, speeds, settings.presses, view.done, learned.method),
            *(session, guide, learned.outcome.tuning),
        )


def _print(document: dict[str, Any]) -> None:
    presses = document["rig_presses"]
    known = f"rig known from {ui.counted(presses, 'press')}" if presses else "rig known from its file alone"
    ui.print_wrapped(
        f"{document['model']} on {document['device']}{ui.simulated(document['simulated'])}, {known}"
    )
    columns = [
        *("curve", ForceTitle("largest {}", 0), "bump kept", "margin"),
        *(ForceTitle("expected {}", 1), ForceTitle("measured {}", 1), "verdict"),
    ]
    ui.print_table(columns, [_row(c) for c in document["curves"]], digits={"margin": 1})
    for curve in document["curves"]:
        for reason in curve["reasons"]:
            ui.print_wrapped(f"{ui.curve_name(curve)}: {reason}")
    for dose in document["thermal"]:
        ui.print_wrapped(_warmth(dose))
    click.echo("margin: stiffness that the loop bears under a finger, over the curve's steepest rise")
    click.echo(
        f"expected {force_unit()}: mean error after compensation, an estimate; all but measured is computed"
    )


def _row(curve: dict[str, Any]) -> list[Any]:
    kept, measured = curve["bump_kept_ratio"], curve["measured"]
    return [
        ui.curve_name(curve),
        curve["largest_command_cN"],
        kept if kept is None else f"{100 * kept:.0f} %",
        min(curve["stability"]["margin"], 99.0),
        curve["expected_error"]["mean_cN"],
        measured and measured["mean_error_cN"],
        curve["verdict"],
    ]


def _warmth(dose: dict[str, Any]) -> str:
    often, held = dose["presses_per_min"], dose["held_s"]
    pressed = "at no pace" if often is None else f"beyond {often:.0f} presses a minute"
    down = "not when held down" if held is None else f"after {held:.0f} s held down"
    rms = f"{force_text(dose['rms_cN'], '.0f')} rms over a press"
    return f"warmth at {dose['velocity_mm_s']:g} mm/s: {rms}; derates {pressed}, {down}"
