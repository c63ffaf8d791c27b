"""Answer a call: read the question within limits, run the part's function, give its answer or one line."""

from __future__ import annotations

import logging

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from fdvv.errors import FdvvError
from fdvv.studio._contract import Call
from fdvv.studio._studio import Studio
from fdvv.studio._told import told

LARGEST_bytes = 8_000_000
"""Of a question: a model of many curves is some hundred kB."""

log = logging.getLogger("fdvv.studio")


class TooLargeError(Exception):
    """A question is beyond LARGEST_bytes."""


async def body_of(request: Request) -> bytes:
    """Read a body that may claim any length, or none, without holding more than is allowed."""
    parts: list[bytes] = []
    size = 0
    async for part in request.stream():
        size += len(part)
        if size > LARGEST_bytes:
            raise TooLargeError
        parts.append(part)
    return b"".join(parts)


def line(reason: str, status: int) -> Response:
    """Give what is wrong as the page shows it."""
    return JSONResponse({"error": " ".join(reason.split())}, status)


async def answer(studio: Studio, call: Call, request: Request) -> Response:
    """Run a call. 400 a question that is none, 413 too large, 422 the person's mistake, 500 ours."""
    if not request.headers.get("content-type", "").startswith("application/json"):
        return line("the question must be application/json", 415)
    try:
        ask = msgspec.json.decode(await body_of(request), type=call.ask)
    except ClientDisconnect:
        return line("the page has gone", 400)
    except TooLargeError:
        return line(f"the question is larger than {LARGEST_bytes // 1_000_000} MB", 413)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        return line(f"{call.name}: {error}", 400)
    try:
        found = await run_in_threadpool(call.function, studio, ask)
    except FdvvError as error:
        return line(told(error), 422)
    except OSError as error:
        log.exception("%s failed", call.name)
        return line(f"{call.name}: {told(error)}", 500)
    except Exception:
        log.exception("%s failed", call.name)
        return line(f"{call.name} failed; the studio's terminal tells why", 500)
    return Response(msgspec.json.encode(found), media_type="application/json")
