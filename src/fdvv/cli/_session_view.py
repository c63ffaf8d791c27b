"""A session on the terminal: a row per velocity that is kept up to date, cues, reasons."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

import click

from fdvv.cli._cue import show_cue
from fdvv.cli._output import number, one_line

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.live import Live

    from fdvv.workflow import Ask, PressDone, Standing

REDRAW_s = 0.1
LINES = 10
"""Where there is no terminal, simulated presses are told in so many lines."""

Cue = Callable[[float, Callable[[str], None]], None]

KEPT = {"compensate": "best", "probe": "median"}
"""What the mean and the largest error of a curve are of."""


class View(Protocol):
    """What shows a session."""

    def ask(self, ask: Ask) -> None:
        """Ask for a press."""
        ...

    def done(self, event: PressDone) -> None:
        """Tell what became of a press."""
        ...

    def notice(self, text: str) -> None:
        """Tell what a person should know."""
        ...


@contextmanager
def session_view(person: bool, quiet: bool) -> Iterator[View]:
    """Show a session on standard error, in place if it is a terminal.

    person : someone presses and is shown the pace; quiet : tell only what a person at a device must know.
    """
    if quiet or not sys.stderr.isatty():
        yield LineView(person, quiet)
        return
    from rich.console import Console
    from rich.live import Live

    with Live(console=Console(stderr=True), auto_refresh=False, transient=True) as live:
        yield TableView(person, live)


class LineView:
    """A line per press of a person, a few lines of simulated ones."""

    def __init__(self, person: bool, quiet: bool) -> None:
        self._person, self._quiet = person, quiet

    def ask(self, ask: Ask) -> None:
        """Ask a person for a press."""
        if self._person:
            click.echo(asked(ask), err=True)

    def done(self, event: PressDone) -> None:
        """Tell of a press, if it is due."""
        step = max(1, event.presses_total // LINES)
        due = self._person or event.skipped or event.presses_done % step == 0
        if due and (self._person or not self._quiet):
            click.echo(told(event), err=True)

    def notice(self, text: str) -> None:
        """Tell it; where only a document is wanted, warnings alone."""
        if not self._quiet or text.startswith("warning: "):
            click.echo(one_line(text), err=True)


class TableView:
    """A row per velocity, the last press and the cue below them, redrawn in place."""

    def __init__(self, person: bool, live: Live, cue: Cue = show_cue) -> None:
        self._person, self._live, self._cue = person, live, cue
        self._rows: tuple[Standing, ...] = ()
        self._line, self._kept, self._drawn_s = "", "best", 0.0

    def ask(self, ask: Ask) -> None:
        """Show a person the pace."""
        if self._person:
            self._cue(ask.travel_mm / ask.velocity_mm_s, lambda cue: self._draw(asked(ask), cue))
            self._draw(asked(ask), "press now")

    def done(self, event: PressDone) -> None:
        """Tell of a press; simulated ones come faster than anyone reads."""
        self._line, self._kept = told(event), KEPT[event.stage]
        if self._person or event.skipped or time.monotonic() - self._drawn_s > REDRAW_s:
            self._rows = event.standing()
            self._draw()
            self._drawn_s = time.monotonic()

    def notice(self, text: str) -> None:
        """Tell it above the rows."""
        self._live.console.print(one_line(text), highlight=False, markup=False)

    def _draw(self, *lines: str) -> None:
        self._live.update(picture(self._rows, self._kept, (self._line, *lines)), refresh=True)


def asked(ask: Ask) -> str:
    """Say what is wanted."""
    stroke_ms = 1000 * ask.travel_mm / ask.velocity_mm_s
    return (
        f"press {ask.number} of {ask.total}: {ask.velocity_mm_s:g} mm/s, "
        f"{ask.travel_mm:.1f} mm in {stroke_ms:.0f} ms, down to the stop and let go"
    )


def told(event: PressDone) -> str:
    """Say what became of a press."""
    at = f"{event.presses_done} of {event.presses_total}, {event.velocity_mm_s:g} mm/s"
    if event.skipped:
        return one_line(f"{at}: not used, {event.skipped}")
    found = [f"achieved {event.achieved_mm_s:.0f} mm/s"] if math.isfinite(event.achieved_mm_s) else []
    return one_line(f"{at}: {'; '.join([*found, *([event.told] if event.told else [])])}")


def picture(rows: tuple[Standing, ...], kept: str, lines: tuple[str, ...]) -> RenderableType:
    """Lay out the rows and the lines below them."""
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column("velocity")
    figures = [
        name for stroke in ("press", "release") for name in (f"{stroke}: last", f"{kept} mean", "max cN")
    ]
    for name in ("presses", *figures):
        table.add_column(name, justify="right")
    for row in rows:
        table.add_row(*cells(row))
    return Group(table, *(Text(line) for line in lines))


def cells(row: Standing) -> list[str]:
    """Give the row of a velocity: error_k of the last press, mean and largest error of what is kept."""
    wanted = "" if row.wanted is None else f"/{row.wanted}"
    found = [f"{row.velocity_mm_s:g} mm/s", f"{row.made}{wanted}"]
    for stroke in ("press", "release"):
        curve = next((c for c in row.curves if str(c.stroke) == stroke and c.error_cN), None)
        figures = (curve.error_cN[-1], curve.mean_error_cN, curve.max_error_cN) if curve else (None,) * 3
        found += [number(value, 1) for value in figures]
    return found
