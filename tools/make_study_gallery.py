"""Photograph a study for the documents: docs/images/studio/stud*.png.

Run `python -m tools.make_study_gallery` from the repository root. A small blind study on the twin in a fresh
studio, with people who are scripts; what is rendered is simulated.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Page, sync_playwright
from tools.make_studio_gallery import TABLET, WIDE, Shot, take

from fdvv_people.study.admin.study import Study

NAME, TIRING, PHONE = "realism", "tiring", (390, 844)
PLAN = """name = "{name}"
kind = "realism"
title.en = "Which feels more like the reference?"
languages = ["en"]
rounds = 3
practice = 0
people = 12
switch_s = 0.6
break_every_min = {break_every_min}
break_min = 3.0
[[ratings]]
name = "realism"
question.en = "How real does it feel?"
low.en = "not at all"
high.en = "exactly like X"
[[pages]]
name = "you"
when = "before"
title.en = "About you"
text.en = "It helps us to know who took part. Nothing of it names you."
[[pages.questions]]
name = "age"
question.en = "How old are you?"
low = 18
high = 99
[[pages.questions]]
name = "hand"
question.en = "With which hand do you press?"
choices.en = ["left", "right"]
"""
ITEM = """
[[items]]
name = "{name}"
stimuli = [
    {{ name = "FD", button = "{button}", rendered = "FD" }},
    {{ name = "FDVV", button = "{button}" }},
]
reference = {{ name = "reference", button = "{button}" }}
"""
PASSPHRASE = "four words of no sense"
SEAT = """async ([study, passphrase]) => {
const ask = async (name, more) => (await fetch('./api/studies.' + name, {method: 'POST', headers:
{'content-type': 'application/json'}, body: JSON.stringify({study, ...more})})).json();
if (!(await ask('detail', {})).open) await ask('open', {passphrase});
return (await ask('seat', {})).seat; }"""


def declare(project: Path) -> None:
    """Declare and freeze the study, and one that has a break after every trial."""
    buttons = {"Cherry MX Clear": "mx-clear", "Rubber dome": "rubber-dome"}
    items = "".join(ITEM.format(name=name, button=button) for name, button in buttons.items())
    for name, break_every_min in ((NAME, 20.0), (TIRING, 1e-4)):
        plan = PLAN.format(name=name, break_every_min=break_every_min)
        study = Study.declare_text(project / "studies" / name, plan + items, project)
        study.freeze(PASSPHRASE)


def sit(page: Page) -> None:
    """Take a fresh seat of the study that is looked at, as the next person."""
    base, _, address = page.url.partition("#/studies/")
    seat = page.evaluate(SEAT, [address, PASSPHRASE])
    page.goto(f"{base}#/study/{address}?seat={seat}")
    page.wait_for_selector("#study-title")
    page.click(".study-main .button.main")
    page.wait_for_selector(".study-card")


def ask(page: Page) -> None:
    """Come to the questions, and answer the first."""
    sit(page)
    page.click(".study-main .button.main")
    page.fill("#study-age", "34")


def trial(page: Page) -> None:
    """Come to the first trial, feel X and A, and hold B down; rate and choose."""
    begin(page)
    for label in "XA":
        feel(page, label)
    rate(page, {"A": 4})
    put(page, "B")
    page.keyboard.down(" ")
    page.wait_for_selector(".study-feel[data-key=true]")
    page.wait_for_timeout(400)


def begin(page: Page) -> None:
    """Come to the first trial."""
    ask(page)
    page.locator(".study-option", has_text="right").click()
    page.click("form .button.main")
    page.wait_for_selector(".study-trial")


def put(page: Page, label: str) -> None:
    """Have a label under the finger."""
    page.keyboard.press(label.lower())
    page.wait_for_selector(f".study-place[data-label={label}][data-felt=true]")


def feel(page: Page, label: str) -> None:
    """Press a label once."""
    put(page, label)
    page.keyboard.down(" ")
    page.wait_for_selector(".study-feel[data-key=true]")
    page.keyboard.up(" ")
    page.wait_for_selector(f".study-place[data-label={label}][data-pressed=true]")


def rate(page: Page, points: dict[str, int]) -> None:
    """Rate labels."""
    for label, value in points.items():
        page.check(f".study-rating[aria-label$=' {label}'] input[value='{value}']", force=True)


def answered(page: Page) -> None:
    """Answer one trial; a break follows."""
    begin(page)
    for label in "XAB":
        feel(page, label)
    rate(page, {"A": 4, "B": 6})
    page.keyboard.press("Shift+B")
    page.keyboard.press("Enter")
    page.wait_for_selector(".study-clock")


def tab(name: str) -> Callable[[Page], None]:
    """Open a tab of the operator's page."""

    def act(page: Page) -> None:
        page.get_by_role("tab", name=name).click()
        page.wait_for_load_state("networkidle")

    return act


def people(page: Page) -> None:
    """Have a seat ready, the study's people below."""
    page.get_by_role("button", name="Create an invitation").click()
    page.wait_for_selector("a[data-seat]")


SHOTS = (
    Shot("study-card", f"studies/{NAME}", "light", PHONE, sit),
    Shot("study-questions", f"studies/{NAME}", "light", PHONE, ask),
    Shot("study-trial", f"studies/{NAME}", "light", WIDE, trial),
    Shot("study-trial-touch", f"studies/{NAME}", "dark", TABLET, trial),
    Shot("study-break", f"studies/{TIRING}", "dark", WIDE, answered),
    Shot("studies-plan", f"studies/{NAME}", "dark", WIDE, tab("Plan")),
    Shot("studies-people", f"studies/{NAME}", "light", WIDE, people),
    Shot("studies-people-phone", f"studies/{NAME}", "light", PHONE, people),
    Shot("studies-seal", f"studies/{NAME}", "dark", TABLET, tab("Seal and results")),
)


def main() -> None:
    """Start a studio of its own, and go through the list, or the names given."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        project = Path(folder) / "my-buttons"
        declare(project)
        command = [sys.executable, "-m", "fdvv", "studio", "--port", "0", "--no-browser"]
        studio = subprocess.Popen([*command, "--project", str(project)], stdout=subprocess.PIPE, text=True)
        try:
            assert studio.stdout is not None
            address = studio.stdout.readline().split()[-1]
            browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
            for shot in SHOTS:
                if shot.name in sys.argv[1:] or len(sys.argv) == 1:
                    # a browser of its own, which stays: who sat there before keeps the seat
                    touch = shot.size != WIDE
                    page = browser.new_context(has_touch=touch, is_mobile=touch).new_page()
                    page.set_default_timeout(20_000)
                    page.goto(address)
                    page.wait_for_selector("html[data-ready]")
                    take(page, address.partition("/?")[0], shot)
        finally:
            studio.terminate()
            studio.wait()


if __name__ == "__main__":
    main()
