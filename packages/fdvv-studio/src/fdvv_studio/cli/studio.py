"""fdvv studio."""

from __future__ import annotations

import ipaddress
import threading
import webbrowser
from collections.abc import Sequence
from pathlib import Path

import click

from fdvv.cli import ui
from fdvv.errors import InputError
from fdvv.force_text import shown_in


@click.command()
@click.argument("folders", nargs=-1, type=ui.FOLDER, metavar="[FOLDER]...")
@ui.option(
    "--project", type=ui.NEW_FOLDER, default=Path("fdvv-studio"), help="Folder of your buttons and programs."
)
@ui.option(
    "--library",
    "libraries",
    multiple=True,
    type=ui.FOLDER,
    help="Library of these folders (fdvv library build), read instead.",
)
@ui.option("--port", type=click.IntRange(0, 65535), default=8377, help="Port; 0 takes a free one.")
@ui.option("--host", default="127.0.0.1", help="Address to listen on.")
@ui.option("--share", is_flag=True, help="Allow a --host that other machines can reach.")
@ui.option(
    "--keep-address", is_flag=True, help="Keep the address over restarts; its token is saved in the project."
)
@ui.option("--no-browser", is_flag=True, help="Only print the address.")
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
    from fdvv_studio.library.library import Library
    from fdvv_studio.studio.auth import opening_file
    from fdvv_studio.studio.server import serve
    from fdvv_studio.studio.studio import Studio

    _check_host(host, share)
    # refuse at once what the background could not read
    for library in libraries:
        Library(library)

    with opening_file(project) as written:

        def ready(addresses: Sequence[str]) -> None:
            address, *others = addresses
            click.echo(f"the studio is open at {address}")
            for other in others:
                click.echo(f"from other machines at {other}")
            ui.print_stderr("Ctrl-C ends it")
            if not no_browser:
                page = written(address).absolute().as_uri()
                threading.Thread(target=webbrowser.open, args=(page,), daemon=True).start()

        # the page has a unit of its own
        with shown_in("cN"):
            serve(Studio(project, folders, libraries), host, port, ready, keep_address)
    ui.print_stderr("the studio is closed; everything is kept")


def _check_host(host: str, share: bool) -> None:
    try:
        loopback = host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        raise InputError("--host", host, "is no address", "give one such as 127.0.0.1") from None
    if not loopback and not share:
        reason = "other machines could reach it, and what passes is not encrypted"
        raise InputError("--host", host, reason, "add --share if that is wanted")
