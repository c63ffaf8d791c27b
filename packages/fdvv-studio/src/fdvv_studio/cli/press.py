"""fdvv press: the simulated person presses a simulated real button."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from fdvv.cli import ui
from fdvv.force_text import ForceTitle, force_text

FIGURES = {
    "asked_mm_s": "asked mm/s",
    "achieved_mm_s": "reached mm/s",
    "before_stop_cN": "before stop {}",
    "largest_cN": "largest {}",
    "closing_ms": "closing ms",
}
"""Of a press, each with the heading of its column."""


@click.command()
@ui.option(
    "--button", required=True, help="A shipped real button, or a TOML file (docs/reference/button.md)."
)
@ui.option("--finger", type=ui.FILE, help="TOML file of the person (docs/reference/rig.md).")
@ui.speeds_option("--speed", "speeds_mm_s", help="Mean speed of the press, mm/s; repeatable.")
@ui.option("--presses", type=click.IntRange(1, 1000), default=3, help="Of each speed.")
@ui.option("--seed", type=ui.COUNT, default=0, help="Repeats the presses.")
@ui.option("-o", "--output", type=ui.PATH, help="The *.csv of every press to write.")
@ui.json_option
def press(output: Path | None, as_json: bool, **options: Any) -> None:
    """Press a real button; simulated.

    Finger, switch or dome, leaf and plate are those of the twin (docs/explanation/real-buttons.md). Forces
    are those on the cap, before the stop and over the whole press; the circuit's closing counts from the
    cap's first 0.05 mm.
    """
    from fdvv_studio.live.simulated_press import press_button

    ui.check_output(output, ".csv")
    result = press_button(**options)
    if output:
        result.write_csv(output)
    if as_json:
        rows = [{key: getattr(p, key) for key in FIGURES} for p in result.presses]
        document = {"button": result.button, "travel_mm": result.travel_mm, "simulated": True}
        ui.print_json({**document, "quasi_static_peak_cN": result.quasi_static_peak_cN, "presses": rows})
        return
    click.echo(
        f"{result.button} (simulated): travel {result.travel_mm:.2f} mm, "
        f"{force_text(result.quasi_static_peak_cN, '.1f')} before the stop at 0.5 mm/s"
    )
    columns = [ForceTitle(title) if "{}" in title else title for title in FIGURES.values()]
    ui.print_table(columns, [[getattr(p, key) for key in FIGURES] for p in result.presses])
    if output:
        click.echo(f"written: {output}")
