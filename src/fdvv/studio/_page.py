"""The page's files, read once: what is not among them cannot be asked for."""

from __future__ import annotations

import gzip
import hashlib
from dataclasses import dataclass
from importlib import resources

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from fdvv.errors import BuildError

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
    folder = resources.files("fdvv.studio").joinpath("static")
    if not folder.joinpath("index.html").is_file():
        raise BuildError("the studio's page is not built; run: make web")
    return {item.name: _read(item.name, item.read_bytes()) for item in folder.iterdir() if item.is_file()}


def _read(name: str, content: bytes) -> PageFile:
    media_type = TYPES.get(name[name.rfind(".") :], "application/octet-stream")
    tag = f'"{hashlib.sha256(content).hexdigest()[:16]}"'
    return PageFile(media_type, content, gzip.compress(content, mtime=0), tag)


def answer(files: dict[str, PageFile], request: Request) -> Response:
    """Give one file; browsers ask again each time and are told when nothing changed."""
    file = files.get(request.path_params.get("name") or "index.html")
    if file is None:
        return PlainTextResponse("no such file", 404)
    headers = {"etag": file.tag, "cache-control": "no-cache", "vary": "accept-encoding"}
    if request.headers.get("if-none-match") == file.tag:
        return Response(status_code=304, headers=headers)
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return Response(file.plain, media_type=file.media_type, headers=headers)
    return Response(file.packed, media_type=file.media_type, headers={**headers, "content-encoding": "gzip"})
