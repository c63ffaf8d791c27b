"""What commands share: JSON, tables and progress."""

from __future__ import annotations

import functools
import importlib
import io
import json
import keyword
import math
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from fdvv import extras
from fdvv.errors import InputError
from fdvv.force_text import ForceTitle, force_of, shown_force, shown_in

if TYPE_CHECKING:
    from rich.live import Live
    from rich.table import Table

Command = TypeVar("Command", bound=Callable[..., Any])

WIDTH = 100
"""Columns that a table should keep to."""

FIGURES = (".svg", ".png", ".pdf")

option = functools.partial(click.option, show_default=True)
"""click.option, with the default in the help text."""


def options(*several: Callable[[Command], Command]) -> Callable[[Command], Command]:
    """Join decorators into one; the first option is listed first."""

    def add(command: Command) -> Command:
        for one in reversed(several):
            command = one(command)
        return command

    return add


class LazyGroup(click.Group):
    """A group that imports some of its commands when they are asked for: they load much that others do not.

    modules : by a command's name, the module with a function of that name. extra : kind of commands that
        extras add to it, if any.
    """

    def __init__(
        self, *args: Any, modules: Mapping[str, str], extra: extras.Kind | None = None, **kwargs: Any
    ) -> None:
        super().__init__(*args, **kwargs)
        self.modules, self.extra = modules, extra

    def list_commands(self, ctx: click.Context) -> list[str]:
        added = extras.installed(self.extra) if self.extra else ()
        return sorted([*super().list_commands(ctx), *self.modules, *added])

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; BuildError if it comes with an extra that is not installed."""
        command: click.Command | None = super().get_command(ctx, cmd_name)
        if cmd_name in self.modules:
            # a function cannot be called import
            function = f"{cmd_name}_" if keyword.iskeyword(cmd_name) else cmd_name
            command = getattr(importlib.import_module(self.modules[cmd_name]), function)
        elif self.extra and not command and cmd_name in extras.names(self.extra):
            # names lists every installed distribution: not worth its time for a command of the core
            command = extras.load(self.extra, cmd_name)
        return command


def choice_option(name: str, choices: Sequence[str], help: str) -> Callable[[Command], Command]:
    """Make an option of a few words; the first is its default."""
    return option(name, type=click.Choice(choices), default=choices[0], help=help)


def _json_in_cN(ctx: click.Context, _param: click.Parameter, as_json: bool) -> bool:
    if as_json:
        ctx.with_resource(shown_in("cN"))
    return as_json


json_option = click.option(
    "--json",
    "as_json",
    is_flag=True,
    is_eager=True,
    callback=_json_in_cN,
    help="Print one JSON document and nothing else.",
)


verbose_option = click.option(
    "-v", "--verbose", is_flag=True, help="Show every step, not one line of progress."
)


documents = {"printed": 0}
"""How many JSON documents this run has printed; a failure adds one of its own only where there is none."""


def print_json(document: dict[str, Any]) -> None:
    """Print one JSON document; numbers that are not finite become null."""
    from fdvv.io.documents import finite

    documents["printed"] += 1
    text = json.dumps(finite(document), indent=2, ensure_ascii=False, allow_nan=False)
    try:
        text.encode(sys.stdout.encoding)
    except UnicodeEncodeError:
        # a file's name may hold what the terminal's encoding, or even UTF-8, cannot
        text = json.dumps(finite(document), indent=2, allow_nan=False)
    click.echo(text)


def number(value: float | None, digits: int = 2) -> str:
    """Write a number for a table; an unknown one is a dash."""
    return "–" if value is None else f"{value:.{digits}f}"


def bump_kept(ratio: float | None) -> str:
    """Write how much of a curve's bump a fit kept."""
    return "no bump" if ratio is None else f"{100 * ratio:.1f} %"


def curve_name(curve: dict[str, Any]) -> str:
    return f"{curve['stroke']} {curve['velocity_mm_s']:g} mm/s"


def with_spread(value: float | None, spread: float | None, digits: int = 2) -> str:
    """Write a number with its standard deviation or error, where there is one."""
    return number(value, digits) if spread is None else f"{number(value, digits)} ± {spread:.{digits}f}"


def one_line(text: str, width: int | None = None) -> str:
    """Make text from a file fit for a terminal: one line, no control characters, at most width long."""
    plain = "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))
    return plain if width is None or len(plain) <= width else plain[: width - 1] + "…"


def print_table(
    columns: Sequence[str], rows: Iterable[Sequence[object]], left: int = 1, digits: Mapping[str, int] = {}
) -> None:
    """Print aligned columns: the first ``left`` ones to the left, the others to the right.

    A float or None is written by ``number``, with the column's digits or 2; a pair is a number and its
    spread; any other cell is written by ``str``. Cells of a column, or a row, with a ForceTitle hold cN.
    """
    texts = [
        [_cell(cell, title, row[0], digits) for cell, title in zip(row, columns, strict=True)] for row in rows
    ]
    table = [[one_line(cell) for cell in row] for row in (columns, *texts)]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for row in table:
        cells = [
            c.ljust(w) if i < left else c.rjust(w) for i, (c, w) in enumerate(zip(row, widths, strict=True))
        ]
        click.echo("  ".join(cells).rstrip())


def _cell(value: object, column: str, row: object, digits: Mapping[str, int]) -> str:
    title = next((one for one in (column, row) if isinstance(one, ForceTitle)), None)
    places = title.digits if title else digits.get(column, 2)
    if title and row is title:
        places += digits.get(column, 2) - 2
    if isinstance(value, tuple):
        middle, spread = (shown_force(one) if title and one is not None else one for one in value)
        return with_spread(middle, spread, places)
    if value is None or isinstance(value, float):
        return number(shown_force(value) if title and value is not None else value, places)
    return str(value)


def print_wrapped(text: str) -> None:
    """Print a sentence over as many lines as it takes, those after the first indented."""
    click.echo(click.wrap_text(one_line(text), WIDTH, subsequent_indent="  "))


def simulated(flag: bool) -> str:
    """Return the mark of what no real rig made."""
    return " (simulated)" if flag else ""


def counted(count: int, noun: str) -> str:
    """Write a number of things: 1 file, 2 files, 3 presses."""
    plural = noun + ("es" if noun.endswith("s") else "s")
    return f"{count} {noun if count == 1 else plural}"


def print_written(*paths: Path | None) -> None:
    """Print which files were written; None stands for one that was not asked for."""
    for path in paths:
        if path:
            click.echo(f"written to {path}")


def print_stderr(text: str) -> None:
    click.echo(text, err=True)


def notice(text: str, quiet: bool) -> None:
    """Print to standard error what a person should know; where only a document is wanted, warnings alone."""
    if not quiet or text.startswith("warning: "):
        print_stderr(one_line(text))


def print_warnings(warnings: Iterable[str]) -> None:
    for warning in warnings:
        print_stderr(f"warning: {one_line(warning)}")


def failed(reason: str, status: int = 1) -> click.exceptions.Exit:
    """Print why a command has failed; raise what is returned."""
    print_stderr(f"fdvv: {reason}")
    return click.exceptions.Exit(status)


class Finite(click.FloatRange):
    """A range of numbers without nan and infinity."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        found = float(super().convert(value, param, ctx))
        if not math.isfinite(found):
            self.fail(f"{value} is not a finite number.", param, ctx)
        return found


class Force(Finite):
    """A force in cN, as the option's name says, or with another unit: 50gf, 0.5N."""

    name = "force"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        try:
            found = force_of(value) if isinstance(value, str) else value
        except ValueError:
            self.fail(f"{value!r} is no force; write 50, 50gf or 0.5N", param, ctx)
        return super().convert(found, param, ctx)


def above_0(most: float | None = None) -> Finite:
    return Finite(min=0, max=most, min_open=True)


PATH = click.Path(path_type=Path)
EXISTING = click.Path(path_type=Path, exists=True)
FILE = click.Path(path_type=Path, exists=True, dir_okay=False)


class RigName(click.ParamType[Path]):
    """A shipped rig by its name, or the TOML file of one."""

    name = "rig"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        if str(value).isidentifier() and not Path(value).exists():
            from fdvv.twin.files import current_rig_name, rig_files

            found, name = rig_files(), str(current_rig_name(value))
            if name not in found:
                self.fail(f"there is no rig {value!r}; name a file, or one of {', '.join(found)}", param, ctx)
            return found[name]
        return FILE.convert(value, param, ctx)


RIG = RigName()
FOLDER = click.Path(path_type=Path, exists=True, file_okay=False)
NEW_FILE = click.Path(path_type=Path, dir_okay=False)
NEW_FOLDER = click.Path(path_type=Path, file_okay=False)
COUNT = click.IntRange(min=0)
POSITIVE = above_0()
rate_option = option(
    "--rate", "rate_Hz", type=above_0(1e9),
    help="Samples per second of a log of bare numbers, which has no time column.",
)  # fmt: skip
SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
SPEED = Finite(min=5, max=500)
"""Mean speed of a stroke, mm/s."""
velocity_option = functools.partial(option, "--velocity", "velocity_mm_s", type=POSITIVE)
speeds_option = functools.partial(option, type=SPEED, multiple=True, default=SPEEDS_mm_s)
PART = Finite(min=0.05, max=1)
STROKE = click.Choice(["press", "release"])


def check_output(path: Path | None, *endings: str) -> None:
    """Refuse at once a file that could not be written after long work. Raises InputError."""
    if path is None:
        return
    allowed = " or ".join(endings)
    if path.is_dir():
        raise InputError(path, "output", "is a folder", f"name a file ending in {allowed}")
    if path.suffix.lower() not in {"." + ending.rpartition(".")[2] for ending in endings}:
        reason = "its name has another ending than what is written"
        raise InputError(path, "output", reason, f"end it in {allowed}")
    check_folder(path.parent)


def check_folder(folder: Path) -> None:
    """Refuse at once a folder that could be neither made nor written to. Raises InputError."""
    there = next(part for part in (folder, *folder.absolute().parents) if part.exists())
    if not there.is_dir():
        raise InputError(there, "output", "is a file, a folder is needed", "name another place")
    if not os.access(there, os.W_OK | os.X_OK):
        raise InputError(there, "output", "may not be written to", "name another place or change permissions")


@contextmanager
def live(per_s: float | None = None) -> Iterator[Live | None]:
    """Yield a part of the terminal that is redrawn in place; None where standard error is no terminal.

    per_s : how often it is redrawn of itself; by default only when it is updated.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.live import Live

    console = Console(stderr=True)
    with Live(
        console=console, auto_refresh=per_s is not None, refresh_per_second=per_s or 4, transient=True
    ) as found:
        yield found


def rich_table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> Table:
    """Lay out rows for ``live``, the first column to the left."""
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for i, name in enumerate(columns):
        table.add_column(name, justify="right" if i else "left")
    for row in rows:
        table.add_row(*row)
    return table


@contextmanager
def progress(label: str, total: int) -> Iterator[Callable[[int, int], None]]:
    """Show a progress bar on standard error if it is a terminal; yield what sets (done, total)."""
    with stages(report=lambda _label: None) as move:
        move(label, 0, total)
        yield functools.partial(move, label)


@contextmanager
def stages(report: Callable[[str], None] = print_stderr) -> Iterator[Callable[[str, int, int], None]]:
    """Show a progress bar for each named stage; yield what sets (label, done, total).

    Where standard error is not a terminal, each label is printed once, as a line.
    """
    if not sys.stderr.isatty():
        print_once = functools.cache(report)
        yield lambda label, _done, _total: print_once(label)
        return
    from rich.console import Console
    from rich.progress import Progress, TaskID

    with Progress(console=Console(stderr=True), transient=True) as bar:
        tasks: dict[str, TaskID] = {}

        def move(label: str, done: int, total: int) -> None:
            if label not in tasks:
                tasks[label] = bar.add_task(label, total=total)
            bar.update(tasks[label], completed=done, total=total)

        yield move


def save_figure(figure: Any, path: Path) -> None:
    """Write a matplotlib figure in the format of the path's ending (FIGURES), whole or not at all."""
    from fdvv.io.files import write_atomic
    from fdvv.report.style import show_force_unit

    show_force_unit(figure)
    buffer = io.BytesIO()
    figure.savefig(buffer, format=path.suffix.lstrip(".").lower(), bbox_inches="tight", dpi=150)
    write_atomic(path, buffer.getvalue())
