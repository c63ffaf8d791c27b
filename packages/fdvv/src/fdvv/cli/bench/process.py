"""fdvv join and process: logs into a recording, and a recording into a model."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.bench.settings import CaptureSettings
from fdvv.cli import ui
from fdvv.cli.settings import setting_type
from fdvv.force_text import ForceTitle

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


if TYPE_CHECKING:
    from fdvv.bench.model import RecordedModel


@click.command()
@click.argument("recording", type=ui.FILE)
@ui.option("-o", "--output", type=ui.PATH, help="Where to write the model.")
@ui.option("--report", type=ui.PATH, help="Draw every step into this .html file.")
@ui.option(
    "--cap-mass-g",
    type=ui.above_0(1000),
    default=3.0,
    help="Of cap, stem, markers and a third of the spring.",
)
@ui.option(
    "--paces",
    "paces_mm_s",
    type=setting_type(CaptureSettings, "paces_mm_s"),
    help="For presses of a log, which have no pace: each takes the nearest.",
)
@ui.option(
    "--extrapolate-vibration",
    "extrapolate",
    is_flag=True,
    help="Where no vibration was found, scale that of other paces with speed.",
)
@ui.json_option
def process(
    recording: Path,
    output: Path | None,
    report: Path | None,
    cap_mass_g: float,
    paces_mm_s: tuple[float, ...] | None,
    extrapolate: bool,
    as_json: bool,
) -> None:
    """Turn recorded presses into a model, with its spread over presses.

    RECORDING is a *.recording.jsonl file: presses, each stream on its own clock, and a slow probe if there
    was one. Clocks are joined, filters undone, presses judged, and all that may be used are averaged for
    each stroke and pace. What was left out is listed with its reason.
    """
    from fdvv.bench.html import capture_html
    from fdvv.bench.model import capture_report, process_recording
    from fdvv.bench.vibration import find_vibrations
    from fdvv.model.file import MODEL_SUFFIX, save_model
    from fdvv.preprocess.process import Settings
    from fdvv.report.report import write_report

    ui.check_output(output, MODEL_SUFFIX)
    ui.check_output(report, ".html")
    found = process_recording(
        recording,
        Settings(cap_g=cap_mass_g, paces_mm_s=paces_mm_s or ()),
        find_vibrations=functools.partial(find_vibrations, extrapolate=extrapolate),
    )
    if output:
        save_model(found.model, output)
    if report:
        write_report(report, capture_html(found))
    document = capture_report(found)
    if as_json:
        ui.print_json(document)
    else:
        _print(found, document)
        ui.print_written(output, report)


def _print(found: RecordedModel, document: dict[str, Any]) -> None:
    said = ui.simulated(found.model.provenance.simulated)
    ui.print_wrapped(f"{found.model.name}{said}: {found.model.provenance.method}")
    ui.print_table(
        [
            "curve",
            "asked mm/s",
            "achieved mm/s",
            "presses",
            *map(ForceTitle, ("spread {}", "most")),
            ForceTitle("RMSE {}", 3),
            "bump kept",
        ],
        [
            [
                *(c["stroke"], c["velocity_mm_s"], (c["achieved_mm_s"], c["achieved_spread_mm_s"])),
                *(c["presses"], c["median_spread_cN"], c["largest_spread_cN"]),
                *(c["rmse_cN"], ui.bump_kept(c["bump_kept_ratio"])),
            ]
            for c in document["curves"]
        ],
        digits={"asked mm/s": 1, "achieved mm/s": 1},
    )
    for name in ("travel", "actuation", "reset"):
        value, spread = getattr(found.model, f"{name}_mm"), getattr(found.model, f"{name}_spread")
        presses = f", {ui.counted(spread.presses, 'press')}" if spread else ""
        click.echo(f"{name} {ui.with_spread(value, spread.spread_mm if spread else None, 3)} mm{presses}")
    _print_vibrations(document["vibrations"]["in_model"])
    left = [p for p in document["presses"] if p["reason"]]
    if left:
        ui.print_table(
            ["left out", "mm/s", "why"],
            [[f"take {p['take']}", p["velocity_mm_s"], p["reason"]] for p in left],
            left=3,
            digits={"mm/s": 0},
        )
    ui.print_warnings(found.warnings)


def _print_vibrations(vibrations: list[dict[str, Any]]) -> None:
    if not vibrations:
        return
    ui.print_table(
        ["vibration", "mm/s", "onset mm", "Hz", "ms", "m/s²", "presses"],
        [
            [
                *(v["stroke"], v["velocity_mm_s"], (v["onset_mm"], v["onset_spread_mm"])),
                (v["frequency_Hz"], v["frequency_spread_Hz"]),
                (1e3 * v["duration_s"], v["duration_spread_s"] and 1e3 * v["duration_spread_s"]),
                (v["amplitude_m_s2"], v["amplitude_spread_m_s2"]),
                "scaled" if v["presses"] is None else v["presses"],
            ]
            for v in vibrations
        ],
        digits={"mm/s": 0, "onset mm": 3, "Hz": 0, "ms": 1},
    )
