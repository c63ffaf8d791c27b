"""fdvv demo."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli import ui
from fdvv.force_text import ForceTitle, force_number, force_unit
from fdvv.io.files import write_atomic

if TYPE_CHECKING:
    from fdvv.cli.demo_run import DemoResult


@click.command()
@ui.option(
    "--switch", type=ui.FILE, help="A file of measured curves to fit; a shipped Cherry MX Brown by default."
)
@ui.option("--rig", type=ui.RIG, default="recommended", help="recommended, light, paper ..., or a TOML file.")
@ui.option("--finger", type=ui.FILE, help="TOML file of the finger.")
@ui.option("--seed", type=ui.COUNT, default=1, help="Repeats the twin.")
@ui.option(
    "-o", "--output", type=ui.NEW_FOLDER, default=Path("demo"), help="Where report and model are written."
)
@ui.json_option
def demo(
    switch: Path | None, rig: Path | None, finger: Path | None, seed: int, output: Path, as_json: bool
) -> None:
    """Run the whole chain on the simulated rig and write a report.

    Fits a real switch, learns to render the published button at four velocities, judges the rendering on
    fresh presses, prints the table and writes OUTPUT/report.html. Rendering figures are simulated.
    """
    from fdvv.cli.demo_report import demo_report
    from fdvv.cli.demo_run import demo as run
    from fdvv.model.file import MODEL_SUFFIX, save_model
    from fdvv.rendering.tuning import open_device

    ui.check_folder(output)
    with ui.stages() as stage:
        result = run(lambda chosen: open_device("twin", rig, finger, chosen), switch, seed, stage)
    save_model(result.switch.adaptive.model, output / f"switch{MODEL_SUFFIX}")
    if as_json:
        ui.print_json(result.to_dict())
    else:
        _print(result)
    # last, because it alone needs matplotlib: without it the table is there all the same
    report = output / "report.html"
    write_atomic(report, demo_report(result))
    click.echo(f"{report}, {result.time_s:.0f} s", err=as_json)


def _print(result: DemoResult) -> None:
    fits = result.switch.adaptive.fits
    name, count = result.switch.adaptive.model.name, fits[0].curve.control_points_cN.size
    click.echo(f"{name}, fitted with {count} control points")
    ui.print_table(
        ["curve", ForceTitle("RMSE {}", 3), ForceTitle("uniform knots, {}", 3), "bump kept"],
        [
            [fit.curve.stroke, fit.rmse_cN, uniform.rmse_cN, ui.bump_kept(fit.bump_kept_ratio)]
            for fit, uniform in zip(fits, result.switch.uniform, strict=True)
        ],
    )
    click.echo(
        f"\n{result.button.name} on the simulated rig: error in {force_unit()}, mean / max, on fresh presses"
    )
    labels = [r.label for r in result.renderings]
    ui.print_table(
        ["curve", *labels],
        [
            [
                ui.curve_name(row),
                *(
                    f"{force_number(row[k]['mean_error_cN'], '.2f')} / "
                    f"{force_number(row[k]['max_error_cN'], '.1f')}"
                    for k in labels
                ),
            ]
            for row in result.rows()
        ],
    )
    click.echo("")
