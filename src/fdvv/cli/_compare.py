"""fdvv compare."""

from __future__ import annotations

from pathlib import Path

import click

from fdvv.cli._output import json_option, number, print_json, print_table, save_figure


@click.command()
@click.argument("buttons", nargs=-1, required=True)
@click.option(
    "--velocity",
    "velocity_mm_s",
    type=click.FloatRange(min=0, min_open=True),
    help="Compare at this speed (mm/s); the slowest curves by default.",
)
@click.option(
    "--figure", type=click.Path(path_type=Path), help="Draw the overlay into this .svg, .png or .pdf."
)
@json_option
def compare(
    buttons: tuple[str, ...], velocity_mm_s: float | None, figure: Path | None, as_json: bool
) -> None:
    """Compare buttons: landmarks side by side and force differences.

    BUTTONS are two or more built-ins, *.fdvv.json files, files of measured curves or folders of either.
    The first is the reference; displacement counts from each button's contact.
    """
    from fdvv.workflow import compare as compare_models
    from fdvv.workflow import expand_folder, open_model

    specs = [
        spec for button in buttons for spec in (expand_folder(button) if Path(button).is_dir() else [button])
    ]
    if len(specs) < 2:
        raise click.UsageError("two or more buttons are needed")
    models = [open_model(spec) for spec in specs]
    result = compare_models(models, velocity_mm_s)
    if figure:
        from fdvv.plot import plot_comparison

        save_figure(plot_comparison(models).figure, figure)
    if as_json:
        print_json(result.to_dict())
        return
    rows = [
        [key, *(number(marks.to_dict()[key], 3) for marks in result.landmarks)]
        for key in result.landmarks[0].to_dict()
    ]
    print_table(["landmark", *result.names], rows)
    click.echo("")
    print_table(
        [f"force less {result.names[0]}", "stroke", "rms cN", "mean cN", "max cN", "at mm"],
        [
            [d.name, str(d.stroke), number(d.rms_cN), number(d.mean_cN), number(d.max_cN), number(d.max_mm)]
            for d in result.differences
        ],
    )
