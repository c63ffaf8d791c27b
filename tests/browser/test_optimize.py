"""The page on which one plays for a better button: timed honestly, kept, gone on with, compared, saved."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from benchmarks.studio_play import button_ms
from playwright.sync_api import expect

from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Answer, TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.pointing import ASYNCHRONY
from fdvv_people.task.questionnaire import LIKING, liking_score
from fdvv_people.task.rounds import ClockSource, TaskRound, TaskRounds
from fdvv_people.task.score import Score
from tests.browser.accessibility import audit
from tests.browser.wire import Wire
from tests.pages.test_optimize_group import scored_run
from tests.studio.running import RunningStudio
from tests.support.grids import grid
from tests.support.pressed_rig import KeyedRig

if TYPE_CHECKING:
    from playwright.sync_api import BrowserContext, Page

ROUNDS = 3
LONG_ms = 60_000
"""For a machine that is busy with other things."""
CLOCK_ms = 0.2
"""Browsers tell times in steps of 0.1 ms."""
BUTTON_ms = 2.0
"""A press takes the simulated button so long, give or take: its noise, and steps of the run."""
PRESS_WHEN_SEEN = """(x_ratio) => {
    const canvas = document.querySelectorAll('.strip canvas')[1];
    const lit = () => {
        if (canvas.width < 2) return false;
        const [x, y] = [Math.floor(x_ratio * canvas.width), Math.floor(canvas.height / 2)];
        const beyond = canvas.getContext('2d').getImageData(x, y, canvas.width - x, 1).data;
        return beyond.some((value, i) => i % 4 === 3 && value > 200);
    };
    const key = (kind) => document.dispatchEvent(new KeyboardEvent(kind, {key: ' ', cancelable: true}));
    window.seen = [];
    let [was, before_ms] = [false, Infinity];
    const look = (at_ms) => {
        const now = lit();
        if (now && !was) {
            window.seen.push({at_ms, gap_ms: at_ms - before_ms});
            key('keydown');
            setTimeout(() => key('keyup'), 120);
        }
        [was, before_ms] = [now, at_ms];
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
}"""
"""Presses as soon as the picture shows the bullet at a place of the strip or beyond, by its pixels alone:
between two pictures of a screen it may jump over any one. Once the game draws, this looks after it."""


def form(page: Page, kind: str = "I play") -> None:
    """Open the form of a new run, with all there is to set."""
    page.goto(f"{page.url.partition('#')[0]}#/optimize")
    page.get_by_role("radio", name=kind).check()
    if not page.get_by_label("Engine").is_visible():
        page.get_by_text("Advanced").click()


def begin(page: Page, engine: str = "sobol", kind: str = "I play", **more: str) -> None:
    """Begin a run of few presses on its page, with a wire on it."""
    form(page, kind)
    page.get_by_label("Engine").select_option(engine)
    page.get_by_label("Designs").select_option("paper")
    for label, value in {"Score after": str(ROUNDS), "Budget": "3", **more}.items():
        page.get_by_label(label, exact=True).fill(value)
        page.keyboard.press("Enter")
    page.get_by_role("button", name="Begin", exact=True).click()
    page.wait_for_selector("main[data-page=optimize] [role=tablist]")


def play(page: Page, trial: int) -> None:
    """Play a trial: press now and then until it is scored."""
    page.get_by_role("button", name=f"Play trial {trial}").click()
    for number in range(1, ROUNDS + 1):
        page.wait_for_selector(f".opt-line >> text=/^Press {number} of/")
        wait_for_bullet(page)
        page.keyboard.press(" ", delay=80)
    page.wait_for_selector(f".opt-line >> text=/^Trial {trial}: asynchrony/")


def wait_for_bullet(page: Page) -> None:
    """Wait until the strip shows a bullet."""
    page.wait_for_function(
        """() => {
            const canvas = document.querySelectorAll('.strip canvas')[1];
            if (canvas.width < 2) return false;
            const middle = Math.floor(canvas.height / 2);
            const row = canvas.getContext('2d').getImageData(0, middle, canvas.width, 1);
            return row.data.some((value) => value > 0);
        }"""
    )


def kept_rounds(folder: Path) -> tuple[TaskRound, ...]:
    """Read what is on the disk of a run that nobody plays."""
    rounds = TaskRounds(folder)
    rounds.close()
    return rounds.all


@pytest.fixture
def wire(page: Page) -> Wire:
    """A page on which a run of ROUNDS presses begins, and what it says."""
    heard = Wire(page, "play")
    page.reload()
    page.wait_for_selector("html[data-ready]")
    begin(page)
    return heard


def test_a_press_at_a_known_time_has_a_known_asynchrony(
    page: Page, wire: Wire, studio: RunningStudio
) -> None:
    page.get_by_role("button", name="Play trial 1").click()
    page.wait_for_selector(".opt-line >> text=/^Press 1 of/")
    page.evaluate(PRESS_WHEN_SEEN, 100 / 144)
    page.wait_for_selector(".opt-line >> text=/^Trial 1: asynchrony/")
    folder = studio.project / "optimize" / "1"
    seen = page.evaluate("() => window.seen")
    page.get_by_role("link", name="All runs").click()
    page.wait_for_selector(".opt-start")
    took_ms = button_ms(folder)
    downs, rounds, kept = wire.of("down"), wire.of("round"), wire.of("kept")
    assert len(downs) == len(rounds) == len(kept) == ROUNDS
    for down, over, found, picture in zip(downs, rounds, kept, seen, strict=True):
        # from the times alone: hand, what the button takes, target, the two delays
        expected_ms = (
            down["at_ms"] - over["input"]["ms"] + took_ms - over["target_ms"] - over["display"]["ms"]
        )
        assert found["late_ms"] == pytest.approx(expected_ms, abs=BUTTON_ms)
        # from the pictures: the bullet came between this picture and the one before
        assert 0 <= picture["at_ms"] - over["target_ms"] + CLOCK_ms <= picture["gap_ms"] + 2 * CLOCK_ms
    on_disk = kept_rounds(folder)
    late_ms = [1e3 * (one.activations_s[0] - one.target_s) for one in on_disk]
    assert late_ms == pytest.approx([one["late_ms"] for one in kept], abs=1e-6)


def test_the_clocks_of_page_and_server_are_joined_within_their_bound(page: Page, wire: Wire) -> None:
    """The server's clock is the system's monotonic one, which this process reads as well."""
    page.get_by_role("button", name="Play trial 1").click()
    around = []
    for number in range(1, ROUNDS + 1):
        page.wait_for_selector(f".opt-line >> text=/^Press {number} of/")
        wait_for_bullet(page)
        before_ms = 1e3 * time.monotonic()
        page.keyboard.down(" ")
        around.append((before_ms, 1e3 * time.monotonic()))
        page.keyboard.up(" ")
    page.wait_for_selector(".opt-line >> text=/^Trial 1: asynchrony/")
    for down, over, (before_ms, after_ms) in zip(wire.of("down"), wire.of("round"), around, strict=True):
        at_ms, bound_ms = down["at_ms"] + over["clock_ms"], over["clock_error_ms"]
        assert before_ms - bound_ms <= at_ms <= after_ms + bound_ms
        assert bound_ms < 20


def test_a_run_is_played_stopped_gone_on_with_compared_and_saved(
    page: Page, wire: Wire, studio: RunningStudio
) -> None:
    play(page, 1)
    page.get_by_role("button", name="Play trial 2").click()
    page.wait_for_selector(".opt-line >> text=/^Press 1 of/")
    page.keyboard.press("Escape")
    page.wait_for_selector(".opt-line >> text=/^Paused after 0/")
    page.keyboard.press("Escape")
    page.wait_for_selector(".opt-line >> text=/^Press 1 of/")
    wait_for_bullet(page)
    page.wait_for_selector(".opt-line >> text=/^Press 2 of/")
    page.reload()
    play(page, 2)
    assert [(one.trial, one.attempt) for one in kept_rounds_of(page, studio)] == [
        *[(0, 1)] * ROUNDS,
        (1, 1),
        *[(1, 2)] * ROUNDS,
    ]
    page.get_by_role("link", name="mine").or_(page.locator("a.opt-run")).first.click()
    page.get_by_role("tab", name="Result").click()
    page.wait_for_selector(".opt-compared")
    page.get_by_label("Found", exact=True).select_option("1")
    page.wait_for_selector("th:has-text('actuation, mm') ~ td")
    press_each(page)
    page.get_by_label("Name", exact=True).fill("mine")
    page.locator(".opt-compared").get_by_role("button", name="Save as my button").click()
    page.get_by_role("link", name="Edit mine").click()
    page.wait_for_selector("main[data-page=edit]")
    assert (studio.project / "buttons" / "mine.fdvv.json").exists()


@pytest.fixture
def table(tmp_path: Path) -> Iterator[RunningStudio]:
    """A studio beside which a board stands, on a real terminal line, that somebody presses now and then."""
    rig = KeyedRig(presses=100)
    listed = ((f"serial:{rig.path}", "a board"),), ""
    first = f"from fdvv_people.pages import play_trials\nplay_trials.available_devices = lambda: {listed!r}"
    studio = RunningStudio(tmp_path / "project", first=first)
    rig.start()
    yield studio
    studio.stop()
    rig.end()


def test_a_button_on_the_table_is_pressed_while_the_page_shows_the_bullet(
    context: BrowserContext, table: RunningStudio
) -> None:
    page = context.new_page()
    page.goto(table.address)
    page.wait_for_selector("html[data-ready]")
    begin(page)
    # the device is listed once the studio has looked for it
    expect(page.get_by_label("Press on").locator("option")).to_have_count(3)
    page.get_by_label("Press on").select_option(index=1)
    page.get_by_role("button", name="Play trial 1").click()
    expect(page.get_by_text("Press the button on the table")).to_be_visible()
    wait_for_bullet(page)
    page.keyboard.press(" ", delay=80)  # what the hand does on the page is no press now
    page.wait_for_selector(".opt-line >> text=/^Trial 1: asynchrony/", timeout=40_000)
    page.get_by_role("tab", name="Timing").click()
    expect(page.get_by_text("timed by the device's own clock")).to_be_visible()
    kept = kept_rounds(table.project / "optimize" / "1")
    assert len(kept) == ROUNDS
    assert {(one.timing.source, one.timing.hand) for one in kept} == {(ClockSource.KEY, "button")}
    assert any(one.activations_s for one in kept)


def kept_rounds_of(page: Page, studio: RunningStudio) -> tuple[TaskRound, ...]:
    """Leave the run, so that its files are free, and read them."""
    page.get_by_role("link", name="All runs").click()
    page.wait_for_selector("a.opt-run")
    return kept_rounds(studio.project / "optimize" / "1")


def ended(page: Page, studio: RunningStudio) -> Optimization:
    """End the studio, which opens the runs that its pages show, and open the run's folder."""
    page.goto("about:blank")
    studio.stop()
    return Optimization.open(studio.project / "optimize" / "1")


def press_each(page: Page) -> None:
    """Press both designs on the stage."""
    for side in ("start", "found"):
        page.get_by_role("button", name=side, exact=True).click()
        press_once(page, side)


def press_once(page: Page, name: str) -> None:
    """Press what is under the finger until its key has gone down."""
    page.wait_for_selector(f".press-view[aria-label^='{name} ']")
    page.wait_for_selector(".press-lamp[data-key='0']")
    page.focus(".press-view")
    page.keyboard.down(" ")
    page.wait_for_selector("[data-value='actuations'] >> text=/^1$/", state="attached")
    page.keyboard.up(" ")


def test_a_suggestion_is_changed_before_it_is_played_and_a_trial_abandoned(
    page: Page, wire: Wire, studio: RunningStudio
) -> None:
    page.get_by_role("button", name="Show the next design").click()
    page.get_by_label("actuation", exact=True).fill("1.25")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Use this design").click()
    page.wait_for_selector("text=edited by you")
    page.get_by_role("button", name="Abandon this trial").click()
    page.wait_for_selector("td:has-text('abandoned')")
    with ended(page, studio) as session:
        (trial,) = session.trials
    assert (trial.state, trial.design["actuation_mm"]) == (TrialState.ABANDONED, 1.25)


def test_a_simulated_person_goes_on_while_the_page_is_away(page: Page, studio: RunningStudio) -> None:
    begin(page, kind="A simulated person plays", Retest="2")
    page.wait_for_selector("text=/of 17 trials/", state="attached")
    page.reload()
    page.wait_for_selector("section.verdict >> text=/, simulated[.;]/", timeout=LONG_ms)
    page.get_by_role("tab", name="Play").click()
    page.wait_for_selector("text=/^simulated person 0: 1. of 17 trials, done/")
    assert page.locator(".tag.simulated").count() >= 2
    expect(page.locator("[aria-label=Progress] tbody tr")).to_have_count(3)
    with ended(page, studio) as session:
        assert (len(session.trials), session.finished) == (3, True)
        # four switches and the fixed design are in each of two blocks
        assert len(session.retests) == (12 if session.recommended() == session.start else 14)


def test_the_best_design_is_played_again_against_the_start_and_nobody_knows_which_is_which(
    page: Page, studio: RunningStudio
) -> None:
    (start,) = paper_space().of_unit([0.5] * 8)
    about = {OptimizeSetup.PRESSES: ROUNDS, OptimizeSetup.RETEST: 2, OptimizeSetup.NAME: "mx-clear"}
    setup = OptimizeSetup(engine="sobol", level="easy", budget=2, start=start, about=about)
    with Optimization.create(studio.project / "optimize" / "1", setup) as session:
        for score_ms in (90.0, 60.0):
            (trial,) = session.ask()
            session.show(trial.number)
            session.answer(trial.number, {"asynchrony_ms": Score(score_ms, 5.0)})
    page.goto(f"{page.url.partition('#')[0]}#/optimize/1")
    for number in (1, 2, 3, 4):
        page.get_by_role("button", name=f"Play again, blind: {number} of 4").click(timeout=LONG_ms)
        page.wait_for_selector(
            ".opt-line >> text=/which button it was is not shown/", state="attached", timeout=60_000
        )
    expect(page.get_by_role("region", name="Verdict")).to_contain_text("mx-clear")
    page.get_by_role("tab", name="Play").click()
    expect(page.locator("[aria-label=Progress] tbody tr")).to_have_count(2)


def test_a_person_rates_a_button_after_a_reload_too_and_takes_another_compromise(
    page: Page, studio: RunningStudio
) -> None:
    about = {OptimizeSetup.PRESSES: ROUNDS, OptimizeSetup.RETEST: 2}
    objectives = (ASYNCHRONY, LIKING)
    setup = OptimizeSetup(engine="sobol", level="easy", budget=5, objectives=objectives, about=about)
    with Optimization.create(studio.project / "optimize" / "1", setup) as session:
        for score_ms, liked in ((90.0, 2.0), (60.0, 3.0), (65.0, 5.0), (70.0, 6.0)):
            (trial,) = session.ask()
            session.show(trial.number)
            session.answer(
                trial.number, {ASYNCHRONY.name: Score(score_ms, 1.0), LIKING.name: Score(liked, 0.1)}
            )
    page.goto(f"{page.url.partition('#')[0]}#/optimize/1")
    page.get_by_role("button", name="Play trial 5").click()
    questions = page.get_by_role("form", name="Questions about this button")
    expect(questions).to_be_visible(timeout=LONG_ms)
    page.reload()
    expect(questions).to_be_visible(timeout=LONG_ms)
    save = questions.get_by_role("button", name="Save answers")
    for group in questions.get_by_role("group").all():
        expect(save).to_be_disabled()
        group.get_by_role("radio", name="5", exact=True).check()
    save.click()
    expect(page.get_by_role("button", name="Play again, blind: 1 of 4")).to_be_visible(timeout=LONG_ms)
    page.get_by_role("tab", name="Result").click()
    take = page.get_by_role("button", name="Take it")
    expect(take.first).to_be_visible(timeout=LONG_ms)
    assert audit(page) == []
    number = int(str(take.first.get_attribute("aria-label")).rpartition(" ")[2]) - 1
    take.first.click()
    expect(page.get_by_role("button", name=f"Take it: trial {number + 1}")).to_have_count(0)
    with ended(page, studio) as session:
        assert session.trials[4].scores[LIKING.name] == liking_score((5, 5, 5, 5))
        assert session.recommended() == session.trials[number].design


def test_a_run_begins_from_what_others_did_if_there_is_any(page: Page, studio: RunningStudio) -> None:
    form(page)
    page.get_by_label("Designs").select_option("paper")
    expect(page.locator(".opt-fields code")).to_contain_text("fdvv optimize population others/easy")
    grid(studio.project / "others" / "easy", "easy")
    page.reload()
    form(page)
    page.get_by_label("Designs").select_option("paper")
    page.get_by_label("Others").select_option("easy")
    page.get_by_label("Designs").select_option("FDV")
    expect(page.get_by_label("Others")).to_have_count(0)
    page.get_by_label("Designs").select_option("paper")
    page.get_by_label("Others").select_option("easy")
    begin(page, "gp")
    expect(page.get_by_text("begun from 5 designs scored by 2 simulated people, easy")).to_be_visible()


def begin_comparing(page: Page, kind: str) -> None:
    """Begin a run of two questions and one that is asked again."""
    form(page, kind)
    page.get_by_label("Designs").select_option("paper")
    for label, value in (("Budget", "2"), ("Retest", "1")):
        page.get_by_label(label, exact=True).fill(value)
        page.keyboard.press("Enter")
    page.get_by_role("button", name="Begin", exact=True).click()


def test_two_are_compared_by_keys_until_the_budget_is_spent(page: Page, studio: RunningStudio) -> None:
    begin_comparing(page, "I compare")
    for number, key in ((1, "2"), (2, "0"), (3, "1")):
        page.wait_for_selector(f"h2:has-text('Comparison {number}')")
        for side in ("A", "B"):
            press_once(page, side)
            page.keyboard.press("x" if side == "A" else key)
    page.wait_for_selector("text=All comparisons are made")
    page.get_by_role("tab", name="Result").click()
    page.wait_for_selector(".opt-compared")
    with ended(page, studio) as session:
        assert [one.answer for one in session.trials] == [Answer.SECOND, Answer.EQUAL]
        assert session.retest_answers in ((Answer.FIRST,), ())


def test_a_line_is_felt_and_answered_by_keys_until_the_budget_is_spent(
    page: Page, studio: RunningStudio
) -> None:
    begin_comparing(page, "I slide")
    choose = page.get_by_role("button", name="This one is best")
    for line, back in ((1, 3), (2, 0)):
        page.wait_for_selector(f"h2:has-text('Line {line}')")
        slider = page.get_by_label("Position on the line")
        for position in range(1, 10):
            expect(slider).to_have_attribute("aria-valuetext", f"{position} of 9")
            expect(choose).to_be_disabled()
            page.wait_for_selector(f".press-view[aria-label^='Position {position} ']")
            page.focus(".press-view")
            # some designs are too stiff for their key to go down: the press counts when it ends
            page.keyboard.down(" ")
            page.wait_for_timeout(500)
            page.keyboard.up(" ")
            expect(slider).to_have_attribute("aria-valuetext", f"{position} of 9, felt")
            if position < 9:
                page.keyboard.press("ArrowRight")
        slider.focus()
        for _ in range(back):
            page.keyboard.press("ArrowLeft")
        expect(choose).to_be_enabled()
        page.keyboard.press("Enter")
    page.wait_for_selector("h2:has-text('Comparison 1')")
    for side in ("A", "B"):
        press_once(page, side)
        page.keyboard.press("x" if side == "A" else "1")
    page.wait_for_selector("text=All lines are answered")
    page.get_by_role("tab", name="Result").click()
    page.wait_for_selector(".opt-compared")
    with ended(page, studio) as session:
        assert [one.best for one in session.trials] == [(5,), (8,)]
        assert session.retest_answers == (Answer.FIRST,)


def test_runs_of_two_people_give_one_button_for_both_to_save(page: Page, studio: RunningStudio) -> None:
    for number, (name, low_mm) in enumerate({"Anna": 1.0, "Ben": 5.0}.items(), start=1):
        scored_run(studio.project / "optimize" / str(number), name, low_mm)
    page.goto(f"{page.url.partition('#')[0]}#/optimize")
    panel = page.get_by_role("region", name="One button for several people")
    find = panel.get_by_role("button", name="Find the button for all")
    panel.get_by_label("Anna, easy").check()
    expect(find).to_be_disabled()
    panel.get_by_label("Ben, easy").check()
    find.click()
    expect(panel.get_by_role("status")).to_contain_text("Personalise: ", timeout=LONG_ms)
    expect(panel.locator("tbody tr")).to_have_count(2)
    assert audit(page) == []
    panel.get_by_role("button", name="Save the group's button").click()
    panel.get_by_role("link", name="Press it").click()
    expect(page).to_have_url(re.compile(r"#/press/own"))


@pytest.mark.parametrize(
    ("how", "tab"),
    [
        ("A simulated person plays", "Play"),
        ("A simulated person plays", "Result"),
        ("I play", "Play"),
        ("I play", "Timing"),
        ("I compare", "Compare"),
        ("I slide", "Compare"),
    ],
)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious_in_a_run(page: Page, how: str, tab: str, scheme: Any) -> None:
    page.emulate_media(color_scheme=scheme)
    form(page, how)
    for label in ("Budget", "Retest"):
        page.get_by_label(label, exact=True).fill("2")
        page.keyboard.press("Enter")
    assert audit(page) == []
    page.get_by_role("button", name="Begin", exact=True).click()
    if "simulated" in how:
        page.wait_for_selector("section.verdict >> text=/, simulated[.;]/", timeout=LONG_ms)
    page.get_by_role("tab", name=tab).click()
    page.wait_for_load_state("networkidle")
    assert audit(page) == []
