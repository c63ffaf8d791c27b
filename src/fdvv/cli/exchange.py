"""fdvv export and import: files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._output import (
    Finite,
    check_folder,
    check_output,
    json_option,
    one_line,
    print_json,
    print_table,
    print_warnings,
    print_wrapped,
)

if TYPE_CHECKING:
    from fdvv.exchange import Exported

STROKES = click.Choice(["press", "release"])


def _list(ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    if not wanted or ctx.resilient_parsing:
        return
    from fdvv.workflow import EXPORT_FORMATS

    print_table(
        ["format", "ending", "what is written"], [[f.name, f.suffix, f.about] for f in EXPORT_FORMATS], left=3
    )
    ctx.exit()


@click.command()
@click.argument("source")
@click.option("--to", "form", metavar="FORMAT", help="Format of the file; by default its ending tells.")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="The file to write.")
@click.option(
    "--stroke", type=STROKES, default="press", show_default=True, help="Whose vibration is written."
)
@click.option(
    "--velocity",
    "velocity_mm_s",
    type=Finite(min=0, min_open=True),
    help="Nearest to this speed (mm/s), where a format holds one; the slowest by default.",
)
@click.option(
    "--step-mm",
    type=Finite(min=1e-4, max=1),
    default=0.01,
    show_default=True,
    help="Between samples of a curve.",
)
@click.option(
    "--follow", type=click.Choice(["press", "both"]), default="press", show_default=True,
    help="MuJoCo: what the springs draw, the presses or the middle of both strokes.",
)  # fmt: skip
@click.option(
    "--cap-mass-g",
    type=Finite(min=0, min_open=True),
    default=1.0,
    show_default=True,
    help="MuJoCo: mass of the cap.",
)
@click.option(
    "--degrees-per-mm", type=Finite(min=0, max=360, min_open=True), default=10.0, show_default=True,
    help="SmartKnob: how far it turns for a millimetre.",
)  # fmt: skip
@click.option(
    "--list",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list,
    help="List the formats and stop.",
)
@json_option
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

    SOURCE is a built-in, a *.fdvv.json or a measured file, or a *.recording.jsonl. What the file keeps of
    it, what it cannot hold, and by how much it differs is told (docs/reference/exchange-formats.md).
    """
    from fdvv.model import Stroke
    from fdvv.workflow import ExportSettings, export_button, export_format, is_recording

    of = "recording" if is_recording(source) else "button"
    check_output(output, export_format(form, output, of).suffix)
    check_folder(output.parent)
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
        print_json(_document(made, output))
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
            print_wrapped(f"{label}: {'; '.join(phrases)}")
    if made.figures:
        shown = [[name, "–" if value is None else f"{value:.4g}"] for name, value in made.figures.items()]
        print_table(["figure", "value"], shown)


@click.command("import")
@click.argument("file", type=click.Path(path_type=Path, exists=True, dir_okay=False))
@click.option("--name", help="Of the model; by default the file's, or the button's.")
@click.option(
    "--into", metavar="BUTTON", help="The button that a vibration is given to; the model is a copy of it."
)
@click.option(
    "--stroke", type=STROKES, default="press", show_default=True, help="Whose vibration it becomes."
)
@click.option(
    "--velocity",
    "velocity_mm_s",
    type=Finite(min=0, min_open=True),
    help="At which speed (mm/s); every speed by default.",
)
@click.option(
    "--onset-mm", type=Finite(), help="Where the vibration starts; the peak of the stroke by default."
)
@click.option(
    "--full-scale-m-s2",
    "full_scale_m_s2",
    type=Finite(min=0, min_open=True),
    help="What 1 in the file stands for, where it does not say so itself.",
)
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), required=True, help="The *.fdvv.json to write."
)
@json_option
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
    from fdvv.model import SUFFIX, Stroke, save_model
    from fdvv.workflow import ImportSettings, import_file

    check_output(output, SUFFIX)
    if output.exists() and output.samefile(file):
        raise click.UsageError(f"{output} is the file itself; give the model another name")
    settings = ImportSettings(name, into, Stroke(stroke), velocity_mm_s, onset_mm, full_scale_m_s2)
    found = import_file(file, settings)
    save_model(found.model, output)
    if as_json:
        print_json({**found.to_dict(), "path": str(output)})
        return
    print_warnings(found.notes)
    model = found.model
    holds = f"{len(model.curves)} curves, {len(model.vibrations)} vibrations"
    click.echo(
        f"{output}: {one_line(model.name)}, from {found.format}: {holds}, travel {model.travel_mm:.3f} mm"
    )
