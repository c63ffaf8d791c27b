"""The live connection of a page: envelopes ``{"channel": …, "body": …}`` in both directions."""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress
from functools import reduce
from operator import or_
from threading import Lock
from typing import Any

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocket, WebSocketDisconnect

from fdvv.errors import FdvvError
from fdvv_studio.studio.auth import SEAT_ONLY
from fdvv_studio.studio.contract import Channel, ChannelKind, Message, Tell, error_line
from fdvv_studio.studio.studio import Studio

WAITING = 4000
"""So many messages may wait for a page; one that does not read is cut off and may come again."""
SLOW, MALFORMED, FORBIDDEN = 4408, 4400, 4403
"""From 4000 on codes are an application's own (RFC 6455, 7.4.2): 4000 + HTTP's status of that meaning."""
log = logging.getLogger("fdvv_studio.studio")


class Envelope(Message):
    """A message of the page, its body still unread."""

    channel: str
    body: msgspec.Raw


class LiveConnection:
    """What serves one page. seat : the word of the seat that it is confined to; empty: to none."""

    def __init__(
        self, studio: Studio, kinds: dict[str, ChannelKind], socket: WebSocket, seat: str = ""
    ) -> None:
        self._studio, self._kinds, self._socket, self._seat = studio, kinds, socket, seat
        self._loop = asyncio.get_running_loop()
        self._outgoing: asyncio.Queue[bytes] = asyncio.Queue(WAITING)
        self._incoming: dict[str, asyncio.Queue[Any]] = {}
        self._workers: list[asyncio.Task[None]] = []
        self._open: list[Channel] = []
        self._over = False
        self._lock = Lock()

    async def serve(self) -> None:
        """Pass messages until the page goes or does what it may not."""
        await self._socket.accept()
        writer = asyncio.create_task(self._write())
        try:
            await self._read()
        finally:
            # without waiting: cancelling this connection cancels every wait in it too
            for task in (writer, *self._workers):
                task.cancel()
            self._loop.run_in_executor(None, self._close)

    async def _read(self) -> None:
        while True:
            message = await self._socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            try:
                text = message.get("text") or message.get("bytes") or b""
                envelope = msgspec.json.decode(text, type=Envelope)
                kind = self._kinds.get(envelope.channel)
                if kind is not None and self._seat and kind.seated is None:
                    await self._socket.close(FORBIDDEN, SEAT_ONLY)
                    return
                if kind is None:
                    raise msgspec.ValidationError(f"there is no channel {envelope.channel!r}")
                ask = msgspec.json.decode(envelope.body, type=reduce(or_, kind.asks))
            except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
                self._say(b"", error=str(error))
                await self._outgoing_done()
                # the page may have gone meanwhile
                with suppress(RuntimeError, WebSocketDisconnect):
                    await self._socket.close(MALFORMED, "a message that is none")
                return
            await self._queue_of(kind).put(ask)

    async def _outgoing_done(self) -> None:
        """Wait briefly until the error is sent before the connection closes."""
        for _ in range(50):
            if self._outgoing.empty():
                return
            await asyncio.sleep(0.01)

    def _queue_of(self, kind: ChannelKind) -> asyncio.Queue[Any]:
        if kind.name not in self._incoming:
            self._incoming[kind.name] = asyncio.Queue(WAITING)
            self._workers.append(asyncio.create_task(self._work(kind, self._incoming[kind.name])))
        return self._incoming[kind.name]

    async def _work(self, kind: ChannelKind, asks: asyncio.Queue[Any]) -> None:
        """Open a channel and hand it its messages one after the other."""

        def tell(message: msgspec.Struct) -> None:
            body = msgspec.json.encode(message)
            # the page, and the whole server, may go while a part still tells
            with suppress(RuntimeError):
                self._loop.call_soon_threadsafe(self._say, body, kind.name)

        channel = await run_in_threadpool(self._open_channel, kind, tell)
        while True:
            ask = await asks.get()
            try:
                await run_in_threadpool(channel.receive, ask)
            except FdvvError as error:
                self._say(b"", kind.name, error_line(error))
            except Exception:
                log.exception("channel %s failed", kind.name)
                self._say(b"", kind.name, f"{kind.name} failed; the studio's terminal tells why")

    def _open_channel(self, kind: ChannelKind, tell: Tell) -> Channel:
        """Open a channel; if the page has gone meanwhile it is closed again."""
        seated = kind.seated if self._seat else None
        channel = seated(self._studio, tell, self._seat) if seated else kind.open(self._studio, tell)
        with self._lock:
            gone = self._over
            if not gone:
                self._open.append(channel)
        if gone:
            channel.close()
        return channel

    def _close(self) -> None:
        with self._lock:
            self._over = True
            channels, self._open = self._open, []
        for channel in channels:
            channel.close()

    def _say(self, body: bytes, channel: str = "studio", error: str = "") -> None:
        if self._over:
            return
        content = {"error": error} if error else {"body": msgspec.Raw(body)}
        try:
            self._outgoing.put_nowait(msgspec.json.encode({"channel": channel, **content}))
        except asyncio.QueueFull:
            # it will connect again and ask for what it missed
            self._workers.append(asyncio.create_task(self._socket.close(SLOW, "the page does not read")))
            self._over = True

    async def _write(self) -> None:
        while True:
            await self._socket.send_text((await self._outgoing.get()).decode())
