"""fdvv capture."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import click

from fdvv.bench.capture import CaptureGuide, CaptureResult, capture_session
from fdvv.bench.model import process_recording
from fdvv.bench.plan import CapturePlan
from fdvv.cli import ui
from fdvv.cli.bench.capture_view import COLUMNS, capture_view, cells, progress_row
from fdvv.cli.options import Paces
from fdvv.device.bench import open_bench
from fdvv.model.file import MODEL_SUFFIX, save_model
from fdvv.recording.file import RECORDING_SUFFIX

TWIN_BUTTON = "mx-clear"


@click.command()
@click.argument("recording", type=ui.PATH)
@ui.option("--button", help=f"Its name; on the twin a shipped one or a TOML file, {TWIN_BUTTON} by default.")
@ui.option("--device", "spec", default="twin", help="twin (simulated, with its participant) or serial:PORT.")
@ui.option(
    "--paces", "paces_mm_s", type=Paces(), default="50,100,150,200", help="Mean speeds of the stroke down."
)
@ui.option("--presses", type=click.IntRange(1, 200), default=15, help="Per pace.")
@ui.option("--probe/--no-probe", default=True, help="Lead the cap slowly down and back first.")
@ui.option("--shuffle", is_flag=True, help="Ask for the paces mixed instead of one after the other.")
@ui.option(
    "--repeats", type=click.IntRange(0, 20), default=3, help="How often a bad press is asked for again."
)
@ui.option(
    "--pace-tolerance", "pace_ratio", type=ui.PART, default=0.35, help="By which a press may miss its pace."
)
@ui.option(
    "--travel",
    "travel_mm",
    type=ui.Finite(min=0.5, max=10),
    help="Of the button, mm; by default from the probe.",
)
@ui.option("--seed", type=ui.COUNT, default=0, help="Repeats the twin; order of --shuffle.")
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
    seed: int,
    participant: str,
    watch: bool,
    player: str | None,
    output: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Record a button: a guided session of presses at several paces.

    RECORDING is the *.recording.jsonl to write. First nobody touches the bench, then the cap is led slowly
    down and back, then it is pressed at each pace as a moving bar and two beeps show, at contact and at the
    bottom. After every press stands whether it was good; a bad one is asked for again. With a person the
    whole takes about five minutes; on the twin it runs by itself.

    Every press is on the disk before the next is asked for. Ctrl-C stops; the same command goes on where it
    stopped, also after a crash. With --output the recording is processed as fdvv process does.
    """
    ui.check_output(recording, RECORDING_SUFFIX)
    ui.check_output(output, MODEL_SUFFIX)
    shuffled = options.pop("shuffle")
    plan = CapturePlan(**options, shuffled=shuffled, seed=seed)
    twin = spec == "twin"
    device = open_bench(spec, button or TWIN_BUTTON, participant, seed, watch)
    name = (button and Path(button).name.removesuffix(".toml")) or (
        TWIN_BUTTON if twin else recording.name.removesuffix(RECORDING_SUFFIX)
    )
    with closing(device), capture_view(watch or not twin, as_json, player) as view:
        guide = CaptureGuide(view.cue, view.done, view.notice)
        result = capture_session(device, recording, name, plan, guide)
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
