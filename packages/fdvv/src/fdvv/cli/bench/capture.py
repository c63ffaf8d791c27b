"""fdvv capture."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import click

from fdvv.bench.settings import CaptureSettings
from fdvv.cli import ui
from fdvv.cli.bench.capture_view import COLUMNS, capture_view, cells, progress_row
from fdvv.cli.settings import settings_options

if TYPE_CHECKING:
    from fdvv.bench.capture import CaptureResult

TWIN_BUTTON = "mx-clear"


@click.command()
@click.argument("recording", type=ui.PATH)
@ui.option("--button", help=f"Its name; on the twin a shipped one or a TOML file, {TWIN_BUTTON} by default.")
@ui.option("--device", "spec", default="twin", help="twin (simulated, with its participant) or serial:PORT.")
@settings_options(CaptureSettings)
@ui.option(
    "--participant",
    type=click.Choice(["steady", "careful", "typical", "clumsy"]),
    default="typical",
    help="Who presses on the twin.",
)
@ui.option("--watch", is_flag=True, help="Let the twin take the time that a person takes.")
@ui.option("--player", help="Command that plays a WAV file, as 'aplay -q'; otherwise the terminal's bell.")
@ui.option("-o", "--output", type=ui.PATH, help="The *.fdvv.json of its model to write.")
@ui.json_option
def capture(
    recording: Path,
    button: str | None,
    spec: str,
    settings: CaptureSettings,
    participant: str,
    watch: bool,
    player: str | None,
    output: Path | None,
    as_json: bool,
) -> None:
    """Record a button: a guided session of presses at several paces.

    RECORDING is the *.recording.jsonl to write. First nobody touches the bench, then the cap is led slowly
    down and back, then it is pressed at each pace as a moving bar and two beeps show, at contact and at the
    bottom. After every press stands whether it was good; a bad one is asked for again. With a person the
    whole takes about five minutes; on the twin it runs by itself.

    Every press is on the disk before the next is asked for. Ctrl-C stops; the same command goes on where it
    stopped, also after a crash. With --output the recording is processed as fdvv process does.
    """
    from fdvv.bench.capture import CaptureGuide, capture_session
    from fdvv.bench.model import process_recording
    from fdvv.device.bench import open_bench
    from fdvv.model.file import MODEL_SUFFIX, save_model
    from fdvv.recording.file import RECORDING_SUFFIX

    ui.check_output(recording, RECORDING_SUFFIX)
    ui.check_output(output, MODEL_SUFFIX)
    twin = spec == "twin"
    device = open_bench(spec, button or TWIN_BUTTON, participant, settings.seed, watch)
    name = (button and Path(button).name.removesuffix(".toml")) or (
        TWIN_BUTTON if twin else recording.name.removesuffix(RECORDING_SUFFIX)
    )
    with closing(device), capture_view(watch or not twin, as_json, player) as view:
        guide = CaptureGuide(view.cue, view.done, view.notice)
        result = capture_session(device, recording, name, settings, guide)
    warnings: tuple[str, ...] = ()
    if output:
        model = process_recording(result.path)
        save_model(model.model, output)
        warnings = model.warnings
    _print(result, output, as_json)
    ui.print_warnings(warnings)


def _print(result: CaptureResult, output: Path | None, as_json: bool) -> None:
    found = result.recording
    if as_json:
        document = {
            "recording": str(result.path),
            "button": found.name,
            "device": result.device,
            "simulated": found.simulated,
            "takes": len(found.takes),
            "paces": [progress_row(pace) for pace in result.velocities],
        }
        ui.print_json(document | ({"model": str(output)} if output else {}))
        return
    click.echo(f"{found.name} on {result.device}{ui.simulated(found.simulated)}, {len(found.takes)} takes")
    ui.print_table(COLUMNS, [cells(pace) for pace in result.velocities])
    click.echo(f"recorded in {result.path}")
    ui.print_written(output)
