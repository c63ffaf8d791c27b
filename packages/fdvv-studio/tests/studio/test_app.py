"""The page's files, calls, and what is wrong with them in one line."""

from __future__ import annotations

import gzip
import json
import re
from importlib import resources

import msgspec
import pytest
from starlette.testclient import TestClient

from fdvv import extras
from fdvv._version import __version__
from fdvv.errors import InputError
from fdvv_studio.studio.contract import Call
from fdvv_studio.studio.parts import load_parts
from fdvv_studio.studio.studio import Studio
from tests.studio.conftest import GivenParts

FILES = sorted(f.name for f in resources.files("fdvv_studio.studio").joinpath("static").iterdir())


class Question(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the calls of these tests are asked."""

    number: int = 0


class Answer(msgspec.Struct, frozen=True):
    """What they answer."""

    twice: int


def _twice(_studio: Studio, ask: Question) -> Answer:
    if ask.number == 1:
        raise InputError("/home/person/secret/file.json", "line 1", "is odd", "give an even number")
    if ask.number == 3:
        raise RuntimeError("a fault of ours")
    return Answer(2 * ask.number)


@pytest.fixture(autouse=True)
def _own_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = load_parts()
    calls = {**parts.calls, "test.twice": Call("test.twice", Question, Answer, _twice)}
    monkeypatch.setattr("fdvv_studio.studio.server.PartLoader", lambda: GivenParts(calls, parts.channels))


@pytest.mark.parametrize("name", FILES)
def test_every_file_of_the_page_is_served_as_it_was_built(client: TestClient, name: str) -> None:
    answer = client.get(f"/{name}")
    assert answer.status_code == 200
    assert answer.content == resources.files("fdvv_studio.studio").joinpath("static", name).read_bytes()
    again = client.get(f"/{name}", headers={"if-none-match": answer.headers["etag"]})
    assert again.status_code == 304


def test_no_page_waits_for_more_than_150_kB_of_compressed_script() -> None:
    static = resources.files("fdvv_studio.studio").joinpath("static")
    scripts = {f.name: f.read_text(encoding="utf-8") for f in static.iterdir() if f.name.endswith(".js")}
    sizes = {name: len(gzip.compress(text.encode())) for name, text in scripts.items()}
    pages = re.findall(r"""import\(\s*[`"']\./([\w.-]+\.js)""", "".join(scripts.values()))
    assert "programs.js" in pages

    def loaded(name: str, before: frozenset[str] = frozenset()) -> frozenset[str]:
        for other in re.findall(r"""(?:from|import)\s*["'`]\./([\w.-]+\.js)""", scripts[name]):
            if other not in before:
                before = loaded(other, before | {name})
        return before | {name}

    waits = {page: sum(sizes[name] for name in loaded(page) | {"studio.js"}) for page in pages}
    assert max(waits.values()) < 150_000, waits
    assert min(waits.values()) > sizes["shared.js"]


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml",
        "/%2e%2e/_app.py",
        "/..%2f_app.py",
        "/static/index.html",
        "/_app.py",
        "/%00",
        "/api",
        "//etc/passwd",
    ],
)
def test_nothing_but_the_pages_files_is_served(client: TestClient, path: str) -> None:
    answer = client.get(path)
    assert answer.status_code in (404, 405)
    assert b"fdvv" not in answer.content


def test_the_studio_tells_its_version_and_no_path(client: TestClient, own_studio: Studio) -> None:
    answer = client.post("/api/studio.about", json={}).json()
    named = {"version": __version__, "project": own_studio.project.name}
    assert answer == {**named, "sources": [], "absent": extras.absent("pages")}


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[]", b"null", b'{"number": "x"}', b'{"other": 1}', b"\xff\xfe", b"[" * 100_000]
)
def test_a_question_that_is_none_is_refused_in_one_line(client: TestClient, body: bytes) -> None:
    answer = client.post("/api/test.twice", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 400
    assert "\n" not in answer.json()["error"]
    assert answer.json()["error"].startswith("test.twice: ")


def test_a_form_of_another_site_cannot_ask(client: TestClient) -> None:
    for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data"):
        answer = client.post("/api/test.twice", content=b'{"number": 4}', headers={"content-type": kind})
        assert answer.status_code == 415


def test_a_huge_question_is_refused_without_being_held(client: TestClient) -> None:
    body = json.dumps({"number": 4, "pad": "x" * 8_000_000}).encode()
    answer = client.post("/api/test.twice", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 413
    assert "8 MB" in answer.json()["error"]


def test_a_persons_mistake_is_one_line_without_a_path(client: TestClient) -> None:
    answer = client.post("/api/test.twice", json={"number": 1})
    assert answer.status_code == 422
    assert answer.json() == {"error": "line 1: is odd; give an even number"}


def test_a_fault_of_ours_tells_nothing_of_the_inside(
    client: TestClient, caplog: pytest.LogCaptureFixture
) -> None:
    answer = client.post("/api/test.twice", json={"number": 3})
    assert answer.status_code == 500
    assert "a fault of ours" not in answer.text
    assert "a fault of ours" in caplog.text


def test_an_unknown_call_is_refused(client: TestClient) -> None:
    assert client.post("/api/no.such", json={}).status_code == 404
    assert client.get("/api/test.twice").status_code == 405
