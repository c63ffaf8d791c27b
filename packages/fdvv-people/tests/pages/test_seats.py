"""The address of a seat opens one participant's screen, and nothing else of the studio."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from fdvv_people.pages.studies import Studies
from fdvv_studio.studio.parts import load_parts
from fdvv_studio.studio.seats import Seats
from fdvv_studio.studio.server import address_of, create_app
from fdvv_studio.studio.studio import Studio
from tests.browser.study_screens import NAME, PASSPHRASE, frozen_study, plan_text
from tests.pages.screens import Page
from tests.studio.conftest import HOST, LIVE, ORIGIN, PORT, TOKEN

CALLS = sorted(load_parts().calls)


@pytest.fixture
def studies(own_studio: Studio) -> Studies:
    """A project with a frozen study whose sessions are open."""
    frozen_study(own_studio.project, plan_text(2, 2, reference=True, switch_s=0.0))
    studies = own_studio.part(Studies)
    studies.open_sessions(NAME, PASSPHRASE, None)
    return studies


@pytest.fixture
def word(studies: Studies) -> str:
    """The word of a fresh seat."""
    return studies.invite(NAME)


@pytest.fixture
def tablet(word: str, stranger: TestClient) -> TestClient:
    """A browser that has opened the address of a seat and no other."""
    assert stranger.get("/", params={"seat": word}).status_code == 200
    stranger.headers["origin"] = ORIGIN
    return stranger


def test_the_address_of_a_seat_opens_the_page_and_keeps_it(word: str, stranger: TestClient) -> None:
    answer = stranger.get("/", params={"seat": word}, headers={"sec-fetch-site": "cross-site"})
    assert answer.status_code == 200
    assert "<script" in answer.text
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert TOKEN not in answer.headers["set-cookie"]
    assert stranger.get("/studio.js").status_code == 200
    assert stranger.get("/", params={"seat": word}).status_code == 200


@pytest.mark.parametrize("wrong", ["", "a-word", "ÿ"])
def test_another_word_opens_nothing(studies: Studies, wrong: str, stranger: TestClient) -> None:
    assert stranger.get("/", params={"seat": wrong}).status_code == 403
    assert not stranger.cookies
    assert stranger.get("/studio.js").status_code == 403


def test_a_seat_under_another_name_of_this_machine_opens_nothing(word: str, stranger: TestClient) -> None:
    assert stranger.get("/", params={"seat": word}, headers={"host": "evil.example"}).status_code == 403


@pytest.mark.parametrize("name", CALLS)
def test_every_call_answers_403_to_a_seat(tablet: TestClient, word: str, name: str) -> None:
    question = {"study": NAME, "person": "P01", "delete": True}
    assert tablet.post(f"/api/{name}", json=question).status_code == 403
    assert tablet.post(f"/api/{name}", params={"seat": word}, json=question).status_code == 403
    tablet.cookies.clear()
    bearer = {"authorization": f"Bearer {word}"}
    assert tablet.post(f"/api/{name}", json=question, headers=bearer).status_code == 403


@pytest.mark.parametrize("channel", sorted(set(load_parts().channels) - {"study", "timing"}))
@pytest.mark.parametrize("query", [True, False])
def test_a_seat_has_only_the_channels_of_participants(
    tablet: TestClient, word: str, channel: str, query: bool
) -> None:
    with tablet.websocket_connect(f"{LIVE}?seat={word}" if query else LIVE) as socket:
        socket.send_json({"channel": channel, "body": {"type": "watch"}})
        with pytest.raises(WebSocketDisconnect) as refused:
            socket.receive_json()
    assert refused.value.code == 4403


def test_a_seat_in_the_address_confines_the_operators_own_browser_too(word: str, client: TestClient) -> None:
    with client.websocket_connect(f"{LIVE}?seat={word}") as socket:
        socket.send_json({"channel": "studies", "body": {"type": "watch"}})
        with pytest.raises(WebSocketDisconnect):
            socket.receive_json()


def asked(client: TestClient, word: str, kind: str, **question: Any) -> dict[str, Any]:
    """Ask on the channel of a seat; return the first answer."""
    with client.websocket_connect(f"{LIVE}?seat={word}") as socket:
        screen = Page(socket)
        screen.say(kind, **question)
        return screen.hear({"look": "about", "sit": "card", "resume": "card"}[kind])


def test_a_seat_seats_nobody_on_another_one_and_nobody_elses_card(
    tablet: TestClient, word: str, studies: Studies
) -> None:
    holder = secrets.token_hex(8)
    other = studies.invite(NAME)
    for kind, more in (("look", {}), ("sit", {"language": "en"})):
        found = asked(tablet, word, kind, study=NAME, seat=other, holder=holder, **more)
        assert "is another one's" in found["error"]
    one = asked(tablet, word, "sit", study=NAME, seat=word, holder=holder, language="en")
    two = asked(tablet, other, "sit", study=NAME, seat=other, holder=secrets.token_hex(8), language="en")
    card = {"study": NAME, "person": two["person"], "code": two["code"]}
    assert "is another one's" in asked(tablet, word, "resume", **card)["error"]
    mine = {"study": NAME, "person": one["person"], "code": one["code"]}
    assert asked(tablet, word, "resume", **mine)["person"] == one["person"]
    assert asked(tablet, word, "resume", **mine)["person"] == one["person"]


def test_a_card_may_take_a_free_seat_which_is_theirs_then(
    tablet: TestClient, word: str, studies: Studies
) -> None:
    person, code = studies.study(NAME).enrol()
    assert studies.seats.waiting(NAME) == 1
    assert asked(tablet, word, "resume", study=NAME, person=person, code=code)["person"] == person
    assert studies.seats.waiting(NAME) == 0
    question = {"study": NAME, "seat": word, "holder": secrets.token_hex(8)}
    assert not asked(tablet, word, "look", **question)["seat"]


@pytest.fixture
def restarted(word: str, own_studio: Studio) -> Iterator[TestClient]:
    """A browser at the same project after a new start, with another token; word was prepared before."""
    own_studio.close()
    again = Studio(own_studio.project)
    app = create_app(again, address_of(HOST, PORT, "another-token"))
    with TestClient(app, base_url=ORIGIN, headers={"origin": ORIGIN}) as client:
        yield client
        again.close()


def test_a_prepared_seat_outlives_the_studio(restarted: TestClient, word: str) -> None:
    assert restarted.get("/", params={"seat": word}).status_code == 200
    owner = {"authorization": "Bearer another-token"}
    detail = restarted.post("/api/studies.detail", json={"study": NAME}, headers=owner).json()
    assert detail["waiting"] == 1
    question = {"study": NAME, "seat": word, "holder": secrets.token_hex(8)}
    assert asked(restarted, word, "look", **question)["seat"]
    opening = {"study": NAME, "passphrase": PASSPHRASE}
    assert restarted.post("/api/studies.open", json=opening, headers=owner).json()["open"]
    assert asked(restarted, word, "sit", **question, language="en")["person"] == "P01"


def test_words_are_kept_as_digests_that_only_their_owner_reads(
    studies: Studies, word: str, own_studio: Studio
) -> None:
    path = own_studio.project / "studies" / f"{NAME}.seats"
    assert word not in path.read_text()
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_broken_file_of_seats_costs_invitations_only(tmp_path: Path) -> None:
    (tmp_path / "studies").mkdir()
    (tmp_path / "studies" / "mine.seats").write_text("{")
    seats = Seats(Studio(tmp_path))
    assert seats.find(seats.make("mine")) is not None


def test_a_seat_is_confined_on_the_channel_of_timing_studies_too(
    tablet: TestClient, word: str, studies: Studies
) -> None:
    question = {"type": "look", "study": NAME, "seat": studies.invite(NAME), "holder": secrets.token_hex(8)}
    with tablet.websocket_connect(f"{LIVE}?seat={word}") as socket:
        socket.send_json({"channel": "timing", "body": question})
        assert "is another one's" in str(socket.receive_json())
