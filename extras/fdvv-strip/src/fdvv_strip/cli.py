"""fdvv device strip: check the LED strip of the pointing task."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.options import remote

if TYPE_CHECKING:
    from fdvv_people.task.task import TaskPress
    from fdvv_strip.check import StripCheck


@click.command()
@ui.option("--strip", "spec", required=True, help="serial:PORT of the strip's board, or host (simulated).")
@ui.choice_option("--level", ("easy", "hard"), help="100 or 150 pixels per second.")
@ui.option("--rounds", type=click.IntRange(1, 100), default=3, help="Presses to make.")
@ui.option("--seed", type=ui.COUNT, default=0, help="Of the start delays.")
@ui.choice_option(
    "--led",
    ("each", "together"),
    help="When a pixel shows what it is sent: each at once (APA102) or all after the frame (SK9822).",
)
@ui.option("--brightness", type=click.IntRange(1, 31), default=8, help="Of lit pixels, in 31sts.")
@ui.option("--device", help="Rig that renders BUTTON meanwhile, as of the other commands of fdvv device.")
@ui.option("--button", default="mx-clear", help="Rendered by --device.")
@ui.json_option
def strip(spec: str, device: str | None, button: str, as_json: bool, **asked: Any) -> None:
    """Check the LED strip: light its ends and its middle, then play some rounds of the pointing task.

    Press the key of the rig when the white pixel reaches the middle of the green zone; each press is shown
    in ms after that, early ones with a minus. Exit status 1 if the key line never rose.
    """
    from fdvv_strip.check import check_strip

    def heard(index: int, press: TaskPress) -> None:
        if not as_json:
            click.echo(f"round {index + 1}: {_lateness(press)}")

    with _rendered(device, button) as feed:
        found = check_strip(spec, **asked, heard=heard, meanwhile=feed)
    if as_json:
        ui.print_json(_document(found))
    else:
        _show(found)
    if not found.edges:
        raise ui.failed(f"{spec}: the key line never rose; check its wire and that the rig renders")


@contextmanager
def _rendered(device: str | None, button: str) -> Iterator[Callable[[], None] | None]:
    """Render a button on a device, if there is one; give what keeps it at that."""
    from fdvv.rendering.tuning import program_image
    from fdvv_strip.run import rendering

    if device is None:
        yield None
        return
    with remote(device) as found:
        found.upload_program(program_image(button, ui.SPEEDS_mm_s))
        with rendering(found) as feed:
            yield feed


def _lateness(press: TaskPress) -> str:
    assert press.target_s is not None
    late_ms = [1e3 * (at_s - press.target_s) for at_s in press.activations_s]
    return ", ".join(f"{late:+.2f} ms" for late in late_ms) or "no press"


def _document(found: StripCheck) -> dict[str, Any]:
    return {
        "strip": found.name,
        "simulated": found.simulated,
        "firmware": found.firmware,
        "watchdog_reset": found.was_reset,
        "edges": found.edges,
        "bad_frames": found.bad_frames,
        "asynchrony_ms": found.asynchrony_ms,
        "rounds": [{"target_s": p.target_s, "activations_s": p.activations_s} for p in found.presses],
    }


def _show(found: StripCheck) -> None:
    rows: list[list[object]] = [
        ["firmware", found.firmware],
        ["last reset by the watchdog", "yes" if found.was_reset else "no"],
        ["edges of the key line", found.edges],
        ["damaged requests", found.bad_frames],
        ["mean asynchrony, ms", found.asynchrony_ms],
    ]
    click.echo(f"{found.name}{ui.simulated(found.simulated)}")
    ui.print_table(["what", "value"], rows)
