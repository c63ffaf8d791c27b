"""What a person sees of a session."""

import io
import re
from collections.abc import Callable

import pytest
from rich.console import Console
from rich.live import Live

from fdvv.cli.rendering.session import LineView, TableView
from fdvv.compensation.method import CurveOutcome
from fdvv.model.curve import Stroke
from fdvv.rendering.session_run import PressDone, PressRequest, VelocityProgress

ASK = PressRequest(100.0, 4.0, 3, 12)
CURVES = tuple(CurveOutcome(stroke, 100.0, (9.0, 5.25), 2.5, 7.75, "") for stroke in Stroke)


def event(done: int = 3, stage: str = "compensate") -> PressDone:
    rows = VelocityProgress(50.0, 0, 6), VelocityProgress(100.0, 3, None, CURVES)
    return PressDone(stage, 100.0, done, 12, None, "", 96.4, "moved it", lambda: rows)


def shown(act: Callable[[TableView], None], person: bool = False, verbose: bool = True) -> str:
    """Return the text that a table leaves on a terminal."""
    stream = io.StringIO()
    live = Live(console=Console(file=stream, force_terminal=True, width=120), auto_refresh=False)
    live.start()
    act(TableView(person, live, lambda stroke_s, draw: draw(f"cue of {stroke_s * 1000:.0f} ms"), verbose))
    live.stop()
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", stream.getvalue())


def test_of_simulated_presses_the_last_is_shown_all_if_asked_and_none_when_json_is_printed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for quiet, verbose, lines in ((False, False, 1), (False, True, 12), (True, True, 0)):
        view = LineView(False, quiet, verbose)
        for done in range(1, 13):
            view.ask(ASK)
            view.done(event(done))
        view.notice("goes on") if quiet else None
        assert len(capsys.readouterr().err.splitlines()) == lines


def test_the_table_has_a_row_per_velocity_with_what_is_known() -> None:
    text = shown(lambda view: view.done(event()))
    assert re.search(r"50 mm/s +0/6 +– +– +– +– +– +–", text)
    assert re.search(r"100 mm/s +3 +5\.2 +2\.5 +7\.8 +5\.2 +2\.5 +7\.8", text)
    assert "best mean" in text
    assert "achieved 96 mm/s" in text


def test_one_line_of_progress_replaces_the_table_unless_details_are_asked_for() -> None:
    text = shown(lambda view: view.done(event()), verbose=False)
    assert "achieved 96 mm/s" in text
    assert "best mean" not in text


def test_the_means_of_a_probe_are_called_medians() -> None:
    assert "median mean" in shown(lambda view: view.done(event(stage="probe")))


def test_a_person_sees_the_cue_below_the_table_and_then_when_to_press() -> None:
    text = shown(lambda view: view.ask(ASK), person=True)
    assert text.index("press 3 of 12: 100 mm/s") < text.index("cue of 40 ms") < text.index("press now")


def test_a_simulated_press_has_no_cue() -> None:
    assert "cue" not in shown(lambda view: view.ask(ASK))


def test_a_notice_stands_above_the_table() -> None:
    assert "goes on [with] it" in shown(lambda view: view.notice("goes on [with] it"))
