"""A participant of a timing study before the real screens: presses whenever the bullet is at the zone."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.chained_log import read_chained
from tests.browser.study_screens import CHEAP, NAME, PASSPHRASE, Sitter
from tests.browser.wire import Wire

if TYPE_CHECKING:
    from playwright.sync_api import Page

HEAD = """
format = "fdvv-timing"
version = 1
name = "mine"
title.en = "Press at the right moment"
title.fi = "Paina oikealla hetkellä"
languages = ["en", "fi"]
people = 2
rounds = 1
break_every_min = 0
gap_days = {gap_days}
due_days = 14
"""
POINTING = """
levels = ["easy"]
presses = {presses}
reminder.en = "Come back from {{date}} on, {{person}}."
reminder.fi = "Tule takaisin {{date}}, {{person}}."
[training]
trials = {trials}
engine = "sobol"
"""
TAPPING = """
task = "tapping"
tap_s = 3
"""
CONDITIONS = """
[[conditions]]
name = "MX Red"
kind = "button"
button = "mx-red"
[[conditions]]
name = "MX Brown"
kind = "switch"
button = "mx-brown"
key = "F13"
latency_ms = 1.0
latency_error_ms = 1.0
[[conditions]]
name = "own keyboard"
kind = "key"
button = "mx-brown"
"""
PAGES = """
[[pages]]
name = "consent"
when = "consent"
title.en = "Before we begin"
title.fi = "Ennen kuin aloitamme"
text.en = "You press as a light reaches a mark."
text.fi = "Painat, kun valo on merkin kohdalla."
"""
PRESS_WHEN_SEEN = """() => {
    const lit = () => {
        const canvas = document.querySelectorAll('.strip canvas')[1];
        if (!canvas || canvas.width < 2) return false;
        const [x, y] = [Math.floor(100 / 144 * canvas.width), Math.floor(canvas.height / 2)];
        const beyond = canvas.getContext('2d').getImageData(x, y, canvas.width - x, 1).data;
        return beyond.some((value, i) => i % 4 === 3 && value > 200);
    };
    window.fdvvKey = { key: ' ', code: 'Space' };
    const key = (kind) => (document.activeElement ?? document.body).dispatchEvent(
        new KeyboardEvent(kind, { ...window.fdvvKey, bubbles: true, cancelable: true }));
    window.fdvvHit = key;
    let was = false;
    const look = () => {
        const now = lit();
        if (now && !was) {
            key('keydown');
            setTimeout(() => key('keyup'), 200);
        }
        was = now;
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
}"""
"""Presses a key as soon as the picture shows the bullet in the zone or beyond."""
KEYS = {"F13": {"key": "F13", "code": "F13"}, "Space": {"key": " ", "code": "Space"}}


def timing_text(
    trials: int = 2, presses: int = 3, gap_days: float = 0.0, *, tapping: bool = False, pages: bool = True
) -> str:
    """Write a plan of a switch, a key and a button. trials : of training; 0: there is none, and no gap."""
    task = TAPPING if tapping else POINTING.format(trials=trials, presses=presses)
    head = HEAD.format(gap_days=gap_days)
    plain, _, table = task.partition("[training]")
    training = f"[training]{table}" if table and trials else ""
    return head + plain + training + CONDITIONS + (PAGES if pages else "")


def frozen_timing(project: Path, text: str) -> Study:
    """Declare and freeze a timing study in a project."""
    study = Study.declare_text(project / "studies" / NAME, text, project)
    study.freeze(PASSPHRASE, CHEAP)
    return study


def recorded(study: Study, kind: str, person: str = "P01") -> list[dict[str, Any]]:
    """Return the bodies of the records of a kind in a person's session, in order."""
    records = read_chained(study.person_folder(person) / "session.jsonl").records
    return [record[kind] for record in records if kind in record]


class TimingWire(Wire):
    """What a participant's page hears and says."""

    def __init__(self, page: Page) -> None:
        super().__init__(page, "timing")

    def kept(self) -> list[tuple[int, int]]:
        """Return trial and number of each round that the page heard was kept."""
        found, trial = [], -1
        for body in self.heard:
            if body.get("type") == "ready":
                trial = body["number"]
            elif body.get("type") == "kept":
                found.append((trial, body["number"]))
        return found

    def downs_ms(self) -> dict[int, list[float]]:
        """Return by trial when the page said that the hand pressed."""
        found, trial = dict[int, list[float]](), -1
        for body in self.said:
            if body.get("type") == "begin":
                trial = body["number"]
            elif body.get("type") == "down":
                found.setdefault(trial, []).append(body["at_ms"])
        return found


STEP = ".timed, .study-sheet[data-key]"
"""A trial, or what must lie under the finger for the next one."""


@dataclass
class Timer:
    """Somebody who presses at bullets. person, code : of their card."""

    page: Page
    person: str = ""
    code: str = ""
    wire: TimingWire = field(init=False)

    def __post_init__(self) -> None:
        self.wire = TimingWire(self.page)

    def sit(self, operator: Page, language: str = "") -> None:
        """Open the link of a fresh seat, begin, note the card, and agree."""
        sitter = Sitter(self.page)
        sitter.sit(operator, language)
        self.person, self.code = sitter.person, sitter.code
        self.page.evaluate(PRESS_WHEN_SEEN)

    def agree(self) -> None:
        """Agree to take part."""
        self.page.click("form .button.main")

    def use(self, code: str) -> None:
        """Press another key from now on. code : as KeyboardEvent has it."""
        self.page.evaluate("key => { window.fdvvKey = key; }", KEYS[code])

    def hit(self, code: str) -> None:
        """Press a key once, now."""
        self.page.evaluate(
            """key => { for (const kind of ['keydown', 'keyup']) document.body.dispatchEvent(
            new KeyboardEvent(kind, { ...key, bubbles: true, cancelable: true })); }""",
            KEYS[code],
        )

    def wait_for(self, at: str) -> None:
        """Wait until a trial is shown."""
        self.page.wait_for_selector(f".study-at >> text={at}")

    def begin(self) -> None:
        """Begin the trial that is shown, or go on with it, by keyboard."""
        self.page.wait_for_selector(".timed[data-status=away] .button.main:focus")
        self.page.keyboard.press("Enter")
        self.page.wait_for_selector(".timed[data-status=there]")

    def place(self) -> str:
        """Put what is asked for under the finger; return the key that counts, which is used from now on."""
        self.page.wait_for_selector(".study-sheet[data-key]")
        code = self.page.get_attribute(".study-sheet[data-key]", "data-key") or ""
        self.use(code)
        self.hit(code)
        self.page.wait_for_selector(".timed")
        return code

    def prepare(self) -> None:
        """Put what the screen asks for under the finger, and use the key that counts."""
        self.page.wait_for_selector(STEP)
        if self.page.locator(".study-sheet[data-key]").count():
            self.place()
        else:
            self.use("Space")

    def trial(self, at: str, of: int) -> None:
        """Prepare and begin a trial, which is played to its end by the script."""
        self.wait_for(f"{at} of {of}")
        self.prepare()
        self.begin()

    def tap(self, time_s: float) -> None:
        """Tap eight times a second, or as often as this machine does, and hold each for 40 ms."""
        for _ in range(round(8 * time_s)):
            self.page.evaluate("kind => window.fdvvHit(kind)", "keydown")
            self.page.wait_for_timeout(40)
            self.page.evaluate("kind => window.fdvvHit(kind)", "keyup")
            self.page.wait_for_timeout(85)
