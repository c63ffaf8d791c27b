"""fdvv show."""

from __future__ import annotations

from pathlib import Path

import click

from fdvv.cli._output import json_option, number, print_json, print_table, print_warnings, save_figure

TABLE = ("travel_mm", "actuation_mm", "peak_cN", "peak_mm", "valley_cN", "snap_ratio", "bottom_out_cN")


@click.command()
@click.argument("button")
@click.option(
    "--velocity",
    "velocity_mm_s",
    type=click.FloatRange(min=0, min_open=True),
    help="Read the landmarks from the press nearest to this speed (mm/s); the slowest by default.",
)
@click.option(
    "--figure", type=click.Path(path_type=Path), help="Draw the curves into this .svg, .png or .pdf."
)
@json_option
def show(button: str, velocity_mm_s: float | None, figure: Path | None, as_json: bool) -> None:
    """Show landmarks and curves of a button.

    BUTTON is a built-in's name, a *.fdvv.json file, a file of measured curves, or a folder of them (a
    table, one line per button).
    """
    if Path(button).is_dir():
        _show_folder(Path(button), velocity_mm_s, as_json)
        return
    from fdvv.model import landmarks
    from fdvv.workflow import open_model

    model = open_model(button)
    marks = landmarks(model, velocity_mm_s).to_dict()
    if figure:
        from fdvv.plot import plot_model

        save_figure(plot_model(model).figure, figure)
    if as_json:
        curves = [{"stroke": str(c.stroke), "velocity_mm_s": c.velocity_mm_s} for c in model.curves]
        source = model.provenance.source
        print_json({"name": model.name, "source": source, "landmarks": marks, "curves": curves})
        return
    click.echo(f"{model.name}: {model.provenance.source or 'source not stated'}")
    for stroke in ("press", "release"):
        speeds = ", ".join(f"{v:g}" for v in model.velocities_mm_s(stroke))
        if model.of(stroke):
            click.echo(f"  {stroke} at {speeds + ' mm/s' if speeds else 'one unknown speed'}")
    print_table(["landmark", "value"], [[name, number(value, 3)] for name, value in marks.items()])


def _show_folder(folder: Path, velocity_mm_s: float | None, as_json: bool) -> None:
    """Print one line of landmarks per button of a folder."""
    from fdvv.errors import FdvvError
    from fdvv.model import SUFFIX, landmarks, load_model
    from fdvv.workflow import fit_folder

    found, refused = [], []
    models = sorted(folder.rglob(f"*{SUFFIX}"))
    for path in models:
        try:
            found.append((str(path), landmarks(load_model(path), velocity_mm_s).to_dict()))
        except FdvvError as error:
            refused.append({"file": str(path), "reason": str(error)})
    for result in fit_folder(folder) if not models else ():
        if result.fit and result.fit.landmarks:
            found.append((str(result.file), result.fit.landmarks.to_dict()))
        else:
            reason = result.reason or f"{result.file}: whole file: holds no press; capture one"
            refused.append({"file": str(result.file), "reason": reason})
    if as_json:
        print_json({"results": [{"file": f, "landmarks": m} for f, m in found], "refused": refused})
        return
    rows = [[Path(f).name, *(number(m[key], 2) for key in TABLE)] for f, m in found]
    print_table(["button", *TABLE], rows)
    print_warnings([f"refused: {r['reason']}" for r in refused])
