"""Who may talk to the studio: its own page, opened with the token that was printed, and nobody else.

A page of another site can send requests to this machine's ports, and a name of another site can be made to
point here (DNS rebinding). So the Host must be ours, a cookie counts only from our own Origin, and nothing at
all is served without the token.
"""

from __future__ import annotations

import hmac
from dataclasses import dataclass

from starlette.datastructures import Headers
from starlette.requests import HTTPConnection, Request
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

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
NO_TOKEN = "Only its owner may open this studio: open the whole address that `fdvv studio` printed."


@dataclass(frozen=True)
class Door:
    """Where the studio is, and what opens it.

    Attributes
    ----------
    hosts : values of the Host header that mean this studio, such as ``127.0.0.1:8765``.
    token : the secret of this run.
    cookie : name of the cookie that holds it; cookies do not know ports, so the port is in the name.
    """

    hosts: frozenset[str]
    token: str
    cookie: str

    def refusal(self, connection: HTTPConnection, changes: bool) -> str:
        """Tell why a connection is refused; empty if it may pass.

        changes : it could change something or stay open, so a browser must prove where it comes from.
        """
        headers = connection.headers
        if headers.get("host", "") not in self.hosts:
            return "the Host header is not this studio's; open the address that `fdvv studio` printed"
        if "origin" in headers and not self._ours(headers):
            return "the request comes from another site"
        if headers.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return "the request comes from another site"
        if self._same(headers.get("authorization", "").removeprefix("Bearer ")):
            return ""
        if not self._same(connection.cookies.get(self.cookie, "")):
            return NO_TOKEN
        return "the Origin header is missing" if changes and "origin" not in headers else ""

    def _ours(self, headers: Headers) -> bool:
        return headers["origin"] == f"http://{headers.get('host', '')}"

    def _same(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    def enter(self, request: Request) -> Response | None:
        """Take the token of the printed address into a cookie; None if the address carries none."""
        given = request.query_params.get("token")
        if given is None or request.method != "GET" or request.url.path != "/":
            return None
        if not self._same(given) or request.headers.get("host", "") not in self.hosts:
            return PlainTextResponse(NO_TOKEN, 403)
        answer = RedirectResponse("/", 303)
        answer.set_cookie(self.cookie, self.token, httponly=True, samesite="strict", path="/")
        return answer


class Guard:
    """ASGI middleware that lets nothing pass a Door that is not its owner's."""

    def __init__(self, app: ASGIApp, door: Door) -> None:
        self.app, self.door = app, door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, or pass on with the headers that keep the page to itself."""
        if scope["type"] == "websocket":
            await self._live(scope, receive, send)
            return
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = {name for name, _ in message["headers"]}
                extra = [(k.encode(), v.encode()) for k, v in HEADERS.items() if k.encode() not in own]
                message["headers"] = [*message["headers"], *extra]
            await send(message)

        request = Request(scope, receive)
        answer = self.door.enter(request)
        if answer is None and (reason := self.door.refusal(request, request.method not in ("GET", "HEAD"))):
            answer = PlainTextResponse(reason, 403)
        await (answer or self.app)(scope, receive, guarded)

    async def _live(self, scope: Scope, receive: Receive, send: Send) -> None:
        if self.door.refusal(HTTPConnection(scope), changes=True):
            await receive()
            await send({"type": "websocket.close", "code": CLOSED, "reason": "not this studio's page"})
            return
        await self.app(scope, receive, send)
