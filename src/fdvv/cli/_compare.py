"""fdvv compare."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli._output import (
    FIGURES,
    WIDTH,
    Finite,
    check_output,
    json_option,
    number,
    one_line,
    print_json,
    print_table,
    print_warnings,
    progress,
    save_figure,
    with_spread,
)

if TYPE_CHECKING:
    from fdvv.model import LandmarkError
    from fdvv.workflow import Comparison

LABEL_WIDTH, NAME_WIDTH = 19, 28
"""Of the names of landmarks, and what the columns of LANDMARKS leave for the names of buttons."""
LANDMARKS = ("travel_mm", "peak_cN", "peak_mm", "snap_ratio", "bottom_out_cN", "work_mJ")


@click.command()
@click.argument("buttons", nargs=-1, required=True)
@click.option(
    "--velocity", "velocity_mm_s", type=Finite(min=0, min_open=True),
    help="Compare at this speed (mm/s); the slowest curves by default.",
)  # fmt: skip
@click.option("--figure", type=click.Path(path_type=Path), help="Draw the overlay: .svg, .png or .pdf.")
@json_option
def compare(
    buttons: tuple[str, ...], velocity_mm_s: float | None, figure: Path | None, as_json: bool
) -> None:
    """Compare buttons: landmarks side by side and force differences.

    BUTTONS are two or more built-ins, *.fdvv.json files, files of measured curves or folders of either.
    The first is the reference; displacement counts from each button's contact.
    """
    check_output(figure, *FIGURES)
    from fdvv.model import Stroke
    from fdvv.workflow import compare as compare_models
    from fdvv.workflow import open_models

    refused: list[str] = []
    with progress("opening", len(buttons)) as advance:
        opened = open_models(buttons, refused, advance)
    models = [model for model in opened if model.of(Stroke.PRESS)]
    refused += [f"{model.name}: has no press curve" for model in opened if not model.of(Stroke.PRESS)]
    print_warnings([f"refused: {reason}" for reason in refused])
    if len(models) < 2:
        raise click.UsageError(f"two or more buttons with a press are needed, got {len(models)}")
    result = compare_models(models, velocity_mm_s)
    if figure:
        from fdvv.plot import plot_comparison

        save_figure(plot_comparison(models, velocity_mm_s=velocity_mm_s).figure, figure)
    if as_json:
        print_json({**result.to_dict(), "refused": refused})
    elif (
        LABEL_WIDTH + sum(_width(*named) for named in zip(result.names, result.errors, strict=True)) <= WIDTH
    ):
        _print_columns(result)
    else:
        _print_lines(result)


def _width(name: str, errors: dict[str, LandmarkError]) -> int:
    """Tell the width of a button's column; standard errors take their place in it."""
    return 2 + max(16 if errors else 8, len(name))


def _print_columns(result: Comparison) -> None:
    """Print a column per button, then the differences."""
    marks = [m.to_dict() for m in result.landmarks]
    rows = [[key, *(_mark(m, e, key) for m, e in zip(marks, result.errors, strict=True))] for key in marks[0]]
    print_table(["landmark", *result.names], rows)
    if any(result.errors):
        click.echo("±: standard error over presses")
    click.echo("")
    print_table(
        [f"force less {result.names[0]}", "stroke", "rms cN", "mean cN", "max cN", "at mm"],
        [
            [d.name, str(d.stroke), number(d.rms_cN), number(d.mean_cN), number(d.max_cN), number(d.max_mm)]
            for d in result.differences
        ],
    )


def _mark(marks: dict[str, float | None], errors: dict[str, LandmarkError], key: str) -> str:
    return with_spread(marks[key], errors[key].error if key in errors else None, 3)


def _print_lines(result: Comparison) -> None:
    """Print a line per button: landmarks and how far its press is from that of the reference."""
    click.echo(f"rms cN: force of the press less that of {one_line(result.names[0])}")
    rms = {d.index: d.rms_cN for d in result.differences if d.stroke == "press"}
    rows = [
        [one_line(name, NAME_WIDTH), *(number(marks.to_dict()[key]) for key in LANDMARKS), number(rms.get(i))]
        for i, (name, marks) in enumerate(zip(result.names, result.landmarks, strict=True))
    ]
    print_table(["button", *LANDMARKS, "rms cN"], rows)
