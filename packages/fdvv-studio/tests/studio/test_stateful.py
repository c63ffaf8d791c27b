"""A page that is used at random: calls and messages with ids that exist, in any order.

What a stranger sends seldom gets past the first check (``test_hostile``); this gets deep. The studio is a
real process, what is asked is drawn from seeds, and how far it got is printed with -rP.
"""

from __future__ import annotations

import base64
import json
import random
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx2
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from fdvv_studio.studio.parts import load_parts
from tests.studio.memory import Memory
from tests.studio.running import RunningStudio
from tests.support.campaign import campaign, pick

CALLS, CHANNELS = load_parts().calls, load_parts().channels
SELDOM = {
    "jobs.start": 0.2,
    "studies.freeze": 0.1,
    "studies.unseal": 0.1,
    "studies.withdraw": 0.1,
    "editor.achievable": 0.1,
    "optimize.simulate": 0.1,
    "device.disconnect": 0.1,
    "document.delete": 0.3,
    "program.delete": 0.3,
}
"""Calls that take long, or that end what others need: how often they are asked, beside once."""


SCORED: dict[str, object] = {
    **{"title": "scored", "engine": "random", "space": "FDV", "preference": False, "simulated": True},
    **{"level": "easy", "also": [], "start": "builtin:mx-clear", "rig": None, "seed": 1, "budget": 20},
    "task_presses": 2,
}
PROBE = {
    "type": "probe",
    "button": "builtin:mx-clear",
    "name": "p",
    "device": "host",
    "settings": {"velocities_mm_s": [100.0], "presses": 1},
}
TUNE = {**PROBE, "type": "tune", "device": "twin", "observer": "person", "settings": {}}
PRESS = "displacement_mm,force_cN\n" + "".join(f"{i / 50},{min(i, 40) + i / 5}\n" for i in range(200))
CREATED: dict[str, tuple[dict[str, object], ...]] = {
    "optimize.create": (
        SCORED,
        *(
            {**SCORED, "preference": True, "engine": engine, "simulated": False}
            for engine in ("preference", "preference-line")
        ),
    ),
    "jobs.start": ({"order": PROBE}, {"order": TUNE}),
    "device.connect": ({"device": "host"},),
    "press.trace": (
        {"name": "t", "text": json.dumps({"t_s": [0, 1, 2, 3], "displacement_mm": [0, 1, 2, 3]})},
    ),
    "file.read": ({"files": [{"name": "a.csv", "content": base64.b64encode(PRESS.encode()).decode()}]},),
    "program.recipe": ({"recipe": "rapid-trigger", "base": "builtin:mx-clear", "parameters": {}},),
}
"""Questions of a page whose fields depend on each other: drawn ones hardly ever fit."""


class Page:
    """Asks a studio, and keeps what it answers."""

    def __init__(self, studio: RunningStudio, seed: int) -> None:
        self.draw = random.Random(seed)
        self.memory = Memory(self.draw)
        self._studio = studio
        self.reached: Counter[str] = Counter()
        self.messages: Counter[str] = Counter()
        self.statuses: Counter[int] = Counter()
        self.refusals: dict[str, str] = {}
        headers = {"authorization": f"Bearer {studio.token}", "origin": studio.base}
        self._line = httpx2.Client(base_url=studio.base, headers=headers, timeout=300)

    def ask(self, name: str) -> None:
        nonsense = self.draw.choice((0.0, 0.0, 0.15))
        question: object = self.memory.question(CALLS[name].ask, nonsense)
        if name in CREATED and self.draw.random() < 0.5:
            question = self.draw.choice(CREATED[name])
        answer = self._line.post(
            f"/api/{name}",
            content=json.dumps(question).encode(),
            headers={"content-type": "application/json"},
        )
        self.statuses[answer.status_code] += 1
        assert answer.status_code in (200, 400, 422), f"{name} {question!r}: {answer.text}"
        if answer.status_code == 200:
            self.reached[name] += 1
            self.memory.learn(answer.json())
        else:
            self.refusals[name] = f"{json.dumps(question)[:300]} -> {answer.text[:300]}"
            assert "\n" not in answer.json()["error"]

    def end_all(self) -> None:
        """End what keeps files and threads: the device, jobs, simulated people."""
        for name in ("device.disconnect", "jobs.list", "optimize.list"):
            self.ask(name)
        for job in self._answer("jobs.list")["jobs"]:
            self._answer("jobs.cancel", job=job["job"])
        for run in self._answer("optimize.list")["rows"]:
            self._answer("optimize.halt", run=run["run"])

    def _answer(self, name: str, **question: object) -> dict[str, Any]:
        return dict(self._line.post(f"/api/{name}", json=question).json())

    def ask_many(self, count: int) -> None:
        names = list(CALLS)
        weights = [SELDOM.get(name, 1.0) for name in names]
        for name in self.draw.choices(names, weights, k=count):
            self.ask(name)

    def talk(self, count: int) -> None:
        """Send messages of all channels over live connections; a new one where a message was no message."""
        while count > 0:
            with self._live() as line, suppress(ConnectionClosed):
                for _ in range(min(count, 20)):
                    count -= 1
                    self._say(line)

    def _say(self, line: ClientConnection) -> None:
        name = self.draw.choice(list(CHANNELS))
        ask = self.draw.choice(CHANNELS[name].asks)
        body = self.memory.question(ask, self.draw.choice((0.0, 0.0, 0.0, 0.1)))
        line.send(json.dumps({"channel": name, "body": body}))
        self.messages[name] += 1
        with suppress(TimeoutError):
            while True:
                answer = json.loads(line.recv(0.01))
                self.memory.learn(answer.get("body"))
                assert "\n" not in answer.get("error", "")

    def _live(self) -> ClientConnection:
        return connect(
            self._studio.base.replace("http", "ws") + "/live",
            origin=Origin(self._studio.base),
            additional_headers={"authorization": f"Bearer {self._studio.token}"},
            close_timeout=5,
        )

    def report(self) -> str:
        """Return how far it got, and of what was never reached the last refusal."""
        missed = sorted(set(CALLS) - set(self.reached))
        reached = f"{len(self.reached)} of {len(CALLS)} reached"
        head = f"{self.statuses.total()} calls, {dict(self.statuses)}; {reached}"
        messages = f"{self.messages.total()} messages to {len(self.messages)} of {len(CHANNELS)} channels"
        return "\n".join(
            [f"{head}; {messages}", *(f"  {name}: {self.refusals.get(name)}" for name in missed), ""]
        )

    def close(self) -> None:
        self._line.close()


@pytest.fixture
def studio(tmp_path: Path) -> Iterator[RunningStudio]:
    found = RunningStudio(tmp_path / "project")
    yield found
    said = found.stop()
    assert "Traceback" not in said, said


@pytest.fixture
def page(studio: RunningStudio, seed: int) -> Iterator[Page]:
    found = Page(studio, seed)
    yield found
    found.close()
    sys.stdout.write(found.report())


def held(studio: RunningStudio) -> tuple[int, int]:
    """Return how many files a studio has open, and how many threads.

    The journal of a button that was opened stays open, one each; those do not count.
    """
    process = Path(f"/proc/{studio.process.pid}")
    files = []
    for handle in (process / "fd").iterdir():
        with suppress(FileNotFoundError):
            files.append(str(handle.readlink()))
    others = [name for name in files if not name.endswith(".draft.jsonl")]
    return len(others), len(list((process / "task").iterdir()))


@campaign("seed", range(20), part=1)
def test_calls_and_messages_with_known_ids_cause_no_internal_error(page: Page) -> None:
    page.ask_many(450)
    page.talk(100)
    assert len(page.reached) >= 40


@pytest.mark.slow
@campaign("seed", [5], part=1)
def test_many_calls_and_messages_reach_nearly_every_call_and_leak_nothing(
    page: Page, studio: RunningStudio
) -> None:
    after_first = (0, 0)
    rounds = pick(2, 84)
    for turn in range(rounds):
        page.ask_many(500)
        page.talk(100)
        page.end_all()
        after_first = after_first if turn else held(studio)
    assert len(page.reached) >= (pick(55, 70))
    files, threads = held(studio)
    assert files <= after_first[0] + 10
    assert threads <= after_first[1] + 10
