"""The server: the page's files, calls and the live connection, behind the authentication."""

from __future__ import annotations

import asyncio
import gzip
import hashlib
import ipaddress
import logging
import socket
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import PurePath
from threading import Thread

import msgspec
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.middleware import Middleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

from fdvv.errors import BuildError, FdvvError, InputError
from fdvv_studio.studio.auth import AuthMiddleware, ServerAddress, new_token, project_token
from fdvv_studio.studio.contract import Call, error_line
from fdvv_studio.studio.live import LiveConnection
from fdvv_studio.studio.lock import note_address, project_lock
from fdvv_studio.studio.parts import PartLoader
from fdvv_studio.studio.seats import Seats
from fdvv_studio.studio.studio import Studio

TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".json": "application/json",
}


@dataclass(frozen=True)
class PageFile:
    """A file of the page, plain and compressed."""

    media_type: str
    plain: bytes
    packed: bytes
    tag: str


def page_files() -> dict[str, PageFile]:
    """Read the built page. BuildError if this installation has none."""
    folder = resources.files("fdvv_studio.studio").joinpath("static")
    if not folder.joinpath("index.html").is_file():
        raise BuildError("the studio's page is not built; run: make web")
    return {item.name: _read(item.name, item.read_bytes()) for item in folder.iterdir() if item.is_file()}


def _read(name: str, content: bytes) -> PageFile:
    media_type = TYPES.get(PurePath(name).suffix, "application/octet-stream")
    tag = f'"{hashlib.sha256(content).hexdigest()[:16]}"'
    return PageFile(media_type, content, gzip.compress(content, mtime=0), tag)


def file_response(files: dict[str, PageFile], request: Request) -> Response:
    """Return one file; browsers ask again each time and get 304 when nothing changed."""
    file = files.get(request.path_params.get("name") or "index.html")
    if file is None:
        return PlainTextResponse("no such file", 404)
    headers = {"etag": file.tag, "cache-control": "no-cache", "vary": "accept-encoding"}
    if request.headers.get("if-none-match") == file.tag:
        return Response(status_code=304, headers=headers)
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return Response(file.plain, media_type=file.media_type, headers=headers)
    return Response(file.packed, media_type=file.media_type, headers={**headers, "content-encoding": "gzip"})


LARGEST_bytes = 8_000_000
"""Of a question: a model of many curves is some hundred kB."""

call_log = logging.getLogger("fdvv_studio.studio")


async def body_of(request: Request) -> bytes | None:
    """Read a body that may claim any length, or none; None, without holding it, if it is too large."""
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > LARGEST_bytes:
            return None
    return bytes(body)


def error_response(reason: str, status: int) -> Response:
    return JSONResponse({"error": " ".join(reason.split())}, status)


async def answer_call(studio: Studio, call: Call, request: Request) -> Response:
    """Run a call. 400 no question, 413 too large, 422 the person's mistake, 500 ours, 503 closed."""
    if not request.headers.get("content-type", "").startswith("application/json"):
        return error_response("the question must be application/json", 415)
    try:
        body = await body_of(request)
        if body is None:
            return error_response(f"the question is larger than {LARGEST_bytes // 1_000_000} MB", 413)
        ask = msgspec.json.decode(body, type=call.ask)
    except ClientDisconnect:
        return error_response("the page has gone", 400)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        return error_response(f"{call.name}: {error}", 400)
    try:
        answer = await run_in_threadpool(call.function, studio, ask)
    except asyncio.CancelledError:
        # Ctrl-C, and the server has waited long enough; the work itself ends with the process
        return error_response("the studio is closed", 503)
    except FdvvError as error:
        return error_response(error_line(error), 422)
    except OSError as error:
        call_log.exception("%s failed", call.name)
        return error_response(f"{call.name}: {error_line(error)}", 500)
    except Exception:
        call_log.exception("%s failed", call.name)
        return error_response(f"{call.name} failed; the studio's terminal tells why", 500)
    return Response(msgspec.json.encode(answer), media_type="application/json")


def create_app(studio: Studio, door: ServerAddress) -> Starlette:
    """Make the server's application. BuildError if the page is not built.

    Parts are imported while the first page is on its way; a call waits for its own.
    """
    files = page_files()
    loader = PartLoader()
    door = replace(door, seats=lambda word: studio.part(Seats).find(word) is not None)

    async def page(request: Request) -> Response:
        return file_response(files, request)

    async def api(request: Request) -> Response:
        call = await run_in_threadpool(loader.call, request.path_params["name"])
        if call is None:
            return error_response("there is no such call", 404)
        return await answer_call(studio, call, request)

    async def live(socket: WebSocket) -> None:
        parts = await run_in_threadpool(loader.all)
        await LiveConnection(studio, parts.channels, socket, door.seat_of(socket)).serve()

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
    return Starlette(routes=routes, middleware=[Middleware(AuthMiddleware, door=door)], lifespan=lifespan)


LARGEST_MESSAGE_bytes = 2_000_000  # of the live connection: a model of many curves is some hundred kB


def bind_socket(host: str, port: int) -> socket.socket:
    """Take a port; 0 takes any free one. Raises InputError if it cannot be had."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio sends at once only where TCP is named; else the end of an answer waits 40 ms for the page
    taken = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    # a studio that is started again need not wait for the port of its last run
    taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        taken.bind((host, port))
    except OSError as error:
        taken.close()
        remedy = "choose another --port, or 0 for any that is free"
        raise InputError("--port", f"{host}:{port}", error.strerror or str(error), remedy) from error
    return taken


def reachable_hosts(host: str) -> tuple[str, ...]:
    """Return the hosts that a listening address answers to: itself, or for 0.0.0.0 and :: this machine's own.

    Raises InputError if this machine's addresses cannot be found.
    """
    if host == "localhost" or not ipaddress.ip_address(host).is_unspecified:
        return (host,)
    family, unused = (socket.AF_INET6, "2001:db8::1") if ":" in host else (socket.AF_INET, "192.0.2.1")
    addresses: list[str] = []
    with suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as probe:
        # connecting sends nothing; it asks the system which of its addresses would be used
        probe.connect((unused, 9))
        addresses.append(str(probe.getsockname()[0]))
    with suppress(OSError):
        addresses += [str(entry[4][0]) for entry in socket.getaddrinfo(socket.gethostname(), None, family)]
    others = [name for name in dict.fromkeys(addresses) if not ipaddress.ip_address(name).is_loopback]
    if not others:
        reason = "no address of this machine was found that others could reach"
        raise InputError("--host", host, reason, "name the address, such as --host 192.168.1.20")
    return ("::1" if ":" in host else "127.0.0.1", *others)


def address_of(hosts: Sequence[str], port: int, token: str) -> ServerAddress:
    """Make the door of a studio at a port. token : that opens it."""
    names = {"127.0.0.1", "localhost", "[::1]", *map(_bracket, hosts)}
    return ServerAddress(frozenset(f"{name}:{port}" for name in names), token, f"fdvv-{port}")


def serve(
    studio: Studio, host: str, port: int, ready: Callable[[Sequence[str]], None], keep_address: bool = False
) -> None:
    """Serve a studio until Ctrl-C or SIGTERM, the only one of its project.

    ready : called with the addresses that open it, once they do; the first is for this machine.
    keep_address : the token is that of the project, else a fresh one. Raises InputError if the port is taken
    or another studio has the project, BuildError.
    """
    hosts = reachable_hosts(host)
    with project_lock(studio.project) as lock, bind_socket(host, port) as taken:
        token = project_token(studio.project) if keep_address else new_token()
        door = address_of(hosts, taken.getsockname()[1], token)
        places = [f"http://{_bracket(name)}:{taken.getsockname()[1]}" for name in hosts]
        note_address(lock, places[0])
        opened = [f"{place}/?token={token}" for place in places]
        serve_app(create_app(studio, door), taken, lambda: ready(opened))


def _bracket(host: str) -> str:
    return f"[{host}]" if ":" in host else host


def serve_app(app: ASGIApp, taken: socket.socket, ready: Callable[[], None], silent_s: float = 20.0) -> None:
    """Serve an application on a port that is taken, until Ctrl-C or SIGTERM. ready : called once it answers.

    silent_s : a WebSocket whose other end answers no ping for twice so long is closed.
    """
    import uvicorn

    from fdvv_studio.studio.connections import BoundedProtocol

    config = uvicorn.Config(
        app,
        http=BoundedProtocol,
        log_level="warning",
        ws="websockets-sansio",
        ws_max_size=LARGEST_MESSAGE_bytes,
        ws_ping_interval=silent_s,
        ws_ping_timeout=silent_s,
        timeout_graceful_shutdown=3,
        server_header=False,
    )

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            ready()

    # uvicorn ends in order and then raises Ctrl-C once more; here that is how a studio ends
    with suppress(KeyboardInterrupt):
        Server(config).run(sockets=[taken])
