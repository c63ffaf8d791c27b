"""The group of commands; each is imported only when it is run, so that help stays fast."""

from __future__ import annotations

import errno
import io
import os
import shlex
import sys
from typing import Any, NoReturn

import click

from fdvv import extras
from fdvv._version import __version__
from fdvv.cli import ui
from fdvv.errors import BuildError, DeviceError, FdvvError, InputError, SettingError, WorkerError
from fdvv.force_text import UNITS, shown_in

COMMANDS = {
    "assign": ("fdvv.cli.models", "Assign a curve, or a segment of one, to press or release of a model."),
    "capture": ("fdvv.cli.bench.capture", "Record a button: a guided session of presses at several paces."),
    "check": ("fdvv.cli.check", "Check files: what each is, whether it is whole, and what it holds."),
    "compare": ("fdvv.cli.show", "Compare buttons: landmarks side by side and force differences."),
    "compensate": (
        "fdvv.cli.rendering.compensate",
        "Learn the actuation that makes a rig feel like a model.",
    ),
    "demo": ("fdvv.cli.demo", "Run the whole chain on the simulated rig and write a report."),
    "device": (
        "fdvv.cli.device.device",
        "Work with a device: look at it, press it, set it, check it, or make one of your own.",
    ),
    "export": ("fdvv.cli.models", "Write a button, its vibration or a recording for another program."),
    "feasible": (
        "fdvv.cli.rendering.feasible",
        "Check whether a rig can render a button, and why not, before any upload.",
    ),
    "fit": ("fdvv.cli.fit", "Fit measured force curves: one file, or every file of a folder."),
    "import": ("fdvv.cli.models", "Read a file of another program into a model."),
    "join": ("fdvv.cli.bench.process", "Join logs of instruments that ran at once into a recording."),
    "merge": ("fdvv.cli.models", "Merge force curves at several velocities into one FDVV model."),
    "probe": ("fdvv.cli.rendering.compensate", "Measure on fresh presses how well a rig renders a model."),
    "process": (
        "fdvv.cli.bench.process",
        "Turn recorded presses into a model, with its spread over presses.",
    ),
    "program": ("fdvv.cli.program", "Work with programs: list, show, make, check, compile, render."),
    "show": ("fdvv.cli.show", "Show landmarks and curves of a button."),
    "tune": ("fdvv.cli.rendering.tune", "Tune the vibration of a button's press with a person."),
    "vibration": (
        "fdvv.cli.vibration",
        "Show a button's vibrations, or the modes in the sound of a key press.",
    ),
}
"""By name: the module that defines a command, and the first line of its help."""

GROUPS = {
    "Every day": (
        "studio",
        "demo",
        "show",
        "compare",
        "fit",
        "capture",
        "press",
        "compensate",
        "optimize",
        "study",
    ),
    "Models and files": ("library", "merge", "assign", "vibration", "import", "export", "check"),
    "Recordings": ("process", "join"),
    "Rigs": ("device", "feasible", "probe", "tune", "program"),
    "Other programs": ("serve",),
    "Many at once": ("sweep",),
}
"""The commands as help lists them, where they are installed; those of other packages come last."""


class MainGroup(ui.LazyGroup):
    """A group that knows also the short helps of its commands without importing them."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        helps = command_helps()
        listed = {name for names in GROUPS.values() for name in names}
        width = max(map(len, helps))
        for title, names in {**GROUPS, "Extras": tuple(sorted(helps.keys() - listed))}.items():
            if rows := [(name.ljust(width), helps[name]) for name in names if name in helps]:
                with formatter.section(title):
                    formatter.write_dl(rows)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; click would turn Ctrl-C into an empty line of its own."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt as stop:
            raise Interrupted(*stop.args) from None


def command_helps() -> dict[str, str]:
    """Return the first line of the help of every command that is installed; imports none of them."""
    lines = {name: line for name, (_, line) in COMMANDS.items()}
    for package in extras.installed("command_help"):
        lines |= extras.load("command_help", package)
    return lines


class Interrupted(Exception):  # noqa: N818 - nothing failed
    """The person pressed Ctrl-C; the text, if there is one, says what was kept."""


@click.group(
    cls=MainGroup,
    modules={name: module for name, (module, _) in COMMANDS.items()},
    extra="commands",
    context_settings={"help_option_names": ["-h", "--help"]},
    invoke_without_command=True,
)
@click.version_option(__version__, prog_name="fdvv")
@click.option(
    "--force-unit",
    type=click.Choice(UNITS),
    default="cN",
    envvar="FDVV_FORCE_UNIT",
    show_default=True,
    help="Of the forces that are shown; FDVV_FORCE_UNIT sets it too; figures in JSON and files stay in cN.",
)
@click.pass_context
def cli(ctx: click.Context, force_unit: str) -> None:
    """Capture, model, render and compare the feel of push-buttons."""
    ctx.with_resource(shown_in(force_unit))
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help(), err=True)
        ctx.exit(2)


def main() -> NoReturn:
    """Run the command line; exit 0 done, 1 missed a bound or failed, 2 unusable input, 130 interrupted."""
    # matrices here are small: threads of BLAS would only wait for each other. NumPy is not yet imported
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    ui.documents["printed"] = 0
    if isinstance(sys.stdout, io.TextIOWrapper):
        # a pipe of Windows does not know every sign: a question mark is better than none of the rest
        sys.stdout.reconfigure(errors="replace")
    try:
        # click gives the status of an Exit, and None or whatever a command returns otherwise
        status = _run(sys.argv[1:])
        sys.exit(status if isinstance(status, int) else 0)
    except click.UsageError as error:
        _stop(2, _usage(error))
    except click.ClickException as error:
        _stop(2, error.format_message())
    except SettingError as error:
        refused = error.as_option()
        _stop(2, str(refused), refused)
    except FdvvError as error:
        _stop(1 if isinstance(error, BuildError | DeviceError | WorkerError) else 2, str(error), error)
    except OSError as error:
        _stop(2, _system(error))
    except (Interrupted, KeyboardInterrupt, click.Abort) as stop:
        _stop(130, str(stop) or "interrupted")


def _run(arguments: list[str]) -> Any:
    """Run the command; on a terminal a person is asked for the arguments that are missing."""
    while True:
        try:
            return cli.main(arguments, prog_name="fdvv", standalone_mode=False)
        except click.MissingParameter as error:
            if not (isinstance(error.param, click.Argument) and sys.stdin.isatty() and sys.stderr.isatty()):
                raise
            arguments = [*arguments, *_asked(error.param)]


def _asked(argument: click.Argument) -> list[str]:
    """Ask for an argument; of several, each is a word as a shell would split them."""
    name = argument.human_readable_name.lower().removesuffix("...")
    typed = str(click.prompt(name, err=True))
    return shlex.split(typed) if argument.nargs != 1 else [typed]


def _stop(status: int, reason: str, error: FdvvError | None = None) -> NoReturn:
    line = " ".join(reason.split())
    if "--json" in sys.argv[1:] and not ui.documents["printed"]:
        ui.print_json({"error": {"message": line, "status": status, **_parts(error)}})
    ui.print_stderr(f"fdvv: {line}")
    sys.exit(status)


def _parts(error: FdvvError | None) -> dict[str, Any]:
    if not isinstance(error, InputError):
        return {}
    names = ("source", "place", "reason", "remedy")
    return {**{name: getattr(error, name) for name in names}, **error.details}


def _usage(error: click.UsageError) -> str:
    command = error.ctx.command_path if error.ctx else "fdvv"
    return f"{error.format_message().rstrip('.')}; see {command} --help"


def _system(error: OSError) -> str:
    path = error.filename2 or error.filename
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    remedy = "make room on the disk" if full else "check the path and its permissions"
    return f"{f'{path}: ' if path else ''}{error.strerror or error}; {remedy}"
