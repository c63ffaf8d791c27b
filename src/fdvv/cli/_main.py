"""The group of commands; each is imported only when it is run, so that help stays fast."""

from __future__ import annotations

import importlib
import os
import sys
from typing import NoReturn

import click

from fdvv import __version__
from fdvv.errors import BuildError, DeviceError, FdvvError

COMMANDS = {
    "assign": ("fdvv.cli._models", "Give a curve, or a segment of one, to press or release of a model."),
    "compare": ("fdvv.cli._compare", "Compare buttons: landmarks side by side and force differences."),
    "compensate": ("fdvv.cli._compensate", "Learn the actuation that makes a rig feel like a model."),
    "demo": ("fdvv.cli._demo", "Run the whole chain on the simulated rig and write a report."),
    "fit": ("fdvv.cli._fit", "Fit measured force curves: one file, or every file of a folder."),
    "library": ("fdvv.cli._models", "List the built-in buttons."),
    "merge": ("fdvv.cli._models", "Merge force curves at several velocities into one FDVV model."),
    "probe": ("fdvv.cli._compensate", "Measure on fresh presses how well a rig renders a model."),
    "show": ("fdvv.cli._show", "Show landmarks and curves of a button."),
}


class LazyGroup(click.Group):
    """A group that knows the names and short helps of its commands without importing them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Give the names of the commands."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and give one command."""
        if cmd_name not in COMMANDS:
            return None
        found = getattr(importlib.import_module(COMMANDS[cmd_name][0]), cmd_name)
        assert isinstance(found, click.Command)
        return found

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands from the table above."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in sorted(COMMANDS.items())])


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="fdvv")
def cli() -> None:
    """Capture, model, render and compare the feel of push-buttons."""


def main() -> NoReturn:
    """Run the command line; exit 0 done, 1 missed a bound or failed, 2 unusable input, 130 interrupted."""
    try:
        cli.main(standalone_mode=False)
        status = 0
    except click.exceptions.Exit as stop:
        status = stop.exit_code
    except click.Abort:
        click.echo("fdvv: interrupted", err=True)
        status = 130
    except click.ClickException as error:
        error.show()
        status = error.exit_code
    except FdvvError as error:
        click.echo(f"fdvv: {error}", err=True)
        status = 1 if isinstance(error, BuildError | DeviceError) else 2
    except BrokenPipeError:
        # the reader of a pipe left; point stdout elsewhere so that Python's exit does not complain
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 1
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        click.echo(f"fdvv: {where}{error.strerror or error}; check the path and its permissions", err=True)
        status = 2
    except KeyboardInterrupt:
        click.echo("fdvv: interrupted", err=True)
        status = 130
    sys.exit(status)
