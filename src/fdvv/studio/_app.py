"""The server: the page's files, calls and the live connection, behind one guard."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from threading import Thread

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket

from fdvv.studio import _page
from fdvv.studio._ask import answer, line
from fdvv.studio._guard import Door, Guard
from fdvv.studio._live import LiveConnection
from fdvv.studio._parts import PartLoader
from fdvv.studio._studio import Studio


def create_app(studio: Studio, door: Door) -> Starlette:
    """Make the server's application. BuildError if the page is not built.

    Parts are imported while the first page is on its way; a call waits for its own.
    """
    files = _page.page_files()
    loader = PartLoader()

    async def page(request: Request) -> Response:
        return _page.answer(files, request)

    async def api(request: Request) -> Response:
        name = request.path_params["name"]
        call = await run_in_threadpool(loader.call, name)
        return await answer(studio, call, request) if call else line("there is no such call", 404)

    async def live(socket: WebSocket) -> None:
        parts = await run_in_threadpool(loader.all)
        await LiveConnection(studio, parts.channels, socket).serve()

    @asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        loading = Thread(target=loader.load, name="parts of the studio")
        loading.start()
        yield
        await run_in_threadpool(loading.join)
        studio.close()

    routes = [
        Route("/", page, methods=["GET"]),
        Route("/{name}", page, methods=["GET"]),
        Route("/api/{name}", api, methods=["POST"]),
        WebSocketRoute("/live", live),
    ]
    return Starlette(routes=routes, middleware=[Middleware(Guard, door=door)], lifespan=lifespan)
