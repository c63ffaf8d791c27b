"""fdvv capture, and its session on the terminal: a row per pace, the moving pace, beeps, verdicts."""

from __future__ import annotations

import math
import statistics
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.bench.settings import CaptureSettings
from fdvv.cli import ui
from fdvv.cli.cue import BEATS, BEAT_s, FRAME_s, TONES_Hz, bar, beeper, depth_at
from fdvv.cli.settings import settings_options

if TYPE_CHECKING:
    from rich.live import Live

    from fdvv.bench.capture import CaptureResult, TakeDone, TakeRequest, VelocityProgress

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


Beep = Callable[[str], None]
Show = Callable[[float], None]


@contextmanager
def capture_view(paced: bool, quiet: bool, player: str | None) -> Iterator[CaptureLines | CaptureTable]:
    """Show a capture on standard error, in place if it is a terminal.

    paced : someone follows the cue; quiet : tell only what a person at a bench must know.
    """
    with beeper(player, _bell) as beep, nullcontext() if quiet else ui.live() as live:
        yield CaptureLines(paced, quiet, beep) if live is None else CaptureTable(paced, live, beep)


def _bell() -> None:
    if sys.stderr.isatty():
        click.echo("\a", nl=False, err=True)


def beeps(ask: TakeRequest, beep: Beep) -> Show:
    """Return what beeps once for each event of a cue, when its time has come."""
    stroke_s, begun_s = stroke_of(ask), BEAT_s * len(BEATS)
    times_s = () if stroke_s is None else (begun_s, begun_s + stroke_s)
    left = list(zip(times_s, TONES_Hz, strict=False))

    def show(t_s: float) -> None:
        while left and t_s >= left[0][0]:
            beep(left.pop(0)[1])

    return show


class CaptureLines:
    """A line per take."""

    def __init__(self, paced: bool, quiet: bool, beep: Beep) -> None:
        self._paced, self._quiet, self._beep = paced, quiet, beep

    def cue(self, ask: TakeRequest) -> Show:
        """Ask a person; only beeps show the pace."""
        if not self._paced:
            return lambda _t_s: None
        ui.print_stderr(request_line(ask))
        return beeps(ask, self._beep)

    def done(self, event: TakeDone) -> None:
        if self._paced or not self._quiet:
            ui.print_stderr(take_line(event))

    def notice(self, text: str) -> None:
        ui.notice(text, self._quiet)


class CaptureTable:
    """A row per pace, the last take and the cue below them, redrawn in place."""

    def __init__(self, paced: bool, live: Live, beep: Beep) -> None:
        self._paced, self._live, self._beep = paced, live, beep
        self._rows: tuple[VelocityProgress, ...] = ()
        self._line = ""

    def cue(self, ask: TakeRequest) -> Show:
        if not self._paced:
            return lambda _t_s: None
        sound, drawn_s = beeps(ask, self._beep), [-1.0]

        def show(t_s: float) -> None:
            sound(t_s)
            if t_s - drawn_s[0] >= FRAME_s:
                drawn_s[0] = t_s
                self._draw(request_line(ask), frame(ask, t_s))

        return show

    def done(self, event: TakeDone) -> None:
        """Report a take; one that must be made again stays on the screen."""
        self._line, self._rows = take_line(event), event.progress
        if not event.check.ok:
            self._live.console.print(self._line, highlight=False, markup=False)
        self._draw()

    def notice(self, text: str) -> None:
        self._live.console.print(ui.one_line(text), highlight=False, markup=False)

    def _draw(self, *lines: str) -> None:
        from rich.console import Group
        from rich.text import Text

        table = [ui.rich_table(COLUMNS, map(cells, self._rows))] if self._rows else []
        texts = [Text(line, no_wrap=True) for line in (self._line, *lines) if line]
        self._live.update(Group(*table, *texts), refresh=True)


def stroke_of(ask: TakeRequest) -> float | None:
    """Return the time of a stroke; None where nothing is pressed."""
    velocity = ask.step.velocity_mm_s
    return None if velocity is None else ask.travel_mm / velocity


def frame(ask: TakeRequest, t_s: float) -> str:
    """Draw the cue at a time: a count-in, then the bar that goes as the cap should."""
    stroke_s, begun_s = stroke_of(ask), BEAT_s * len(BEATS)
    if stroke_s is None:
        return "hands off"
    if t_s < begun_s:
        return f"{BEATS[min(int(t_s / BEAT_s), len(BEATS) - 1)]}  {bar(0.0)}"
    return f"   {bar(depth_at(t_s - begun_s, stroke_s))}"


def request_line(ask: TakeRequest) -> str:
    at, again = f"{ask.number} of {ask.total}", " once more" if ask.again else ""
    stroke_s, velocity = stroke_of(ask), ask.step.velocity_mm_s
    if stroke_s is None:
        return f"{at}: take the finger off the button and wait{again}"
    how = "down to the stop and let go"
    if ask.step.stage == "probe":
        how = f"slowly, {how} as slowly"
    long = f"{stroke_s:.0f} s" if stroke_s >= 1 else f"{1000 * stroke_s:.0f} ms"
    return f"{at}: press{again}, {velocity:g} mm/s, {ask.travel_mm:.1f} mm in {long}, {how}"


NAMES = {"rest": "bench at rest", "probe": "slow probe"}


def take_line(event: TakeDone) -> str:
    take, check = event.take, event.check
    what = NAMES.get(str(take.stage)) or f"{take.velocity_mm_s:g} mm/s"
    at = f"take {take.number}, {event.done} of {event.total}, {what}"
    if not check.ok:
        then = "; enough tries, the session goes on without it" if event.missed else ""
        return ui.one_line(f"{at}: {check.reason}{then}")
    found = [f"{check.achieved_mm_s:.0f} mm/s"] if math.isfinite(check.achieved_mm_s) else []
    found += [f"{check.travel_mm:.2f} mm"] if math.isfinite(check.travel_mm) else []
    return ui.one_line(f"{at}: {', '.join(['good', *found])}")


COLUMNS = ("pace", "good", "of", "takes", "missed", "median mm/s", "least", "most")


def progress_row(progress: VelocityProgress) -> dict[str, Any]:
    """Return what became of the presses of a pace; speeds are null where none was good."""
    speeds = progress.achieved_mm_s
    return {
        "velocity_mm_s": progress.velocity_mm_s,
        "good": progress.good,
        "wanted": progress.wanted,
        "takes": progress.made,
        "missed": progress.missed,
        "median_mm_s": statistics.median(speeds) if speeds else None,
        "least_mm_s": min(speeds, default=None),
        "most_mm_s": max(speeds, default=None),
    }


def cells(progress: VelocityProgress) -> list[str]:
    pace, *counts, median, least, most = progress_row(progress).values()
    return [f"{pace:g} mm/s", *map(str, counts), *(ui.number(v, 1) for v in (median, least, most))]
