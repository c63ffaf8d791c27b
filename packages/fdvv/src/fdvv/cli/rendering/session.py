"""What fdvv compensate and probe share: the device, the speeds, and the session that presses are kept in."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.cli.cue import show_cue
from fdvv.cli.options import closing, packed
from fdvv.force_text import ForceTitle, force_number, force_text, force_unit
from fdvv.rendering.settings import PressSettings

if TYPE_CHECKING:
    from rich.live import Live

    from fdvv.device.contract import Device
    from fdvv.rendering.session import Session
    from fdvv.rendering.session_run import Guide, PressDone, PressRequest, VelocityProgress

REDRAW_s = 0.1
Cue = Callable[[float, Callable[[str], None]], None]
KEPT = {"compensate": "best", "probe": "median"}
"""What the mean and the largest error of a curve are of."""


@contextmanager
def session_view(person: bool, quiet: bool, verbose: bool = False) -> Iterator[LineView | TableView]:
    """Show a session on standard error, in place if it is a terminal.

    person : someone presses and is shown the pace; quiet : tell only what a person at a device must know;
    verbose : show every simulated press and the table of velocities, not one line of progress.
    """
    with nullcontext() if quiet else ui.live() as live:
        yield LineView(person, quiet, verbose) if live is None else TableView(person, live, verbose=verbose)


class LineView:
    """A line per press of a person; of simulated ones those that were not used, and the last."""

    def __init__(self, person: bool, quiet: bool, verbose: bool = False) -> None:
        self._person, self._quiet, self._verbose = person, quiet, verbose

    def ask(self, ask: PressRequest) -> None:
        if self._person:
            ui.print_stderr(request_line(ask))

    def done(self, event: PressDone) -> None:
        last = event.presses_done == event.presses_total
        if (self._person or self._verbose or event.skipped or last) and (self._person or not self._quiet):
            ui.print_stderr(press_line(event))

    def notice(self, text: str) -> None:
        ui.notice(text, self._quiet)


class TableView:
    """The last press in one line, or below a row per velocity and above the cue; redrawn in place."""

    def __init__(self, person: bool, live: Live, cue: Cue = show_cue, verbose: bool = True) -> None:
        self._person, self._live, self._cue = person, live, cue
        self._table = person or verbose
        self._rows: tuple[VelocityProgress, ...] = ()
        self._line, self._kept, self._drawn_s = "", "best", 0.0

    def ask(self, ask: PressRequest) -> None:
        if self._person:
            self._cue(ask.travel_mm / ask.velocity_mm_s, lambda cue: self._draw(request_line(ask), cue))
            self._draw(request_line(ask), "press now")

    def done(self, event: PressDone) -> None:
        """Report a press; simulated ones come faster than anyone reads."""
        self._line, self._kept = press_line(event), KEPT[event.stage]
        if self._person or event.skipped or time.monotonic() - self._drawn_s > REDRAW_s:
            self._rows = event.progress()
            self._draw()
            self._drawn_s = time.monotonic()

    def notice(self, text: str) -> None:
        self._live.console.print(ui.one_line(text), highlight=False, markup=False)

    def _draw(self, *lines: str) -> None:
        from rich.console import Group
        from rich.text import Text

        if not self._table:
            self._live.update(Text(self._line, no_wrap=True, overflow="ellipsis"), refresh=True)
            return
        errors = (f"{self._kept} mean", f"max {force_unit()}")
        columns = ["velocity", "presses", "press: last", *errors, "release: last", *errors]
        table = ui.rich_table(columns, map(cells, self._rows))
        self._live.update(Group(table, *map(Text, (self._line, *lines))), refresh=True)


def request_line(ask: PressRequest) -> str:
    stroke_ms = 1000 * ask.travel_mm / ask.velocity_mm_s
    return (
        f"press {ask.number} of {ask.total}: {ask.velocity_mm_s:g} mm/s, "
        f"{ask.travel_mm:.1f} mm in {stroke_ms:.0f} ms, down to the stop and let go"
    )


def press_line(event: PressDone) -> str:
    at = f"{event.presses_done} of {event.presses_total}, {event.velocity_mm_s:g} mm/s"
    if event.skipped:
        return ui.one_line(f"{at}: not used, {event.skipped}")
    found = [f"achieved {event.achieved_mm_s:.0f} mm/s"] if math.isfinite(event.achieved_mm_s) else []
    return ui.one_line(f"{at}: {'; '.join([*found, *([event.message] if event.message else [])])}")


def cells(row: VelocityProgress) -> list[str]:
    """Return the row of a velocity: error_k of the last press, mean and largest error of what is kept."""
    wanted = "" if row.wanted is None else f"/{row.wanted}"
    found = [f"{row.velocity_mm_s:g} mm/s", f"{row.made}{wanted}"]
    for stroke in ("press", "release"):
        curve = next((c for c in row.curves if str(c.stroke) == stroke and c.error_cN), None)
        figures = (curve.error_cN[-1], curve.mean_error_cN, curve.max_error_cN) if curve else (None,) * 3
        found += ["–" if value is None else force_number(value, ".1f") for value in figures]
    return found


RECOMMENDED_ON = ("twin", "host")
"""Devices that simulate whatever rig is named; the others have one."""


def recommended_for(device: str) -> Path | None:
    """Return the rig to simulate where none is named; None for a device that has its own."""
    from fdvv.twin.files import FIRST_RIG, rig_files

    return rig_files()[FIRST_RIG] if device in RECOMMENDED_ON else None


@dataclass(frozen=True)
class Pressing:
    """The device that presses, and where the presses are kept."""

    device: str
    rig: Path | None
    finger: Path | None
    folder: Path | None
    verbose: bool = False

    def on_recommended_rig(self) -> Pressing:
        """Return the same on the recommended rig, if a device that can simulate it has no other."""
        if self.rig or self._began_without_rig():
            return self
        return replace(self, rig=recommended_for(self.device))

    def _began_without_rig(self) -> bool:
        """Whether the presses in the folder were made on the twin's own rig, as before 0.2."""
        from fdvv.rendering.session import MANIFEST, read_manifest

        if not (self.folder and (self.folder / MANIFEST).is_file()):
            return False
        return "rig_toml_sha256" not in read_manifest(self.folder / MANIFEST).device

    def session(self, settings: PressSettings, default: Path) -> Session:
        """Choose where presses are kept; default is the folder for a person's. InputError if it cannot be."""
        from fdvv.compensation.presses import AcceptanceLimits
        from fdvv.device.open import is_manual
        from fdvv.rendering.session import Session

        folder = self.folder or (default if is_manual(self.device) else None)
        if folder:
            ui.check_folder(folder)
        limits = AcceptanceLimits(pace_ratio=settings.pace_ratio)
        return Session(folder, settings.seed, self.rig, self.finger, limits)

    @contextmanager
    def guided(self, session: Session, as_json: bool) -> Iterator[tuple[Device, LineView | TableView, Guide]]:
        """Open the device, show the session, and let the device go at the end, whatever happens."""
        from fdvv.device.open import is_manual
        from fdvv.rendering.session_run import Guide

        with (
            closing(session.open_device(self.device)) as found,
            session_view(is_manual(self.device), as_json, self.verbose) as view,
        ):
            yield found, view, Guide(view.ask, view.notice)


session_options = packed(
    "pressing",
    Pressing,
    ui.option("--device", default="twin", help="'twin' is simulated; see fdvv device."),
    ui.option("--rig", type=ui.RIG, help="Of the twin: a TOML file or a name, recommended unless you say."),
    ui.option("--finger", type=ui.FILE, help="TOML file of the twin's finger."),
    ui.option(
        "--session", "folder", type=ui.PATH,
        help="Folder that keeps every press; name it again to continue where it stopped. Presses by a person "
             "are always kept, beside the result if no folder is named.",
    ),
    ui.verbose_option,
)  # fmt: skip


def beside(result: Path | None, button: str, what: str) -> Path:
    """Name the folder for the presses behind a result: beside its file, else here after the button."""
    name = (result or Path(Path(button).name)).name.partition(".")[0] or "button"
    return (result.parent if result else Path()) / f"{name}.{what}"


LISTED = 10
"""Of the presses that were not used."""


def print_receipt(found: dict[str, Any]) -> None:
    device = f"{found['device']['name']}{ui.simulated(found['simulated'])}"
    click.echo(f"{found['task']} {found['model']['name']} on {device}")
    ui.print_wrapped(f"method: {found['method']}")
    spent = f"{found['pressing_s']:.0f} s of pressing in {ui.counted(len(found['runs']), 'run')}"
    ui.print_wrapped(f"begun {found['begun']}, last press {found['finished'] or '–'}, {spent}")
    for run in found["runs"]:
        made = ", ".join(f"{name} {version}" for name, version in run["versions"].items())
        seed = "" if run["seed"] is None else f"; seed {run['seed']}"
        click.echo(f"run of {run['started']} with {made}{seed}")
    ui.print_wrapped(_rig(found["device"]))
    _print_presses(found)
    if found["task"] == "tune":
        click.echo("run the session's command again for its result, or to go on")
        return
    if not found["curves"]:
        click.echo("not finished; run the session's command again to go on")
        return
    columns = ("presses", "first_cN", "last_cN", "best_cN", "mean_cN", "max_cN")
    ui.print_table(
        ["curve", "presses", *map(ForceTitle, ("first {}", "last {}", "best {}", "mean {}", "max {}"))],
        [[ui.curve_name(c), *(c[k] for k in columns)] for c in found["curves"]],
    )


def _rig(device: dict[str, Any]) -> str:
    facts = [
        f"rig: up to {force_text(device['force_limit_cN'], '.0f')}, {device['travel_limit_mm']:.1f} mm",
        f"{1 / device['tick_s']:.0f} Hz",
    ]
    if "serial" in device:
        version = ".".join(str(device["firmware"] >> shift & 255) for shift in (16, 8, 0))
        facts += [f"serial {device['serial']}, firmware {version}, {len(device['settings'])} settings"]
    facts += [f"{key.partition('_')[0]} file {device[key][:12]}" for key in sorted(device) if "toml" in key]
    return ", ".join(facts)


def _print_presses(found: dict[str, Any]) -> None:
    unused = found["not_used"]
    if found["task"] == "tune":
        click.echo(ui.counted(found["used"], "answer"))
        return
    click.echo(f"{ui.counted(found['used'], 'press')} used, {len(unused)} not")
    for press in unused[:LISTED]:
        ui.print_wrapped(f"  press {press['number']} at {press['velocity_mm_s']:g} mm/s: {press['reason']}")
    if len(unused) > LISTED:
        speeds = Counter(f"{press['velocity_mm_s']:g} mm/s" for press in unused)
        listed = ", ".join(f"{count} at {speed}" for speed, count in speeds.items())
        click.echo(f"  and {len(unused) - LISTED} more; in all {listed}")
