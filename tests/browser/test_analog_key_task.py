"""The optimisation's task, played with a key that tells how deep it is: from a recording, to its end."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from playwright.sync_api import expect

from fdvv_people.optimize.run.session import Optimization
from fdvv_people.task.rounds import ClockSource
from tests.browser.accessibility import audit
from tests.browser.test_optimize import ROUNDS, begin, kept_rounds
from tests.browser.wire import Wire
from tests.studio.running import RunningStudio

if TYPE_CHECKING:
    from playwright.sync_api import Page

HEAD = "# fdvv key recording 1\n# device: drawn\n# key: K\n# rate_Hz: 1000\n# full_scale_mm: 4\n"
TAP_mm = np.concatenate(
    [np.zeros(250), np.linspace(0, 4, 60), np.full(60, 4.0), np.linspace(4, 0, 80), np.zeros(250)]
)
"""Every 700 ms, read every millisecond: in any flight of the bullet there are presses."""


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "taps.csv"
    depths = np.round(np.tile(TAP_mm, 10) / 4 * 255) / 255 * 4
    rows = "".join(f"{i},{depth:.4f}\n" for i, depth in enumerate(depths))
    path.write_text(f"{HEAD}t_ms,depth_mm\n{rows}")
    return path


def crossings_ms(said: Sequence[dict[str, Any]], place_mm: float) -> list[float]:
    """Return when what the page said of the key passed a place on its way down."""
    found = []
    for a, b in itertools.pairwise(said):
        if a["displacement_mm"] < place_mm <= b["displacement_mm"]:
            part = (place_mm - a["displacement_mm"]) / (b["displacement_mm"] - a["displacement_mm"])
            found.append(a["at_ms"] + part * (b["at_ms"] - a["at_ms"]))
    return found


def test_a_run_is_played_to_its_end_with_a_recorded_key(
    page: Page, studio: RunningStudio, recording: Path
) -> None:
    wire = Wire(page, "play")
    page.reload()
    page.wait_for_selector("html[data-ready]")
    begin(page, Budget="2", Retest="0")
    page.get_by_label("Press on").select_option(label="a simulated button, with an analog keyboard")
    page.get_by_label("Repeat").check()
    page.get_by_label("A recording of a key").set_input_files(recording)
    page.wait_for_selector("text=Recording of drawn, K")
    for trial in (1, 2):
        page.get_by_role("button", name=f"Play trial {trial}").click()
        expect(page.get_by_text("Press your key")).to_be_visible()
        # after the last trial the page goes on to the result, and hides the line
        line = f".opt-line >> text=/^Trial {trial}: asynchrony/"
        page.wait_for_selector(line, state="attached", timeout=60_000)
    page.get_by_role("link", name="All runs").click()
    page.wait_for_selector("a.opt-run")
    folder = studio.project / "optimize" / "1"
    with Optimization.open(folder) as session:
        designs = [trial.design for trial in session.trials]
        assert session.finished
    kept, rounds = kept_rounds(folder), wire.of("round")
    assert {(one.timing.source, one.timing.hand) for one in kept} == {(ClockSource.PAGE, "analog")}
    assert len(kept) == len(rounds) == 2 * ROUNDS
    off_ms = []
    for one, said in zip(kept, rounds, strict=True):
        crossed = np.array(crossings_ms(wire.of("follow"), designs[one.trial]["actuation_mm"]))
        inside = crossed[(crossed >= said["start_ms"]) & (crossed <= said["end_ms"])]
        found = 1e3 * np.array(one.activations_s) + said["input"]["ms"]
        assert found.size == inside.size >= 2
        off_ms += (found - inside).tolist()
    assert off_ms == pytest.approx([0.0] * len(off_ms), abs=0.05)
    ways_ms = [one.timing.transport_ms or np.nan for one in kept]
    sys.stdout.write(f"from the report to the server, taken out: {np.round(ways_ms, 1)} ms\n")


def test_the_key_is_chosen_where_axe_finds_nothing_serious(page: Page) -> None:
    begin(page)
    page.get_by_label("Press on").select_option(label="a simulated button, with an analog keyboard")
    page.get_by_role("button", name="Play a simulated key").click()
    page.wait_for_selector(".tag.simulated:has-text('simulated')")
    assert audit(page) == []
