"""fdvv process."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli._output import (
    Finite,
    check_output,
    counted,
    json_option,
    number,
    one_line,
    print_json,
    print_table,
    print_warnings,
    print_wrapped,
    with_spread,
)
from fdvv.cli._paces import Paces

if TYPE_CHECKING:
    from fdvv.workflow import RecordedModel


@click.command()
@click.argument("recording", type=click.Path(path_type=Path, exists=True, dir_okay=False))
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Where to write the model.")
@click.option("--report", type=click.Path(path_type=Path), help="Draw every step into this .html file.")
@click.option(
    "--cap-mass-g", type=Finite(min=0, max=1000, min_open=True), default=3.0, show_default=True,
    help="Mass of cap, stem, markers and a third of the spring.",
)  # fmt: skip
@click.option(
    "--paces",
    "paces_mm_s",
    type=Paces(),
    help="Paces for presses that were not asked for at one, as those of a log: each is given the nearest.",
)
@click.option(
    "--extrapolate-vibration", "extrapolate", is_flag=True,
    help="Give paces where no vibration was found that of other paces, scaled with speed.",
)  # fmt: skip
@json_option
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
    each stroke and pace. What was left out is told with its reason.
    """
    from fdvv.model import SUFFIX, save_model
    from fdvv.preprocess import Settings
    from fdvv.workflow import capture_report, process_recording, recorded_vibrations

    check_output(output, SUFFIX)
    check_output(report, ".html")
    found = process_recording(
        recording,
        Settings(cap_g=cap_mass_g, paces_mm_s=paces_mm_s or ()),
        find_vibrations=functools.partial(recorded_vibrations, extrapolate=extrapolate),
    )
    if output:
        save_model(found.model, output)
    if report:
        from fdvv.plot import write_report
        from fdvv.workflow import capture_html

        write_report(report, capture_html(found))
    if as_json:
        print_json(capture_report(found))
    else:
        _print(found)
        for path in (output, report):
            if path:
                click.echo(f"written to {path}")


def _print(found: RecordedModel) -> None:
    said = " (simulated)" if found.model.provenance.simulated else ""
    print_wrapped(f"{found.model.name}{said}: {found.model.provenance.method}")
    from fdvv.workflow import capture_report

    document = capture_report(found)
    print_table(
        ["curve", "asked mm/s", "achieved mm/s", "presses", "spread cN", "most", "RMSE cN", "bump kept"],
        [
            [
                c["stroke"],
                number(c["velocity_mm_s"], 1),
                with_spread(c["achieved_mm_s"], c["achieved_spread_mm_s"], 1),
                "–" if c["presses"] is None else str(c["presses"]),
                number(c["median_spread_cN"]),
                number(c["largest_spread_cN"]),
                number(c["rmse_cN"], 3),
                "no bump" if c["bump_kept_ratio"] is None else f"{100 * c['bump_kept_ratio']:.1f} %",
            ]
            for c in document["curves"]
        ],
    )
    for name in ("travel", "actuation", "reset"):
        value, spread = getattr(found.model, f"{name}_mm"), getattr(found.model, f"{name}_spread")
        told = f", {counted(spread.presses, 'press')}" if spread else ""
        click.echo(f"{name} {with_spread(value, spread.spread_mm if spread else None, 3)} mm{told}")
    _print_vibrations(document["vibrations"]["in_model"])
    left = [p for p in document["presses"] if p["reason"]]
    if left:
        print_table(
            ["left out", "mm/s", "why"],
            [[f"take {p['take']}", number(p["velocity_mm_s"], 0), one_line(p["reason"])] for p in left],
            left=3,
        )
    print_warnings(found.warnings)


def _print_vibrations(vibrations: list[dict[str, Any]]) -> None:
    if not vibrations:
        return
    print_table(
        ["vibration", "mm/s", "onset mm", "Hz", "ms", "m/s²", "presses"],
        [
            [
                v["stroke"],
                number(v["velocity_mm_s"], 0),
                with_spread(v["onset_mm"], v["onset_spread_mm"], 3),
                with_spread(v["frequency_Hz"], v["frequency_spread_Hz"], 0),
                with_spread(
                    1e3 * v["duration_s"], v["duration_spread_s"] and 1e3 * v["duration_spread_s"], 1
                ),
                with_spread(v["amplitude_m_s2"], v["amplitude_spread_m_s2"]),
                "scaled" if v["presses"] is None else str(v["presses"]),
            ]
            for v in vibrations
        ],
    )
