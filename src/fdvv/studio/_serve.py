"""Run the studio on this machine until it is interrupted."""

from __future__ import annotations

import socket
from collections.abc import Callable
from contextlib import suppress

from fdvv.errors import InputError
from fdvv.studio._app import create_app
from fdvv.studio._guard import Door
from fdvv.studio._kept_token import new_token
from fdvv.studio._studio import Studio

LARGEST_MESSAGE_bytes = 2_000_000


def listen(host: str, port: int) -> socket.socket:
    """Take a port; 0 takes any free one. Raises InputError if it cannot be had."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio sends at once only where TCP is named; else the end of an answer waits 40 ms for the page
    taken = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        taken.bind((host, port))
    except OSError as error:
        taken.close()
        remedy = "choose another --port, or 0 for any that is free"
        raise InputError("--port", f"{host}:{port}", error.strerror or str(error), remedy) from error
    return taken


def door_of(host: str, port: int, token: str | None = None) -> Door:
    """Make the door of a studio at a port. token : that opens it; none: a fresh one."""
    names = {"127.0.0.1", "localhost", "[::1]", f"[{host}]" if ":" in host else host}
    return Door(frozenset(f"{name}:{port}" for name in names), token or new_token(), f"fdvv-{port}")


def serve(studio: Studio, host: str, port: int, ready: Callable[[str], None], token: str = "") -> None:
    """Serve a studio until Ctrl-C or SIGTERM.

    ready : called with the address to open, once it can be opened. token : that opens it; empty: a fresh
    one. Raises InputError, BuildError.
    """
    import uvicorn

    taken = listen(host, port)
    port = taken.getsockname()[1]
    door = door_of(host, port, token)
    shown = f"[{host}]" if ":" in host else host
    config = uvicorn.Config(
        create_app(studio, door),
        log_level="warning",
        ws="websockets-sansio",
        ws_max_size=LARGEST_MESSAGE_bytes,
        timeout_graceful_shutdown=3,
        server_header=False,
    )

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            ready(f"http://{shown}:{port}/?token={door.token}")

    # uvicorn ends in order and then raises Ctrl-C once more; here that is how a studio ends
    with suppress(KeyboardInterrupt):
        Server(config).run(sockets=[taken])
