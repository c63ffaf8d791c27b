"""A capture on the terminal: a row per pace that is kept up to date, the moving pace, beeps, verdicts."""

from __future__ import annotations

import math
import statistics
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.cue import BEATS, BEAT_s, FRAME_s, TONES_Hz, bar, beeper, depth_at

if TYPE_CHECKING:
    from rich.live import Live

    from fdvv.bench.capture import TakeDone, TakeRequest, VelocityProgress

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
