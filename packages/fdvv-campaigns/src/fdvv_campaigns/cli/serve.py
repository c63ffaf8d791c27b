"""fdvv serve."""

from __future__ import annotations

from pathlib import Path

import click

from fdvv.cli import ui
from fdvv.force_text import shown_in
from fdvv_campaigns.serve.clients import CLIENTS, copy_client


@click.command()
@ui.option(
    "--project", type=ui.NEW_FOLDER, default=Path("fdvv-studio"), help="Folder of runs and own buttons."
)
@ui.option("--port", type=click.IntRange(0, 65535), default=8378, help="Port; 0 takes a free one.")
@ui.option(
    "--origin",
    "origins",
    multiple=True,
    help="Origin of a web page that may connect, such as http://localhost:8000; native programs need none.",
)
@ui.option(
    "--device",
    "devices",
    multiple=True,
    help="Device that clients may open beside those that are found, such as rig:FILE.py:NAME.",
)
@click.option(
    "--client",
    type=(click.Choice(tuple(CLIENTS)), ui.NEW_FOLDER),
    metavar="LANGUAGE FOLDER",
    help=f"Copy the client for {' or '.join(CLIENTS)} and its example into a folder, and end.",
)
def serve(
    project: Path,
    port: int,
    origins: tuple[str, ...],
    devices: tuple[str, ...],
    client: tuple[str, Path] | None,
) -> None:
    """Let another program optimise, and drive a rig, over a WebSocket of this machine.

    Prints the address and the token, which is kept in a file that only you can read. Every score is on the
    disk before it is answered. A device falls to zero force when its client goes. Ctrl-C ends it.
    """
    if client:
        for path in copy_client(*client):
            click.echo(str(path))
        return
    from fdvv_campaigns.serve.runs import FOLDER
    from fdvv_campaigns.serve.server import TOKEN_FILE
    from fdvv_campaigns.serve.server import serve as serve_project
    from fdvv_studio.studio.studio import Studio

    def ready(address: str, token: str) -> None:
        click.echo(f"serving at {address}")
        click.echo(f"token {token}")
        ui.print_stderr(f"the token is kept in {project / FOLDER / TOKEN_FILE}; Ctrl-C ends it")

    with shown_in("cN"):
        serve_project(Studio(project), port, origins, devices, ready)
    ui.print_stderr("the server has ended; every score is kept")
