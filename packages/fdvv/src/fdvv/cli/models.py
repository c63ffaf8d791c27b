"""fdvv merge, assign, import and export: models out of models and of files of other programs, and back."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv import extras
from fdvv.cli import ui
from fdvv.errors import ModelError
from fdvv.force_text import ForceTitle, force_name, force_number

OUTPUT = ui.option("-o", "--output", type=ui.NEW_FILE, required=True, help="The *.fdvv.json to write.")


@click.command()
@click.argument("parts", nargs=-1, required=True)
@ui.option("--name", required=True, help="Name of the merged button.")
@ui.option("--travel-mm", type=ui.above_0(1000), help="If the parts' travels differ.")
@ui.option("--actuation-mm", type=ui.Finite(min=0), help="Needed where the parts' points differ.")
@ui.option("--reset-mm", type=ui.Finite(min=0), help="Needed where the parts' points differ.")
@ui.choice_option(
    "--conflict", ("refuse", "first", "last"), help="If two curves of one stroke and velocity differ."
)
@OUTPUT
def merge(parts: tuple[str, ...], output: Path, **options: Any) -> None:
    """Merge force curves at several velocities into one FDVV model.

    PARTS are FILE[:press|:release][@VELOCITY]: a built-in, a *.fdvv.json or a measured file; only that
    stroke of it; declared to be of that velocity in mm/s. Example: merge slow.csv@0.5 fast.csv:press@100
    """
    from fdvv.button.open import merge_parts
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    try:
        model = merge_parts(parts, **options)
    except ModelError as error:
        raise click.UsageError(_as_option(str(error))) from error
    save_model(model, output)
    click.echo(f"{output}: {ui.counted(len(model.curves), 'curve')}, travel {model.travel_mm:.3f} mm")


def _as_option(reason: str) -> str:
    """Turn the arguments that a model names into the options of this command."""
    for field in ("travel_mm", "actuation_mm", "reset_mm"):
        reason = reason.replace(f"pass {field}", f"pass --{field.replace('_', '-')}")
    return reason.replace('pass conflict="first" or "last"', "pass --conflict first or last")


@click.command()
@click.argument("button")
@click.argument("curve")
@ui.option("--stroke", type=ui.STROKE, required=True, help="What the curve becomes.")
@ui.velocity_option(help="At which speed (mm/s).")
@ui.option(
    "--segment", "segment_mm", type=ui.Finite(), nargs=2, metavar="FROM TO", help="Only this part of it (mm)."
)
@ui.option("--blend-mm", type=ui.POSITIVE, default=0.1, help="Width of the transition at the segment's ends.")
@OUTPUT
def assign(button: str, curve: str, output: Path, **options: Any) -> None:
    """Assign a curve, or a segment of one, to press or release of a model.

    BUTTON is the model that is changed (a copy is written); CURVE is FILE[:press|:release], whose own
    stroke and velocity do not matter.
    """
    from fdvv.button.open import one_curve, open_button
    from fdvv.model.edit import assign as assign_curve
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    model = assign_curve(open_button(button), one_curve(curve), **options)
    save_model(model, output)
    click.echo(f"{output}: {ui.counted(len(model.curves), 'curve')}")


if TYPE_CHECKING:
    from fdvv.formats.exchange.exported import Exported


def _list(ctx: click.Context, _param: click.Parameter, wanted: bool) -> None:
    from fdvv.button.export_file import export_formats

    if not wanted or ctx.resilient_parsing:
        return
    ui.print_table(
        ["format", "ending", "what is written"],
        [[f.name, f.suffix, f.about] for f in export_formats()],
        left=3,
    )
    for package, names in extras.absent("exchange_formats").items():
        click.echo(f"not installed: {', '.join(names)}; they come with {package}: pip install {package}")
    ctx.exit()


@click.command()
@click.argument("source")
@ui.option("--to", "form", metavar="FORMAT", help="Format of the file; by default its ending tells.")
@ui.option("-o", "--output", type=ui.PATH, required=True, help="The file to write.")
@ui.option("--stroke", type=ui.STROKE, default="press", help="Whose vibration is written.")
@ui.velocity_option(help="Nearest to this (mm/s), if only one fits; default: slowest.")
@ui.option("--step-mm", type=ui.Finite(min=1e-4, max=1), default=0.01, help="Between samples of a curve.")
@ui.choice_option(
    "--follow", ("press", "both"), help="MuJoCo: springs follow the press or the mean of both strokes."
)
@ui.option("--cap-mass-g", type=ui.POSITIVE, default=1.0, help="MuJoCo: mass of the cap.")
@ui.option("--degrees-per-mm", type=ui.above_0(360), default=10.0, help="SmartKnob: turn per millimetre.")
@ui.option(
    "--list",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list,
    help="List the formats and stop.",
)
@ui.json_option
def export(source: str, form: str | None, output: Path, stroke: str, as_json: bool, **asked: Any) -> None:
    """Write a button, its vibration or a recording for another program.

    SOURCE is a built-in, a *.fdvv.json or a measured file, or a *.recording.jsonl. The output lists
    what the file keeps, what it cannot hold, and by how much it differs (docs/reference/exchange-formats.md).
    """
    from fdvv.button.export_file import export_button, export_format, is_recording
    from fdvv.formats.exchange.exchange_format import ExportSettings
    from fdvv.model.curve import Stroke

    of = "recording" if is_recording(source) else "button"
    ui.check_output(output, export_format(form, output, of).suffix)
    ui.check_folder(output.parent)
    made = export_button(source, form, output, ExportSettings(Stroke(stroke), **asked))
    made.save(output)
    if as_json:
        head = {"path": str(output), "format": made.format, "size_bytes": len(made.data)}
        ui.print_json({**head, "kept": made.kept, "lost": made.lost, "figures": dict(made.figures)})
    else:
        _print(made, output)


def _print(made: Exported, output: Path) -> None:
    click.echo(f"{output}: {made.format}, {len(made.data)} bytes")
    for label, phrases in (("kept", made.kept), ("lost", made.lost)):
        if phrases:
            ui.print_wrapped(f"{label}: {'; '.join(phrases)}")
    if made.figures:
        shown = [_figure(*one) for one in made.figures.items()]
        ui.print_table(["figure", "value"], shown)


def _figure(name: str, value: float | None) -> list[str]:
    title = force_name(name)
    write = force_number if isinstance(title, ForceTitle) else format
    return [title, "–" if value is None else write(value, ".4g")]


@click.command("import")
@click.argument("file", type=ui.FILE)
@ui.option("--name", help="Of the model; by default the file's, or the button's.")
@ui.option(
    "--into", metavar="BUTTON", help="The button that a vibration is given to; the model is a copy of it."
)
@ui.option("--stroke", type=ui.STROKE, default="press", help="Whose vibration it becomes.")
@ui.velocity_option(help="At which speed (mm/s); every speed by default.")
@ui.option(
    "--onset-mm", type=ui.Finite(), help="Where the vibration starts; the peak of the stroke by default."
)
@ui.option(
    "--full-scale-m-s2",
    "full_scale_m_s2",
    type=ui.POSITIVE,
    help="What 1 stands for, if the file does not say.",
)
@ui.option("--accept-implausible", is_flag=True, help="Take also curves that cannot be a button's.")
@ui.option("-o", "--output", type=ui.PATH, required=True, help="The *.fdvv.json to write.")
@ui.json_option
def import_(
    file: Path, stroke: str, output: Path, accept_implausible: bool, as_json: bool, **asked: Any
) -> None:
    """Read a file of another program into a model.

    FILE holds force curves in any known layout (docs/reference/force-files.md), or a vibration: AHAP,
    .haptic, HJIF or WAV, which is given to the button that --into names. Formats are known by their
    content.
    """
    from fdvv.button.fit import FitSettings
    from fdvv.button.import_file import ImportSettings, import_file
    from fdvv.model.curve import Stroke
    from fdvv.model.file import MODEL_SUFFIX, save_model

    ui.check_output(output, MODEL_SUFFIX)
    if output.exists() and output.samefile(file):
        raise click.UsageError(f"{output} is the file itself; give the model another name")
    how = FitSettings(accept_implausible=accept_implausible)
    found = import_file(file, ImportSettings(stroke=Stroke(stroke), fit=how, **asked))
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
