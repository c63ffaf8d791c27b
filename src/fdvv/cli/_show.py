"""fdvv show."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.cli._output import (
    FIGURES,
    Finite,
    check_output,
    json_option,
    number,
    one_line,
    print_json,
    print_spreads,
    print_table,
    print_warnings,
    print_wrapped,
    progress,
    save_figure,
)

if TYPE_CHECKING:
    from fdvv.model import LandmarkError

TABLE = ("travel_mm", "actuation_mm", "peak_cN", "peak_mm", "snap_ratio", "bottom_out_cN")
NAME_WIDTH = 28
"""What the columns of TABLE leave of the width of a line."""


@click.command()
@click.argument("button")
@click.option(
    "--velocity",
    "velocity_mm_s",
    type=Finite(min=0, min_open=True),
    help="Read the landmarks from the press nearest to this speed (mm/s); the slowest by default.",
)
@click.option(
    "--figure", type=click.Path(path_type=Path), help="Draw the curves into this .svg, .png or .pdf."
)
@json_option
def show(button: str, velocity_mm_s: float | None, figure: Path | None, as_json: bool) -> None:
    """Show landmarks and curves of a button.

    BUTTON is a built-in's name, a *.fdvv.json file, a file of measured curves, or a folder of them (a
    table, one line per button). Of an *.actuation.json file, or of the folder of a session, the receipt is
    shown: rig, method, presses, errors.
    """
    check_output(figure, *FIGURES)
    if _show_receipt(button, as_json):
        return
    if button and Path(button).is_dir():
        if figure:
            raise click.UsageError(f"--figure draws one button, and {button} is a folder")
        _show_folder(Path(button), velocity_mm_s, as_json)
        return
    from fdvv.errors import InputError
    from fdvv.model import landmark_errors, landmarks
    from fdvv.workflow import open_model, spread_reports

    model = open_model(button)
    if not model.of("press"):
        raise InputError(
            button, "curves", "it has no press, which landmarks are read from", "merge one into it"
        )
    marks, errors = landmarks(model, velocity_mm_s).to_dict(), landmark_errors(model, velocity_mm_s)
    if figure:
        from fdvv.plot import plot_model

        save_figure(plot_model(model).figure, figure)
    if as_json:
        told = {name: vars(error) for name, error in errors.items()}
        source = model.provenance.source
        head = {"name": model.name, "source": source, "landmarks": marks, "landmark_errors": told}
        print_json({**head, **spread_reports(model)})
        return
    print_wrapped(f"{model.name}: {model.provenance.source or 'source not stated'}")
    for stroke in ("press", "release"):
        speeds = ", ".join(f"{v:g}" for v in model.velocities_mm_s(stroke))
        if model.of(stroke):
            click.echo(f"  {stroke} at {speeds + ' mm/s' if speeds else 'one unknown speed'}")
    _print_landmarks(marks, errors)
    print_spreads(spread_reports(model))


def _print_landmarks(marks: dict[str, float | None], errors: dict[str, LandmarkError]) -> None:
    """Print landmarks, with standard errors where presses tell them."""
    if not errors:
        print_table(["landmark", "value"], [[name, number(value, 3)] for name, value in marks.items()])
        return
    rows = []
    for name, value in marks.items():
        error = errors.get(name)
        told = [f"± {error.error:.3f}", str(error.presses)] if error else ["", ""]
        rows.append([name, number(value, 3), *told])
    print_table(["landmark", "value", "standard error", "presses"], rows)


def _show_receipt(button: str, as_json: bool) -> bool:
    """Print the receipt of an actuation or of a session; False if BUTTON is neither."""
    from fdvv.cli._receipt import print_receipt
    from fdvv.workflow import open_receipt

    receipt = open_receipt(Path(button)) if button else None
    if receipt is None:
        return False
    if as_json:
        print_json(receipt.to_dict())
    else:
        print_receipt(receipt.to_dict())
    return True


def _show_folder(folder: Path, velocity_mm_s: float | None, as_json: bool) -> None:
    """Print one line of landmarks per button of a folder."""
    from fdvv.model import landmarks
    from fdvv.workflow import button_files, open_files

    found, refused = [], []
    files = button_files(folder)
    with progress("opening", len(files)) as advance:
        for done, button in enumerate(open_files(files), start=1):
            if button.model and button.model.of("press"):
                found.append((str(button.file), landmarks(button.model, velocity_mm_s).to_dict()))
            else:
                reason = button.reason or f"{button.file}: curves: holds no press; merge one into it"
                refused.append({"file": str(button.file), "reason": reason})
            advance(done, len(files))
    if as_json:
        print_json({"results": [{"file": f, "landmarks": m} for f, m in found], "refused": refused})
    elif found:
        rows = [[one_line(Path(f).name, NAME_WIDTH), *(number(m[key], 2) for key in TABLE)] for f, m in found]
        print_table(["button", *TABLE], rows)
    print_warnings([f"refused: {r['reason']}" for r in refused])
    if not found:
        click.echo(f"fdvv: {folder}: no button of it can be shown; the reasons are above", err=True)
        raise click.exceptions.Exit(2)
