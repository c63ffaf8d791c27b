"""The server: one WebSocket on loopback, for native programs and for pages whose origin is named."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator, Callable, Collection
from contextlib import asynccontextmanager

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket

from fdvv.errors import InputError
from fdvv_campaigns.serve.connection import Connection, Served
from fdvv_campaigns.serve.rig import RigOwnership
from fdvv_campaigns.serve.runs import FOLDER, Runs
from fdvv_studio.studio.auth import project_token
from fdvv_studio.studio.parts import prepare_records
from fdvv_studio.studio.server import bind_socket, serve_app
from fdvv_studio.studio.studio import Studio

HOST, PATH = "127.0.0.1", "/fdvv"
TOKEN_FILE = ".serve-token"
SILENT_s = 4.0
"""A client that answers no ping for twice so long is taken as gone."""
ORIGIN = re.compile(r"https?://(\[[0-9a-f:]+\]|[a-z0-9.-]+)(:\d{1,5})?")
FORBIDDEN = 4403  # from 4000 on codes are an application's own (RFC 6455, 7.4.2): 4000 + HTTP's status


def check_origin(origin: str) -> str:
    """Return an origin as browsers send it. InputError on anything else."""
    if not ORIGIN.fullmatch(origin):
        remedy = "give one such as http://localhost:8000; serve a page of a file by python -m http.server"
        raise InputError("--origin", origin, "is no origin of a page", remedy)
    return origin


def create_app(
    studio: Studio, token: str, port: int, origins: Collection[str], devices: Collection[str]
) -> Starlette:
    """Make the application. origins : of pages that may connect. devices : beside those that are found."""
    prepare_records(set())  # while there is one thread
    served = Served(token, Runs(studio), RigOwnership(studio, devices))
    hosts = {f"{name}:{port}" for name in ("127.0.0.1", "localhost")}

    async def connect(socket: WebSocket) -> None:
        origin = socket.headers.get("origin")
        # a name of another site can be made to point here: the Host must be ours as well
        if socket.headers.get("host") not in hosts or (origin is not None and origin not in origins):
            await socket.close(FORBIDDEN)
            return
        await Connection(served, socket).serve()

    @asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        yield
        await run_in_threadpool(studio.close)
        await run_in_threadpool(served.runs.close)

    return Starlette(routes=[WebSocketRoute(PATH, connect)], lifespan=lifespan)


def serve(
    studio: Studio,
    port: int,
    origins: Collection[str],
    devices: Collection[str],
    ready: Callable[[str, str], None],
) -> None:
    """Serve until Ctrl-C or SIGTERM. ready : called with address and token, once the address answers.

    The token is that of the project: a client survives a restart. Raises InputError, OSError.
    """
    known = {check_origin(origin) for origin in origins}
    folder = studio.project / FOLDER
    with bind_socket(HOST, port) as taken:
        token, port = project_token(folder, TOKEN_FILE), taken.getsockname()[1]
        app = create_app(studio, token, port, known, devices)
        serve_app(app, taken, lambda: ready(f"ws://{HOST}:{port}{PATH}", token), SILENT_s)
