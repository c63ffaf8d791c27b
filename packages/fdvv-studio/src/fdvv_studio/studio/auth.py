"""Access to the studio: only its own page, opened with the printed token.

A page of another site can send requests to this machine's ports, and a name of another site can be made to
point here (DNS rebinding). So the Host must be ours, a cookie counts only from our own Origin, and nothing at
all is served without the token. A token can be stored in the project: then the address survives a restart.

The address of a **seat** opens one participant's screen: the page's files, and one channel of the live
connection. Everything else answers 403 to it.
"""

from __future__ import annotations

import hmac
import html
import os
import re
import secrets
import stat
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from starlette.requests import HTTPConnection, Request
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fdvv.errors import InputError
from fdvv.io.files import sync_folder, write_atomic

CLOSED = 4401
"""Code of a live connection that was refused."""

HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
        "connect-src 'self'; media-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; "
        "form-action 'none'"
    ),
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}

SEAT_ONLY = "This address opens one participant's screen and nothing else."
NO_SEAT = "This invitation is none of this studio's any more: ask for another."
ON = '<!doctype html><meta http-equiv="refresh" content="0;url=/"><title>fdvv studio</title>'
NO_ORIGIN = "the Origin header is missing"
NO_TOKEN = "Only its owner may open this studio: open the whole address that `fdvv studio` printed."


@dataclass(frozen=True)
class ServerAddress:
    """Where the studio is, and what opens it.

    hosts : values of the Host header that mean this studio, such as ``127.0.0.1:8765``.
    token : the secret of this run.
    cookie : name of the cookie that holds it; cookies do not know ports, so the port is in the name.
    seats : says whether a word opens a seat.
    """

    hosts: frozenset[str]
    token: str
    cookie: str
    seats: Callable[[str], bool] = lambda _word: False

    @property
    def seat_cookie(self) -> str:
        return f"{self.cookie}-seat"

    def seat_of(self, connection: HTTPConnection) -> str:
        """Return the word of the seat that a connection is confined to; empty where it is not, or is none.

        A seat in the address counts before the studio's own token: the page of a seat uses no more than that.
        """
        asked = connection.query_params.get("seat", "")
        if not asked and self._owner(connection):
            return ""
        words = (asked, _bearer(connection), connection.cookies.get(self.seat_cookie, ""))
        return next((word for word in words if word and self.seats(word)), "")

    def _owner(self, connection: HTTPConnection) -> bool:
        return self._same(_bearer(connection)) or self._same(connection.cookies.get(self.cookie, ""))

    def refusal(self, connection: HTTPConnection, changes: bool) -> str:
        """Return why a connection is refused; empty if it may pass.

        changes : it could change something or stay open, so a browser must prove where it comes from.
        """
        headers = connection.headers
        host = headers.get("host", "")
        if host not in self.hosts:
            return "the Host header is not this studio's; open the address that `fdvv studio` printed"
        ours = headers.get("origin", f"http://{host}") == f"http://{host}"
        if not ours or headers.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return "the request comes from another site"
        if seat := self.seat_of(connection):
            if connection.scope["type"] == "http" and connection.scope["method"] not in ("GET", "HEAD"):
                return SEAT_ONLY
            return "" if not changes or "origin" in headers or _bearer(connection) == seat else NO_ORIGIN
        if self._same(_bearer(connection)):
            return ""
        if not self._same(connection.cookies.get(self.cookie, "")):
            return NO_TOKEN
        return NO_ORIGIN if changes and "origin" not in headers else ""

    def _same(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    def enter(self, request: Request) -> Response | None:
        """Take the token of the printed address into a cookie; None if the address carries none."""
        given = request.query_params.get("token")
        if given is None or request.method != "GET" or request.url.path != "/":
            return None
        if not self._same(given) or request.headers.get("host", "") not in self.hosts:
            return PlainTextResponse(NO_TOKEN, 403)
        # a file that the studio wrote opened this: only a page of our own may go on, with the cookie
        ours = request.headers.get("sec-fetch-site", "none") in ("none", "same-origin")
        answer = RedirectResponse("/", 303) if ours else HTMLResponse(ON)
        answer.set_cookie(self.cookie, self.token, httponly=True, samesite="strict", path="/")
        return answer

    def sit(self, request: Request) -> str | None:
        """Return the word of the seat that an address names; None if it names none, empty: a wrong one."""
        word = request.query_params.get("seat")
        if word is None or request.method != "GET" or request.url.path != "/":
            return None
        return word if self.seats(word) and request.headers.get("host", "") in self.hosts else ""


def _bearer(connection: HTTPConnection) -> str:
    return connection.headers.get("authorization", "").removeprefix("Bearer ")


class AuthMiddleware:
    """ASGI middleware that lets nothing pass that is not of the studio's owner."""

    def __init__(self, app: ASGIApp, door: ServerAddress) -> None:
        self.app, self.door = app, door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, or pass on with the headers that keep the page to itself."""
        if scope["type"] == "websocket" and self.door.refusal(HTTPConnection(scope), changes=True):
            await receive()
            await send({"type": "websocket.close", "code": CLOSED, "reason": "not this studio's page"})
            return
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        request = Request(scope, receive)
        answer, seat = self.door.enter(request), self.door.sit(request)

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = {name for name, _ in message["headers"]}
                extra = [(k.encode(), v.encode()) for k, v in HEADERS.items() if k.encode() not in own]
                message["headers"] = [*message["headers"], *extra, *self._cookie(seat)]
            await send(message)

        if seat is not None:
            # the first page of a seat may be opened from anywhere, as the printed address may
            answer = None if seat else PlainTextResponse(NO_SEAT, 403)
        elif answer is None and (reason := self.door.refusal(request, request.method not in ("GET", "HEAD"))):
            answer = PlainTextResponse(reason, 403)
        await (answer or self.app)(scope, receive, send_with_headers)

    def _cookie(self, seat: str | None) -> list[tuple[bytes, bytes]]:
        if not seat:
            return []
        answer = Response()
        answer.set_cookie(self.door.seat_cookie, seat, httponly=True, samesite="strict", path="/")
        return [(name, value) for name, value in answer.raw_headers if name == b"set-cookie"]


TOKEN_FILE, IGNORE_FILE = ".studio-token", ".gitignore"
OPENING_FILE = ".studio-open.html"
TOKEN = re.compile(r"[A-Za-z0-9_-]{32,64}")
REMEDY = "delete it: the next start draws another, and the old address opens nothing"


def new_token() -> str:
    return secrets.token_urlsafe(24)


def project_token(project: Path, name: str = TOKEN_FILE) -> str:
    """Return the token that a project keeps in a file; draw it when it is first asked for.

    InputError where others can read it, or where it is none. OSError.
    """
    path = project / name
    project.mkdir(parents=True, exist_ok=True)
    try:
        # readable by its owner only, from the moment it exists
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        return _read(path)
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        stream.write(token := new_token())
        stream.flush()
        os.fsync(stream.fileno())
    if not (project / IGNORE_FILE).exists():
        # projects are put under version control
        write_atomic(project / IGNORE_FILE, f"{name}\n")
    sync_folder(project)
    return token


@contextmanager
def opening_file(project: Path) -> Iterator[Callable[[str], Path]]:
    """Offer to write a page that leads to an address, for a browser to open; it is removed behind the block.

    What a browser is started with everybody on the machine can read in the list of processes; the file only
    this account. It lies in the project where there is one: some browsers see no temporary folder. OSError.
    """
    pages: list[Path] = []

    def write_page(address: str) -> Path:
        folder = project if project.is_dir() else Path(tempfile.mkdtemp(prefix="fdvv-"))
        pages.append(folder / OPENING_FILE)
        text = f'<!doctype html><meta http-equiv="refresh" content="0;url={html.escape(address)}">\n'
        write_atomic(pages[-1], text, private=True)
        return pages[-1]

    try:
        yield write_page
    finally:
        for page in pages:
            page.unlink(missing_ok=True)
            if page.parent != project:
                with suppress(OSError):
                    page.parent.rmdir()


def _read(path: Path) -> str:
    about = path.stat(follow_symlinks=False)
    if not stat.S_ISREG(about.st_mode):
        raise InputError(path, "whole file", "is no plain file", REMEDY)
    # Windows knows no such permissions
    if os.name == "posix" and about.st_mode & 0o077:
        raise InputError(path, "permissions", "others on this machine can read it", REMEDY)
    token = path.read_text(encoding="utf-8", errors="replace").strip()
    if not TOKEN.fullmatch(token):
        raise InputError(path, "whole file", "holds no token", REMEDY)
    return token
