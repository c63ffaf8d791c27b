"""fdvv process."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import Paces

if TYPE_CHECKING:
    from fdvv.bench.model import RecordedModel


@click.command()
@click.argument("recording", type=ui.FILE)
@ui.option("-o", "--output", type=ui.PATH, help="Where to write the model.")
@ui.option("--report", type=ui.PATH, help="Draw every step into this .html file.")
@ui.option(
    "--cap-mass-g",
    type=ui.Finite(min=0, max=1000, min_open=True),
    default=3.0,
    help="Of cap, stem, markers and a third of the spring.",
)
@ui.option(
    "--paces",
    "paces_mm_s",
    type=Paces(),
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
    from fdvv.bench.model import capture_report, process_recording
    from fdvv.bench.vibration import recorded_vibrations
    from fdvv.model.file import MODEL_SUFFIX, save_model
    from fdvv.preprocess.process import Settings

    ui.check_output(output, MODEL_SUFFIX)
    ui.check_output(report, ".html")
    found = process_recording(
        recording,
        Settings(cap_g=cap_mass_g, paces_mm_s=paces_mm_s or ()),
        find_vibrations=functools.partial(recorded_vibrations, extrapolate=extrapolate),
    )
    if output:
        save_model(found.model, output)
    if report:
        from fdvv.bench.html import capture_html
        from fdvv.report.report import write_report

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
        ["curve", "asked mm/s", "achieved mm/s", "presses", "spread cN", "most", "RMSE cN", "bump kept"],
        [
            [
                c["stroke"],
                ui.number(c["velocity_mm_s"], 1),
                ui.with_spread(c["achieved_mm_s"], c["achieved_spread_mm_s"], 1),
                *(c[key] for key in ("presses", "median_spread_cN", "largest_spread_cN")),
                ui.number(c["rmse_cN"], 3),
                ui.bump_kept(c["bump_kept_ratio"]),
            ]
            for c in document["curves"]
        ],
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
            [[f"take {p['take']}", ui.number(p["velocity_mm_s"], 0), p["reason"]] for p in left],
            left=3,
        )
    ui.print_warnings(found.warnings)


def _print_vibrations(vibrations: list[dict[str, Any]]) -> None:
    if not vibrations:
        return
    ui.print_table(
        ["vibration", "mm/s", "onset mm", "Hz", "ms", "m/s²", "presses"],
        [
            [
                v["stroke"],
                ui.number(v["velocity_mm_s"], 0),
                ui.with_spread(v["onset_mm"], v["onset_spread_mm"], 3),
                ui.with_spread(v["frequency_Hz"], v["frequency_spread_Hz"], 0),
                ui.with_spread(
                    1e3 * v["duration_s"], v["duration_spread_s"] and 1e3 * v["duration_spread_s"], 1
                ),
                ui.with_spread(v["amplitude_m_s2"], v["amplitude_spread_m_s2"]),
                "scaled" if v["presses"] is None else v["presses"],
            ]
            for v in vibrations
        ],
    )
