"""fdvv join."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui

FACTS = {
    "force_filter_ms": "Time constant of the force sensor's RC filter, undone.",
    "force_play_cN": "By how much the force sensor reads more on the way back, undone.",
    "tip_mass_g": "Mass of the force sensor's tip, whose inertia is taken off.",
    "sound_filter_ms": "Time constant of the microphone's filter, taken off as a delay.",
    "sound_V_s_m": "What the microphone gives per speed of the cap.",
    "exposure_ms": "Of a frame of the cameras, which is stamped at its start.",
}
"""Options that tell of the bench."""


@click.command()
@click.argument("logs", nargs=-1, required=True, type=ui.FILE)
@ui.option("-o", "--output", required=True, type=ui.PATH, help="The recording to write.")
@ui.option("--name", required=True, help="Of the button.")
@ui.option("--marker", "markers", multiple=True, help="A marker on the cap; once or twice. Default: all.")
@click.option("--light", default="", help="The marker that cameras see only while the light is on.")
@click.option("--licence", default="", help="Of the data, as its owner states it.")
@click.option("--person", default="", help="A word for who pressed, never a name.")
@ui.rate_option
@ui.json_option
def join(logs: tuple[Path, ...], output: Path, as_json: bool, **options: Any) -> None:
    """Join logs of instruments that ran at once into a recording.

    LOGS are files of instruments that ran at once, as an export of Motive and the text of a board
    (docs/reference/log-files.md); each keeps its own clock, and process joins them by the light.
    """
    from fdvv.bench.join_logs import join_logs
    from fdvv.recording.check import facts_of
    from fdvv.recording.file import RECORDING_SUFFIX, save_recording
    from fdvv.recording.types import Bench

    ui.check_output(output, RECORDING_SUFFIX)
    bench = Bench(**{name: options.pop(name) for name in FACTS})
    recording = join_logs(logs, bench=bench, **options)
    save_recording(recording, output)
    if as_json:
        ui.print_json({"recording": str(output), **facts_of(recording), "warnings": list(recording.warnings)})
        return
    take = recording.takes[0]
    ui.print_table(
        ["stream", "quantity", "clock", "samples", "rate Hz"],
        [[s.name, s.quantity, s.clock, s.t_s.size, f"{s.rate_Hz:.1f}"] for s in take.streams],
        left=3,
    )
    click.echo(f"written to {output}")
    ui.print_warnings(recording.warnings)


for name, text in FACTS.items():
    kind = ui.Force if name.endswith("_cN") else ui.Finite
    flag = f"--{name.replace('_', '-').lower()}"
    join.params.append(click.Option([flag, name], type=kind(min=0), default=0.0, help=text))
