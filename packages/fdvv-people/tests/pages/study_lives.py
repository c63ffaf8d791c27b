"""A studio that is killed again and again, and somebody who takes part in a study at it all the same.

The studio is what ``fdvv studio`` serves, in a process of its own, forked from one in which all imports are
done: it stands within a tenth of a second. Nothing is forced to the disk, and codes are quick to guess: a
killed process takes nothing with it that the system has.
"""

from __future__ import annotations

import http.client
import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from functools import partialmethod
from io import TextIOBase
from pathlib import Path
from threading import Event, Thread
from typing import Any

from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.seal import Cost
from fdvv_studio.studio.parts import load_parts
from fdvv_studio.studio.server import serve
from fdvv_studio.studio.studio import Studio

ROOT = Path(__file__).resolve().parents[4]
HOST = "127.0.0.1"
CHEAP = Cost(1, 8192)
PATIENCE_s = 30.0
GONE = (WebSocketException, OSError, http.client.HTTPException)
"""What is raised where the studio is killed while it is asked, or heard."""
ENDS = ("done", "declined", "withdrawn")
PAGES: dict[str, dict[str, object]] = {"consent": {}, "you": {"age": 33, "hand": "left"}}
PASSPHRASE = "correct horse battery staple"

Words = list[str]


class Taker:
    """Somebody at the page of a studio, and who leads the study; both speak as the real pages do.

    Parameters
    ----------
    address : that the studio printed, token included.
    tell : is called with words for what the studio acknowledged, and before what is asked for.
    text : of the plan of every study.
    """

    def __init__(self, address: str, tell: Callable[[Words], None], text: str) -> None:
        self.base, _, self._token = address.partition("/?token=")
        self._tell, self._text = tell, text
        self._random = random.Random(address)

    def call(self, name: str, /, **question: object) -> dict[str, Any]:
        """Ask as who leads the study; return the answer."""
        self._tell(["does", name])
        # a studio killed while a question is sent leaves the connection open
        with closing(http.client.HTTPConnection(self.base.partition("//")[2], timeout=PATIENCE_s)) as line:
            line.request(
                "POST", f"/api/studies.{name}", json.dumps(question),
                {"content-type": "application/json", "authorization": f"Bearer {self._token}"},
            )  # fmt: skip
            found = json.loads(line.getresponse().read())
        assert "error" not in found, found
        return dict(found)

    def prepare(self, study: str) -> None:
        """Declare and freeze a study, as far as that is not done."""
        states = {row["name"]: row["state"] for row in self.call("list")["rows"]}
        if study not in states:
            self.call("create", name=study, template="realism")
        if states.get(study, "draft") == "draft":
            if self.call("plan", study=study)["text"] != self._text:
                self.call("write", study=study, text=self._text, keep=True)
            self._tell(["frozen", self.call("freeze", study=study, passphrase=PASSPHRASE)["fingerprint"]])
        elif not self.call("detail", study=study)["open"]:
            self.call("open", study=study, passphrase=PASSPHRASE)

    def wait_for_nobody(self, study: str) -> None:
        """Wait until the studio has noticed that every page is gone."""
        until = time.monotonic() + PATIENCE_s
        while any(one["here"] for one in self.call("detail", study=study)["people"]):
            assert time.monotonic() < until
            time.sleep(0.02)

    def take_part(self, study: str, person: str, code: str) -> None:
        """Go on as somebody, or begin as somebody new, to the end of the session."""
        headers = {"authorization": f"Bearer {self._token}"}
        with connect(self.base.replace("http", "ws") + "/live", additional_headers=headers) as self._socket:
            if code:
                self._say("resume", study=study, person=person, code=code)
            else:
                seat = self.call("seat", study=study)["seat"]
                self._say("sit", study=study, seat=seat, holder=self._token, language="en")
            card = self._hear("card")
            self._person = card["person"]
            if card["code"]:
                self._tell(["enrolled", self._person, card["code"]])
            step = self._met(self._hear("step"))
            while step["kind"] not in ENDS:
                step = self._met(self._do(step))
            self._tell(["done", self._person])

    def _met(self, step: dict[str, Any]) -> dict[str, Any]:
        task, form = step["task"], step["form"]
        name = str(task["number"]) if task else form["name"] if form else "-1"
        self._tell(["met", self._person, name if step["kind"] in ENDS else step["kind"], name])
        return step

    def _do(self, step: dict[str, Any]) -> dict[str, Any]:
        if step["kind"] == "page":
            name = step["form"]["name"]
            self._say("page", name=name, values=PAGES[name], agreed=True)
        elif step["kind"] == "break":
            time.sleep(step["left_s"])
            self._say("rested")
        else:
            return self._trial(step["task"])
        return self._hear("step")

    def _trial(self, task: dict[str, Any]) -> dict[str, Any]:
        """Feel every label, press each, and answer."""
        self._say("shown", number=task["number"])
        self._hear("ready")
        for label in task["places"]:
            self._say("go", label=label)
            self._hear("felt")
            self._say("push", force_cN=120.0)
        choice = self._random.choice(["A", "B", "equal"])
        ratings = {"realism": {label: self._random.randint(1, 7) for label in task["rated"]}}
        self._say("answer", number=task["number"], choice=choice, ratings=ratings)
        step = self._hear("step")
        self._tell(["answered", self._person, str(task["number"]), choice])
        return step

    def _say(self, kind: str, **more: object) -> None:
        self._tell(["does", kind])
        self._socket.send(json.dumps({"channel": "study", "body": {"type": kind, **more}}))

    def _hear(self, kind: str) -> dict[str, Any]:
        while True:
            envelope = json.loads(self._socket.recv(timeout=PATIENCE_s))
            assert "error" not in envelope, envelope
            body = dict(envelope["body"])
            if body["type"] == kind:
                return body
            assert body["type"] in ("frame", "paused"), body


def hatch(kind: str) -> None:
    """Fork a process for every line of standard input, and tell what it says first, and how it ended."""
    os.fsync = lambda fd: None
    Study.enrol = partialmethod(Study.enrol, cost=CHEAP)  # type: ignore[method-assign, assignment]
    Study.freeze = partialmethod(Study.freeze, cost=CHEAP)  # type: ignore[method-assign, assignment]
    load_parts()
    running: set[int] = set()
    for line in sys.stdin:
        words = line.rstrip("\n").split("\t")
        if words[0] == "wait":
            running.discard(int(words[1]))
            _say(str(_ended(int(words[1]))))
            continue
        # a person is killed at a moment that is reported first; a studio by who asked for it
        moment, words = ([], words) if kind == "studio" else (words[:2], words[2:])
        output, into = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(output)
            LIVES[kind](into, *words)
            os._exit(0)
        os.close(into)
        with os.fdopen(output) as stream:
            if kind == "studio":
                running.add(child)
                _say(f"{child}\t{stream.readline().rstrip()}")
            else:
                _say(_witnessed(child, stream, int(moment[0]), float(moment[1])))
    for child in running:
        os.kill(child, signal.SIGKILL)
        _ended(child)


def _ended(child: int) -> int:
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def serve_life(into: int, project: str, port: str) -> None:
    """Serve a project until somebody kills this process."""
    serve(Studio(Path(project)), HOST, int(port), lambda addresses: _tell(into, addresses[0]))


def take_life(into: int, address: str, study: str, person: str, code: str) -> None:
    """Take part in a study, one person after the other, until somebody kills this process."""
    taker = Taker(address, lambda words: _tell(into, " ".join(words)), "")
    while True:
        taker.take_part(study, person, code)
        person = code = ""


def _tell(into: int, line: str) -> None:
    os.write(into, f"{line}\n".encode())


LIVES: dict[str, Callable[..., None]] = {"studio": serve_life, "person": take_life}


def _witnessed(child: int, stream: TextIOBase, after: int, after_s: float) -> str:
    """Kill a process ``after_s`` after its line number ``after``; return all of its lines."""
    said = "".join(stream.readline() for _ in range(after))
    time.sleep(after_s)
    os.kill(child, signal.SIGKILL)
    assert _ended(child) == -signal.SIGKILL
    return "\t".join((said + stream.read()).split("\n")[:-1])


class Killer:
    """Kills a process ``after_s`` after ``after`` things were reported."""

    def __init__(self, process: int, after: int, after_s: float) -> None:
        self._process, self._left, self._after_s = process, after, after_s
        self._now = Event()
        self._thread = Thread(target=self._kill, daemon=True)
        self._thread.start()
        if after == 0:
            self._now.set()

    def count(self) -> None:
        """Count a thing that was reported."""
        self._left -= 1
        if self._left == 0:
            self._now.set()

    def _kill(self) -> None:
        self._now.wait(PATIENCE_s)
        time.sleep(self._after_s)
        os.kill(self._process, signal.SIGKILL)

    def wait(self) -> None:
        """Wait until it is done."""
        self._thread.join()


class Hatchery:
    """A process that forks others. kind : of those."""

    def __init__(self, kind: str) -> None:
        program = f"from tests.pages.study_lives import hatch; hatch({kind!r})"
        self.process = subprocess.Popen(
            [sys.executable, "-c", program],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )

    def ask(self, *words: object) -> list[str]:
        """Have a process forked, or waited for; return what is said of it."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write("\t".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().rstrip("\n").split("\t")

    def close(self) -> None:
        """End it, and all that it forked."""
        try:
            self.process.communicate(timeout=PATIENCE_s)
        finally:
            self.process.kill()
        assert self.process.wait() == 0
