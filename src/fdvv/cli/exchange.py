"""fdvv export and import: files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui

if TYPE_CHECKING:
    from fdvv.formats.exchange.exported import Exported


def _list(ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    if not wanted or ctx.resilient_parsing:
        return
    from fdvv.button.export_file import EXPORT_FORMATS

    ui.print_table(
        ["format", "ending", "what is written"], [[f.name, f.suffix, f.about] for f in EXPORT_FORMATS], left=3
    )
    ctx.exit()


@click.command()
@click.argument("source")
@ui.option("--to", "form", metavar="FORMAT", help="Format of the file; by default its ending tells.")
@ui.option("-o", "--output", type=ui.PATH, required=True, help="The file to write.")
@ui.option("--stroke", type=ui.STROKE, default="press", help="Whose vibration is written.")
@ui.option(
    "--velocity",
    "velocity_mm_s",
    type=ui.POSITIVE,
    help="Nearest to this (mm/s), if only one fits; default: slowest.",
)
@ui.option("--step-mm", type=ui.Finite(min=1e-4, max=1), default=0.01, help="Between samples of a curve.")
@ui.option(
    "--follow",
    type=click.Choice(["press", "both"]),
    default="press",
    help="MuJoCo: springs follow the press or the mean of both strokes.",
)
@ui.option("--cap-mass-g", type=ui.POSITIVE, default=1.0, help="MuJoCo: mass of the cap.")
@ui.option(
    "--degrees-per-mm",
    type=ui.Finite(min=0, max=360, min_open=True),
    default=10.0,
    help="SmartKnob: turn per millimetre.",
)
@ui.option(
    "--list",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list,
    help="List the formats and stop.",
)
@ui.json_option
def export(
    source: str,
    form: str | None,
    output: Path,
    stroke: str,
    velocity_mm_s: float | None,
    step_mm: float,
    follow: str,
    cap_mass_g: float,
    degrees_per_mm: float,
    as_json: bool,
) -> None:
    """Write a button, its vibration or a recording for another program.

    SOURCE is a built-in, a *.fdvv.json or a measured file, or a *.recording.jsonl. The output lists
    what the file keeps, what it cannot hold, and by how much it differs (docs/reference/exchange-formats.md).
    """
    from fdvv.button.export_file import ExportSettings, export_button, export_format, is_recording
    from fdvv.model.curve import Stroke

    of = "recording" if is_recording(source) else "button"
    ui.check_output(output, export_format(form, output, of).suffix)
    ui.check_folder(output.parent)
    settings = ExportSettings(
        Stroke(stroke),
        velocity_mm_s,
        step_mm,
        "both" if follow == "both" else "press",
        cap_mass_g,
        degrees_per_mm,
    )
    made = export_button(source, form, output, settings)
    made.save(output)
    if as_json:
        ui.print_json(_document(made, output))
    else:
        _print(made, output)


def _document(made: Exported, output: Path) -> dict[str, Any]:
    return {
        "path": str(output),
        "format": made.format,
        "size_bytes": len(made.data),
        "kept": list(made.kept),
        "lost": list(made.lost),
        "figures": dict(made.figures),
    }


def _print(made: Exported, output: Path) -> None:
    click.echo(f"{output}: {made.format}, {len(made.data)} bytes")
    for label, phrases in (("kept", made.kept), ("lost", made.lost)):
        if phrases:
            ui.print_wrapped(f"{label}: {'; '.join(phrases)}")
    if made.figures:
        shown = [[name, "–" if value is None else f"{value:.4g}"] for name, value in made.figures.items()]
        ui.print_table(["figure", "value"], shown)


@click.command("import")
@click.argument("file", type=ui.FILE)
@ui.option("--name", help="Of the model; by default the file's, or the button's.")
@ui.option(
    "--into", metavar="BUTTON", help="The button that a vibration is given to; the model is a copy of it."
)
@ui.option("--stroke", type=ui.STROKE, default="press", help="Whose vibration it becomes.")
@ui.option(
    "--velocity", "velocity_mm_s", type=ui.POSITIVE, help="At which speed (mm/s); every speed by default."
)
@ui.option(
    "--onset-mm", type=ui.Finite(), help="Where the vibration starts; the peak of the stroke by default."
)
@ui.option(
    "--full-scale-m-s2",
    "full_scale_m_s2",
    type=ui.POSITIVE,
    help="What 1 stands for, if the file does not say.",
)
@ui.option("-o", "--output", type=ui.PATH, required=True, help="The *.fdvv.json to write.")
@ui.json_option
def import_(
    file: Path,
    name: str | None,
    into: str | None,
    stroke: str,
    velocity_mm_s: float | None,
    onset_mm: float | None,
    full_scale_m_s2: float | None,
    output: Path,
    as_json: bool,
) -> None:
    """Read a file of another program into a model.

    FILE holds force curves in any known layout (docs/reference/force-files.md), or a vibration: AHAP,
    .haptic, HJIF or WAV, which is given to the button that --into names. Formats are known by their
    content.
    """
    from fdvv.button.import_file import ImportSettings, import_file
    from fdvv.model.curve import Stroke
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    if output.exists() and output.samefile(file):
        raise click.UsageError(f"{output} is the file itself; give the model another name")
    settings = ImportSettings(name, into, Stroke(stroke), velocity_mm_s, onset_mm, full_scale_m_s2)
    found = import_file(file, settings)
    save_model(found.model, output)
    if as_json:
        ui.print_json({**found.to_dict(), "path": str(output)})
        return
    ui.print_warnings(found.notes)
    model = found.model
    holds = f"{len(model.curves)} curves, {len(model.vibrations)} vibrations"
    click.echo(
        f"{output}: {ui.one_line(model.name)}, from {found.format}: {holds}, travel {model.travel_mm:.3f} mm"
    )
