"""fdvv demo."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli._output import check_folder, json_option, number, print_json, print_table, stages

if TYPE_CHECKING:
    from fdvv.workflow import DemoResult


@click.command()
@click.option(
    "--switch",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="A file of measured curves to fit; a shipped Cherry MX Brown by default.",
)
@click.option(
    "--rig", type=click.Path(path_type=Path, exists=True, dir_okay=False), help="TOML file of the rig."
)
@click.option(
    "--finger", type=click.Path(path_type=Path, exists=True, dir_okay=False), help="TOML file of the finger."
)
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Repeats the twin.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("demo"),
    show_default=True,
    help="Folder for report.html and the fitted model.",
)
@json_option
def demo(
    switch: Path | None, rig: Path | None, finger: Path | None, seed: int, output: Path, as_json: bool
) -> None:
    """Run the whole chain on the simulated rig and write a report.

    Fits a real switch, learns to render the published button at four velocities, judges the rendering on
    fresh presses, prints the table and writes OUTPUT/report.html. Rendering figures are simulated.
    """
    check_folder(output)
    from fdvv.files import write_atomic
    from fdvv.model import SUFFIX, save_model
    from fdvv.workflow import demo as run
    from fdvv.workflow import demo_report, open_device

    with stages() as stage:
        result = run(lambda chosen: open_device("twin", rig, finger, chosen), switch, seed, stage)
    save_model(result.switch.adaptive.model, output / f"switch{SUFFIX}")
    if as_json:
        print_json(result.to_dict())
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
    print_table(
        ["curve", "RMSE cN", "uniform knots", "bump kept"],
        [
            [
                str(fit.curve.stroke), number(fit.rmse_cN, 3), number(uniform.rmse_cN, 3),
                "no bump" if fit.bump_kept_ratio is None else f"{100 * fit.bump_kept_ratio:.1f} %",
            ]
            for fit, uniform in zip(fits, result.switch.uniform, strict=True)
        ],
    )  # fmt: skip
    click.echo(f"\n{result.button.name} on the simulated rig: error in cN, mean / max, on fresh presses")
    labels = [r.label for r in result.renderings]
    print_table(
        ["curve", *labels],
        [
            [
                f"{row['stroke']} {row['velocity_mm_s']:g} mm/s",
                *(f"{number(row[k]['mean_error_cN'])} / {number(row[k]['max_error_cN'], 1)}" for k in labels),
            ]
            for row in result.rows()
        ],
    )
    click.echo("")
