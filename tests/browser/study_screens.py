"""A participant before the real screens: presses, switches and answers by key, mouse or touch."""

from __future__ import annotations

import random
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.seal import Cost

if TYPE_CHECKING:
    from playwright.sync_api import CDPSession, Page

InputMethod = Literal["keys", "mouse", "touch"]
NAME, PASSPHRASE = "mine", "correct horse battery staple"
CHEAP = Cost(1, 8192)
BUTTONS = ("mx-clear", "rubber-dome")
# error_cN: how near a held mouse on a busy machine comes to a model's force is no matter of these tests
HEAD = """
name = "mine"
kind = "realism"
title.en = "Which is more like X?"
title.fi = "Kumpi on enemmän kuin X?"
languages = ["en", "fi"]
rounds = {rounds}
practice = 0
people = 2
switch_s = {switch_s}
break_every_min = {break_every_min}
break_min = {break_min}
[exclusion]
error_cN = 100.0
[[ratings]]
name = "realism"
question.en = "How real is it?"
question.fi = "Kuinka todelta se tuntuu?"
low.en = "not at all"
low.fi = "ei lainkaan"
high.en = "like the real one"
high.fi = "kuin oikea"
"""
ITEM = """
[[items]]
name = "Button {number}"
stimuli = [
    {{ name = "FD", button = "{button}", rendered = "FD" }},
    {{ name = "FDVV", button = "{button}", rendered = "FDVV" }},
]
"""
REFERENCE = 'reference = {{ name = "the-true-one", button = "{button}", rendered = "FDVV" }}\n'
PAGES = """
[[pages]]
name = "consent"
when = "consent"
title.en = "Before we begin"
title.fi = "Ennen kuin aloitamme"
text.en = "You press buttons."
text.fi = "Painat painikkeita."
[[pages]]
name = "you"
when = "before"
title.en = "About you"
title.fi = "Sinusta"
[[pages.questions]]
name = "age"
question.en = "How old are you?"
question.fi = "Kuinka vanha olet?"
low = 18
high = 99
[[pages.questions]]
name = "hand"
question.en = "Which hand?"
question.fi = "Kumpi käsi?"
choices.en = ["left", "right"]
choices.fi = ["vasen", "oikea"]
"""


def plan_text(
    items: int = 2,
    rounds: int = 1,
    *,
    reference: bool = False,
    pages: bool = False,
    break_every_min: float = 0.0,
    break_min: float = 0.0,
    switch_s: float = 0.02,
) -> str:
    """Write a plan of items times rounds trials."""
    breaks = {"break_every_min": break_every_min, "break_min": break_min}
    text = HEAD.format(rounds=rounds, switch_s=switch_s, **breaks) + (PAGES if pages else "")
    for number in range(1, items + 1):
        about = {"number": number, "button": BUTTONS[number % len(BUTTONS)]}
        text += (ITEM + (REFERENCE if reference else "")).format(**about)
    return text


def frozen_study(project: Path, text: str) -> Study:
    """Declare and freeze a study in a project."""
    study = Study.declare_text(project / "studies" / NAME, text, project)
    study.freeze(PASSPHRASE, CHEAP)
    return study


def names_in(text: str) -> list[str]:
    """Find names that would tell what a label hides; letters within a code or a sum are none."""
    return re.findall(r"(?<![\w-])(?:FDV{0,2}|the-true-one|mx-clear|rubber-dome)(?![\w-])", text)


def wait_for_part(page: Page) -> None:
    """Wait until the studio has loaded what serves studies, however busy this machine is."""
    page.evaluate(
        """async () => { await fetch('./api/studies.list', {method: 'POST',
        headers: {'content-type': 'application/json'}, body: '{}'}); }"""
    )


ASK = """async ([name, question]) => (await fetch('./api/studies.' + name, {method: 'POST',
headers: {'content-type': 'application/json'}, body: JSON.stringify(question)})).json()"""


def ask(operator: Page, name: str, **question: str) -> dict[str, Any]:
    """Ask as the operator's page."""
    return dict(operator.evaluate(ASK, [name, {"study": NAME, **question}]))


def open_sessions(operator: Page) -> None:
    """Open the sessions as the key holder does, unless they are open."""
    if not ask(operator, "detail")["open"]:
        assert ask(operator, "open", passphrase=PASSPHRASE)["open"]


def invitation(operator: Page) -> str:
    """Return a fresh seat."""
    open_sessions(operator)
    return str(ask(operator, "seat")["seat"])


def seat_address(operator: Page) -> str:
    """Return the address of a fresh seat, as the operator copies it."""
    return f"{operator.url.partition('#')[0].partition('?')[0]}?seat={invitation(operator)}#/study/{NAME}"


@dataclass
class TrialAnswer:
    """What a sitter answered in a trial. places : labels there were."""

    choice: str
    ratings: dict[str, int]
    places: tuple[str, ...] = ()


@dataclass
class Sitter:
    """Somebody before a participant's screen. given : answers, in the order of trials."""

    page: Page
    input_method: InputMethod = "keys"
    seed: int = 1
    given: list[TrialAnswer] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)
        self._touch: CDPSession | None = None

    def sit(self, operator: Page, language: str = "") -> None:
        """Open the link of a fresh seat, begin, and note what stands on the card."""
        self.page.goto(seat_address(operator))
        self.page.wait_for_selector("#study-title")
        if language:
            self.page.select_option("select", language)
        self.main()
        self.page.wait_for_selector(".study-card")
        self.person, self.code = (self.page.inner_text(f"[data-card={one}]") for one in ("person", "code"))
        self.main()

    def main(self) -> None:
        """Use the main button of what is shown."""
        self.hit(".study-main .button.main")

    def hit(self, selector: str) -> None:
        """Click or tap."""
        (self.page.tap if self.input_method == "touch" else self.page.click)(selector)

    def trial(self, at: int, of: int | None = None) -> TrialAnswer:
        """Do a trial from its first sight to the answer; of : which is waited for."""
        self.wait_for(at, of)
        places = tuple(
            self.page.locator(".study-place").evaluate_all("all => all.map((e) => e.dataset.label)")
        )
        ratings = {label: self._random.randint(1, 7) for label in places if label != "X"}
        given = TrialAnswer(self._random.choice(["A", "equal", "B"]), ratings, places)
        for label in places:
            self.feel(label)
            if label in ratings:
                self.rate(label, ratings[label])
        self.choose(given.choice)
        self.next()
        self.given.append(given)
        return given

    def wait_for(self, at: int, of: int | None = None) -> None:
        """Wait until a trial is shown."""
        said = f"Trial {at} of {of}" if of else f"/ {at}( |$)/"
        self.page.wait_for_selector(f".study-at >> text={said}")
        self.page.wait_for_selector(".study-trial")

    def feel(self, label: str) -> None:
        """Have a label under the finger, and press it once, down and up."""
        if self.input_method == "keys":
            self.page.keyboard.press(label.lower())
        else:
            self.hit(f".study-place[data-label={label}]")
        self.page.wait_for_selector(f".study-place[data-label={label}][data-felt=true]")
        self._down()
        self.page.wait_for_selector(".study-feel[data-key=true]")
        self._up()
        self.page.wait_for_selector(f".study-place[data-label={label}][data-pressed=true]")

    def rate(self, label: str, points: int) -> None:
        """Rate what is under the finger."""
        if self.input_method == "keys":
            self.page.keyboard.press(str(points))
        else:
            self.hit(f".study-rating[aria-label$=' {label}'] input[value='{points}']")

    def choose(self, choice: str) -> None:
        """Choose an answer."""
        if self.input_method == "keys":
            self.page.keyboard.press("e" if choice == "equal" else f"Shift+{choice}")
        else:
            self.hit(f".study-choices input[value='{choice}']")

    def next(self) -> None:
        """Send the answer."""
        if self.input_method == "keys":
            self.page.keyboard.press("Enter")
        else:
            self.hit(".study-foot .button.main")

    def _down(self) -> None:
        if self.input_method == "keys":
            self.page.keyboard.down(" ")
            return
        at = self._place()
        if self.input_method == "mouse":
            self.page.mouse.move(at["x"], at["y"])
            self.page.mouse.down()
        else:
            self._touch = self._touch or self.page.context.new_cdp_session(self.page)
            self._touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [at]})

    def _up(self) -> None:
        if self.input_method == "keys":
            self.page.keyboard.up(" ")
        elif self.input_method == "mouse":
            self.page.mouse.up()
        else:
            assert self._touch is not None
            self._touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def _place(self) -> dict[str, Any]:
        """Return a place on the cap: who holds it pushes harder and harder."""
        box = self.page.locator(".study-feel").bounding_box()
        assert box is not None
        return {"x": box["x"] + box["width"] / 2, "y": box["y"] + 0.6 * box["height"]}


def recorded_answers(study: Study, person: str = "P01") -> list[dict[str, Any]]:
    """Return the answers on the disk, in order, as their records hold them."""
    from fdvv_people.study.files.chained_log import read_chained

    records = read_chained(study.person_folder(person) / "session.jsonl").records
    return [record["answered"]["answer"] for record in records if "answered" in record]
