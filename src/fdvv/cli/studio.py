"""fdvv studio."""

from __future__ import annotations

import ipaddress
from pathlib import Path

import click

from fdvv.errors import InputError


@click.command()
@click.argument(
    "folders", nargs=-1, type=click.Path(path_type=Path, exists=True, file_okay=False), metavar="[FOLDER]..."
)
@click.option(
    "--project",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("fdvv-studio"),
    show_default=True,
    help="Folder that keeps your buttons and programs; made when needed.",
)
@click.option(
    "--library",
    "libraries",
    multiple=True,
    type=click.Path(path_type=Path, exists=True, file_okay=False),
    help="A library of the folders (fdvv library build): they need not be read again.",
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=8377,
    show_default=True,
    help="Port; 0 takes a free one.",
)
@click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen on.")
@click.option("--share", is_flag=True, help="Allow a --host that other machines can reach.")
@click.option(
    "--keep-address",
    is_flag=True,
    help="Keep the address over restarts, for tablets that stand on it: its token is kept in the project.",
)
@click.option("--no-browser", is_flag=True, help="Only print the address.")
def studio(
    folders: tuple[Path, ...],
    project: Path,
    libraries: tuple[Path, ...],
    port: int,
    host: str,
    share: bool,
    keep_address: bool,
    no_browser: bool,
) -> None:
    """See, edit, press and tune buttons in the browser.

    Serves a page on this machine and opens it. FOLDER: measured switches to search, any number of folders.
    The address holds a token, a new one at each start: whoever has it can use the studio. Ctrl-C ends it;
    everything is kept.
    """
    _check_host(host, share)
    _check_libraries(libraries)
    from fdvv.studio import Studio, kept_token, serve

    def ready(address: str) -> None:
        click.echo(f"the studio is open at {address}")
        click.echo("Ctrl-C ends it", err=True)
        if not no_browser:
            _show(address)

    token = kept_token(project) if keep_address else ""
    serve(Studio(project, folders, libraries), host, port, ready, token)
    click.echo("the studio is closed; everything is kept", err=True)


def _check_host(host: str, share: bool) -> None:
    """Refuse an address that others reach unless that is wanted."""
    try:
        loopback = host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        raise InputError("--host", host, "is no address", "give one such as 127.0.0.1") from None
    if not loopback and not share:
        reason = "other machines could reach it, and what passes is not encrypted"
        raise InputError("--host", host, reason, "add --share if that is wanted")


def _check_libraries(folders: tuple[Path, ...]) -> None:
    """Refuse at once what the background could not read. InputError, BuildError."""
    from fdvv.workflow import Library

    for folder in folders:
        Library(folder)


def _show(address: str) -> None:
    """Open the page, without waiting for the browser."""
    import threading
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
