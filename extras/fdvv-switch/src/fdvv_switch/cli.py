"""fdvv mechanism: springs, leaves and domes that give a model's curves."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli import ui
from fdvv.force_text import ForceTitle, force_number, force_text, force_unit

if TYPE_CHECKING:
    from fdvv_switch.design_button import MechanismResult


@click.command()
@click.argument("model")
@ui.option(
    "--kind",
    type=click.Choice(["auto", "spring", "leaf", "dome"]),
    default="auto",
    help="What to design; auto tries all and takes the simplest of the best.",
)
@ui.option("--wire", type=click.Choice(["steel", "stainless"]), default="steel", help="Of the spring.")
@ui.option(
    "--strip",
    type=click.Choice(["beryllium-copper", "bronze", "stainless"]),
    default="beryllium-copper",
    help="Of the leaf.",
)
@ui.option(
    "--friction",
    "friction_ratio",
    type=ui.Finite(min=0.02, max=0.6),
    default=0.2,
    help="Coefficient between leaf and cam.",
)
@ui.option(
    "--speed",
    "speeds_mm_s",
    type=ui.SPEED,
    multiple=True,
    default=(50.0, 100.0, 200.0),
    help="Press the design on the twin at this speed too, mm/s; repeatable.",
)
@ui.option("-o", "--output", type=ui.NEW_FOLDER, help="Write all files into this folder.")
@ui.json_option
def mechanism(
    model: str,
    kind: str,
    wire: str,
    strip: str,
    friction_ratio: float,
    speeds_mm_s: tuple[float, ...],
    output: Path | None,
    as_json: bool,
) -> None:
    """Design a real switch that gives a model's curves.

    MODEL is a built-in, a *.fdvv.json file or a measured file. A coil, a coil with a leaf on a cam, or a
    rubber dome is designed for its slowest press and release, in sizes that can be bought or made. The
    command tells what is missed and why, what tolerances do, and presses the design on the twin (simulated).
    The folder gets sizes, curves, cam and drawings (DXF), a button for fdvv press, and a report. Exit status
    1: nothing that can be made comes within 3 cN rms on both strokes.
    """
    from fdvv.button.open import open_button
    from fdvv_switch.design_button import design_mechanism
    from fdvv_switch.files import write_mechanism
    from fdvv_switch.making import Making

    if output:
        ui.check_folder(output)
    opened = open_button(model)
    making = Making(wire=wire, strip=strip, friction_ratio=friction_ratio)
    with ui.stages() as progress:
        result = design_mechanism(opened, kind, making, speeds_mm_s, progress)
    written = write_mechanism(result, output) if output else ()
    if as_json:
        ui.print_json({**result.to_dict(), "files": [str(path) for path in written]})
    else:
        _print(result)
        if output:
            click.echo(f"written: {output} ({', '.join(path.name for path in written)})")
    raise click.exceptions.Exit(0 if result.met else 1)


def _print(result: MechanismResult) -> None:
    from fdvv_switch.facts import facts_of

    ui.print_wrapped(f"{result.model.name}: {result.recommendation}")
    for part, facts in facts_of(result.mechanism, result.target).items():
        values = (v if isinstance(v, str) else f"{name} {v:.4g}" for name, v in facts.items())
        ui.print_wrapped(f"{part}: {', '.join(values)}")
    for reason in (*result.residual.reasons, *result.notes):
        ui.print_wrapped(reason)
    _print_tolerances(result)
    _print_misses(result)


def _print_tolerances(result: MechanismResult) -> None:
    band, worst = result.band, result.band.shares[:3]
    most = ", ".join(f"{s.tolerance.name} {force_number(s.rms_cN, '.1f')}" for s in worst)
    bump = ""
    if band.peak_cN and band.snap_ratio:
        bump = (
            f", peak {force_number(band.peak_cN[0], '.0f')} to {force_text(band.peak_cN[1], '.0f')}, "
            f"snap ratio {band.snap_ratio[0]:.2f} to {band.snap_ratio[1]:.2f}"
        )
    ui.print_wrapped(
        f"within tolerance, 5 to 95 %: press ± {force_text(band.half_width_cN, '.1f')}{bump}; most from "
        f"({force_unit()} rms): {most}"
    )


def _print_misses(result: MechanismResult) -> None:
    residual = result.residual
    rows = [["design", residual.press.rms_cN, residual.release.rms_cN, "the slow curves"]]
    for p in result.pressed:
        against = "the model at that speed" if p.own_speed else "the slow curves"
        name = f"twin {p.speed_mm_s:g} mm/s (simulated)"
        rows.append([name, p.press.rms_cN, p.release.rms_cN, against])
    ui.print_table(
        [f"missed, {force_unit()} rms", ForceTitle("press"), ForceTitle("release"), "against"], rows
    )
    if result.twin_refused:
        ui.print_wrapped(f"the twin cannot take this design: {result.twin_refused}")
