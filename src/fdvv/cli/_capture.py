"""fdvv capture."""

from __future__ import annotations

import statistics
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._capture_view import COLUMNS, capture_view, cells
from fdvv.cli._output import Finite, check_output, json_option, print_json, print_table, print_warnings
from fdvv.cli._paces import Paces

if TYPE_CHECKING:
    from fdvv.workflow import CaptureResult, PaceStanding

TWIN_BUTTON = "mx-clear"


@click.command()
@click.argument("recording", type=click.Path(path_type=Path))
@click.option(
    "--button",
    help="Name of the button; on the twin a shipped one or a TOML file "
    f"(docs/reference/button.md), {TWIN_BUTTON} if none is named.",
)
@click.option(
    "--device",
    "spec",
    default="twin",
    show_default=True,
    help="twin: simulated, participant and all; serial:PORT: a bench on a serial port.",
)
@click.option(
    "--paces",
    "paces_mm_s",
    type=Paces(),
    default="50,100,150,200",
    show_default=True,
    help="Mean speeds of the stroke down.",
)
@click.option("--presses", type=click.IntRange(1, 200), default=15, show_default=True, help="Per pace.")
@click.option(
    "--probe/--no-probe", default=True, show_default=True, help="Lead the cap slowly down and back first."
)
@click.option("--shuffle", is_flag=True, help="Ask for the paces mixed instead of one after the other.")
@click.option(
    "--repeats",
    type=click.IntRange(0, 20),
    default=3,
    show_default=True,
    help="How often a bad press is asked for again.",
)
@click.option(
    "--pace-tolerance",
    "pace_ratio",
    type=Finite(min=0.05, max=1),
    default=0.35,
    show_default=True,
    help="Part by which a press may miss its pace.",
)
@click.option(
    "--travel",
    "travel_mm",
    type=Finite(min=0.5, max=10),
    help="Travel of the button, mm; otherwise the probe tells it.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Repeats the twin; order of --shuffle.",
)
@click.option(
    "--participant",
    type=click.Choice(["steady", "careful", "typical", "clumsy"]),
    default="typical",
    show_default=True,
    help="Who presses on the twin.",
)
@click.option("--watch", is_flag=True, help="Let the twin take the time that a person takes.")
@click.option("--player", help="Command that plays a WAV file, as 'aplay -q'; otherwise the terminal's bell.")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="The *.fdvv.json of its model to write."
)
@json_option
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
    **asked: Any,
) -> None:
    """Record a button: a guided session of presses at several paces.

    RECORDING is the *.recording.jsonl to write. First nobody touches the bench, then the cap is led slowly
    down and back, then it is pressed at each pace as a moving bar and two beeps show, at contact and at the
    bottom. After every press stands whether it was good; a bad one is asked for again. With a person the
    whole takes about five minutes; on the twin it runs by itself.

    Every press is on the disk before the next is asked for. Ctrl-C stops; the same command goes on where it
    stopped, also after a crash. With --output the recording is processed as fdvv process does.
    """
    from fdvv.device import open_bench
    from fdvv.model import SUFFIX
    from fdvv.recording import RECORDING_SUFFIX
    from fdvv.workflow import CaptureGuide, CapturePlan, capture_session

    check_output(recording, RECORDING_SUFFIX)
    check_output(output, SUFFIX)
    shuffled = asked.pop("shuffle")
    plan = CapturePlan(**asked, shuffled=shuffled, seed=seed)
    twin = spec == "twin"
    device = open_bench(spec, button or TWIN_BUTTON, participant, seed, watch)
    name = (button and Path(button).name.removesuffix(".toml")) or (
        TWIN_BUTTON if twin else recording.name.removesuffix(RECORDING_SUFFIX)
    )
    try:
        with capture_view(watch or not twin, as_json, player) as view:
            guide = CaptureGuide(view.cue, view.done, view.notice)
            result = capture_session(device, recording, name, plan, guide)
    finally:
        device.close()
    warnings = _write_model(result.path, output) if output else ()
    _print(result, output, as_json)
    print_warnings(warnings)


def _write_model(recording: Path, output: Path) -> tuple[str, ...]:
    """Process the recording into a model file; give what should be known of it."""
    from fdvv.model import save_model
    from fdvv.workflow import process_recording

    found = process_recording(recording)
    save_model(found.model, output)
    return found.warnings


def _print(result: CaptureResult, output: Path | None, as_json: bool) -> None:
    found = result.recording
    if as_json:
        paces = [_row(pace) for pace in result.paces]
        model = {"model": str(output)} if output else {}
        document = {"recording": str(result.path), "button": found.name, "device": result.device}
        print_json(
            {**document, "simulated": found.simulated, "takes": len(found.takes), "paces": paces, **model}
        )
        return
    told = " (simulated)" if found.simulated else ""
    click.echo(f"{found.name} on {result.device}{told}, {len(found.takes)} takes")
    print_table(COLUMNS, [cells(pace) for pace in result.paces])
    click.echo(f"recorded in {result.path}")
    if output:
        click.echo(f"written to {output}")


def _row(pace: PaceStanding) -> dict[str, Any]:
    speeds = pace.achieved_mm_s
    return {
        "velocity_mm_s": pace.velocity_mm_s,
        "good": pace.good,
        "wanted": pace.wanted,
        "takes": pace.made,
        "missed": pace.missed,
        "median_mm_s": statistics.median(speeds) if speeds else None,
        "least_mm_s": min(speeds, default=None),
        "most_mm_s": max(speeds, default=None),
    }
