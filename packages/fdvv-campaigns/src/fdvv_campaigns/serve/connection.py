"""One client's connection: requests in, answers and events out.

Requests about runs are answered one after the other, and so are those about the device; the two do not wait
for each other, and `device.stop` waits for nothing.
"""

from __future__ import annotations

import asyncio
import hmac
import logging
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import reduce
from operator import or_
from pathlib import PurePath
from typing import Any, TypeGuard

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocket, WebSocketDisconnect

from fdvv._version import __version__
from fdvv.errors import FdvvError, InputError
from fdvv.model.file import builtin_names
from fdvv.program.library import MAKERS
from fdvv_campaigns.serve import answers as a
from fdvv_campaigns.serve import messages as m
from fdvv_campaigns.serve.rig import RigClient, RigOwnership
from fdvv_campaigns.serve.runs import Runs
from fdvv_people.optimize.engines.registry import engine_names, pair_engine_names
from fdvv_studio.studio.contract import error_line
from fdvv_studio.studio.jobs.check import RIGS

HELLO_s = 5.0
"""Within so long a client says hello."""
WAITING, MOST_CALLS = 4000, 64
"""So many messages may wait for a client that does not read, and so many calls of one for their turn."""
NO_TOKEN, MALFORMED, SLOW, SILENT = 4401, 4400, 4408, 4409
"""Codes with which a connection is closed."""
log = logging.getLogger("fdvv_campaigns.serve")
REQUEST: Any = reduce(or_, m.REQUESTS)


@dataclass(frozen=True)
class Served:
    """What a server offers to all clients."""

    token: str
    runs: Runs
    rig: RigOwnership


class Addressed(msgspec.Struct):
    """The id of a message, whatever else is in it."""

    id: m.Number | None = None


class Connection:
    """What serves one client."""

    def __init__(self, served: Served, socket: WebSocket) -> None:
        self._served, self._socket = served, socket
        self._loop = asyncio.get_running_loop()
        self._outgoing: asyncio.Queue[bytes] = asyncio.Queue(WAITING)
        self._rig = RigClient(served.rig, self._send)
        self._lanes: dict[Callable[[Any], object], asyncio.Queue[m.Request]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._over = False

    async def serve(self) -> None:
        """Pass messages until the client goes; the device it owns falls to zero force then."""
        await self._socket.accept()
        self._start(self._write())
        try:
            if await self._greet():
                await self._read()
        except (WebSocketDisconnect, RuntimeError):
            pass  # it has gone
        finally:
            self._over = True
            for task in self._tasks:
                task.cancel()
            self._rig.gone = True
            # not waited for: to cancel this connection cancels every wait in it
            self._loop.run_in_executor(None, self._rig.close)

    async def _greet(self) -> bool:
        """Wait for hello with the token; nothing else is read before."""
        try:
            hello = self._decode(await asyncio.wait_for(self._socket.receive(), HELLO_s))
        except TimeoutError:
            await self._socket.close(SILENT, "say hello first")
            return False
        if hello is None:
            await self._close(MALFORMED, "a message that is none")
            return False
        if not self._knows(hello):
            remedy = "use the one that fdvv serve printed"
            self._fail(hello.id, InputError("hello", "token", "is not this server's", remedy))
            await self._close(NO_TOKEN, "not this server's token")
            return False
        if hello.protocol != m.PROTOCOL:
            why, remedy = f"this server speaks {m.PROTOCOL}", "use the client of fdvv serve --client"
            self._fail(hello.id, InputError("hello", "protocol", why, remedy))
            await self._close(MALFORMED, "another protocol")
            return False
        self._answer(hello.id, await run_in_threadpool(self._welcome))
        return True

    def _knows(self, hello: m.Request) -> TypeGuard[m.Hello]:
        token = hello.token if isinstance(hello, m.Hello) else ""
        return hmac.compare_digest(token.encode(), self._served.token.encode())

    async def _read(self) -> None:
        while (message := await self._socket.receive())["type"] != "websocket.disconnect":
            ask = self._decode(message)
            if ask is None:
                continue
            if isinstance(ask, m.Hello):
                self._fail(ask.id, InputError("hello", "call", "was said before", "say it once"))
            elif isinstance(ask, m.Clock):
                self._answer(ask.id, a.HostClock(time.monotonic()))
            elif isinstance(ask, m.Stop):
                self._start(self._run(self._rig.answer, ask))
            else:
                self._queue(
                    self._served.runs.answer if isinstance(ask, m.RUN_REQUESTS) else self._rig.answer, ask
                )

    def _decode(self, message: Any) -> m.Request | None:
        """Return the request in a message; None where it is none, which the client is sent."""
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect
        text = message.get("text") or message.get("bytes") or b""
        try:
            request: m.Request = msgspec.json.decode(text, type=REQUEST)
            return request
        except (msgspec.MsgspecError, UnicodeError, RecursionError) as error:
            number = None
            with suppress(msgspec.MsgspecError, UnicodeError, RecursionError):
                number = msgspec.json.decode(text, type=Addressed).id
            reason, _, place = str(error).partition(" - at ")
            remedy = "see docs/reference/serve-messages.md"
            self._fail(number, InputError("message", place.strip("`") or "whole message", reason, remedy))
            return None

    def _queue(self, work: Callable[[Any], object], ask: m.Request) -> None:
        if work not in self._lanes:
            self._lanes[work] = asyncio.Queue(MOST_CALLS)
            self._start(self._work(work, self._lanes[work]))
        try:
            self._lanes[work].put_nowait(ask)
        except asyncio.QueueFull:
            reason = f"{MOST_CALLS} calls are waiting"
            self._fail(ask.id, InputError("message", "call", reason, "wait for their answers"))

    async def _work(self, work: Callable[[Any], object], asks: asyncio.Queue[m.Request]) -> None:
        while True:
            await self._run(work, await asks.get())

    async def _run(self, work: Callable[[Any], object], ask: m.Request) -> None:
        try:
            self._answer(ask.id, await run_in_threadpool(work, ask))
        except (FdvvError, OSError) as error:
            self._fail(ask.id, error)
        except Exception as error:
            log.exception("a call failed")
            self._fail(ask.id, RuntimeError(f"{type(error).__name__}; the server's terminal says more"))

    def _welcome(self) -> a.Welcome:
        served = self._served
        return a.Welcome(
            m.PROTOCOL,
            __version__,
            time.monotonic(),
            engine_names(),
            pair_engine_names(),
            tuple(builtin_names()),
            tuple(sorted(MAKERS)),
            served.rig.devices(),
            RIGS,
            served.runs.names(),
        )

    # -- out -----------------------------------------------------------------------------------------------

    def _answer(self, number: int, result: object) -> None:
        self._put(msgspec.json.encode(a.Result(number, result)))

    def _fail(self, number: int | None, error: Exception) -> None:
        self._put(msgspec.json.encode(a.Failure(number, refusal_of(error))))

    def _send(self, event: msgspec.Struct) -> None:
        """Send an event; any thread may call."""
        body = msgspec.json.encode(event)
        with suppress(RuntimeError):  # the whole server may go meanwhile
            self._loop.call_soon_threadsafe(self._put, body)

    def _put(self, body: bytes) -> None:
        if self._over:
            return
        try:
            self._outgoing.put_nowait(body)
        except asyncio.QueueFull:
            self._over = True
            self._start(self._socket.close(SLOW, "the client does not read"))

    async def _write(self) -> None:
        with suppress(WebSocketDisconnect, RuntimeError):  # it has gone, which the reader sees
            while True:
                body = await self._outgoing.get()
                await self._socket.send_text(body.decode())
                self._outgoing.task_done()

    async def _close(self, code: int, reason: str) -> None:
        with suppress(TimeoutError):
            await asyncio.wait_for(self._outgoing.join(), 1.0)
        await self._socket.close(code, reason)

    def _start(self, work: Any) -> None:
        task = self._loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


def refusal_of(error: Exception) -> a.Refusal:
    """Return an error as its four parts, without paths of this machine."""
    if isinstance(error, InputError):
        return a.Refusal(PurePath(error.source).name, error.place, error.reason, error.remedy)
    line = error_line(error) if isinstance(error, FdvvError | OSError) else str(error)
    reason, _, remedy = line.partition("; ")
    return a.Refusal(type(error).__name__, "", reason, remedy)
