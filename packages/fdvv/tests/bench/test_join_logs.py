"""A session kept by other programs, an export of Motive and the text of a board, comes to the same curves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.bench.join_logs import join_logs
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.preprocess.process import Settings, process
from fdvv.recording.types import Bench, Quantity, Recording, Stage
from fdvv.testing.captured import CapturedSession, PACES_mm_s, captured_session

FRAME_Hz = 256.0


def text_of_board(recording: Recording) -> str:
    """Write force, closures and light as a capture board would: one long log."""
    lines: list[tuple[float, str]] = []
    for take in recording.takes:
        for stream in take.of(Quantity.FORCE):
            lines += [(t, f"F {round(1e6 * t)} {n}") for t, n in zip(stream.t_s, stream.raw, strict=True)]
        lines += [(mark.t_s, f"! {round(1e6 * mark.t_s)} {mark.name}") for mark in take.marks]
    force = next(s for take in recording.takes for s in take.of(Quantity.FORCE))
    head = f"# fdvv-capture 1\n# channel F force_cN scale={force.scale} zero={force.zero}\n"
    return head + "\n".join(line for _, line in sorted(lines)) + "\n"


def motive(recording: Recording) -> str:
    """Write the markers as Motive exports them; the light is a marker that is seen while it is lit."""
    rows: dict[int, list[str]] = {}
    first_s = min(s.t_s[0] for take in recording.takes for s in take.of(Quantity.MARKER))
    for take in recording.takes:
        left, right, light = (
            next(s for s in take.streams if s.name == n) for n in ("left", "right", "light")
        )
        for t, a, b, lit in zip(left.t_s, left.values, right.values, light.values, strict=True):
            cells = [f"{v:.6f}" if np.isfinite(v) else "" for v in (*a, *b)]
            led = ["1.0", "2.0", "3.0"] if lit > 0.5 else ["", "", ""]
            rows[round((t - first_s) * FRAME_Hz)] = cells + led
    last = max(rows)
    names = [name for name in ("cap:left", "cap:right", "led") for _ in range(3)]
    head = [
        "Format Version,1.23,Take Name,session,Capture Frame Rate,256.000000,Export Frame Rate,256.000000,"
        f"Total Exported Frames,{last + 1},Length Units,Millimeters,Coordinate Space,Global",
        "",
        ",Type," + ",".join(["Marker"] * 9),
        ",Name," + ",".join(names),
        ",ID," + ",".join(f'"{i // 3}"' for i in range(9)),
        ",," + ",".join(["Position"] * 9),
        "Frame,Time (Seconds)," + ",".join(["X", "Y", "Z"] * 3),
    ]
    empty = [""] * 9
    body = [f"{i},{i / FRAME_Hz:.6f}," + ",".join(rows.get(i, empty)) for i in range(last + 1)]
    return "\n".join(head + body) + "\n"


@pytest.fixture(scope="module")
def session() -> CapturedSession:
    return captured_session("mx-clear", 21, presses=6, probe=False)


@pytest.fixture
def logs(session: CapturedSession, tmp_path: Path) -> list[Path]:
    presses = [take for take in session.recording.takes if take.stage is Stage.PRESS]
    numbered = tuple(replace(take, number=i) for i, take in enumerate(presses, 1))
    kept = Recording("mx-clear", numbered, simulated=True)
    (tmp_path / "take 1.csv").write_text(motive(kept))
    (tmp_path / "board.log").write_text(text_of_board(kept))
    return [tmp_path / "take 1.csv", tmp_path / "board.log"]


def test_curves_of_joined_logs_are_near_the_truth(session: CapturedSession, logs: list[Path]) -> None:
    facts = session.recording.bench
    recording = join_logs(logs, "mx-clear", ["cap:left", "cap:right"], "led", facts)

    done = process(recording, Settings(paces_mm_s=PACES_mm_s))

    assert recording.bench == facts
    assert done.clock.edges > 100
    press = [c for c in done.curves if c.stroke is Stroke.PRESS]
    assert [c.velocity_mm_s for c in press] == list(PACES_mm_s)
    slow = press[0]
    inside = (slow.displacement_mm > 0.3) & (slow.displacement_mm < 3.7)
    assert np.sqrt(np.nanmean((slow.force_cN - session.true_cN(slow))[inside] ** 2)) < 3.0
    assert done.travel_mm.value == pytest.approx(session.travel_mm, abs=0.06)
    assert done.actuation_mm is not None
    assert done.actuation_mm.value == pytest.approx(session.true_actuation_mm(), abs=0.06)


def test_a_marker_that_is_not_there_is_reported_with_those_that_are(logs: list[Path]) -> None:
    with pytest.raises(
        InputError, match=r"no take has a marker 'cap:top'; there are 'cap:left', 'cap:right', 'led'"
    ):
        join_logs(logs, "mx-clear", ["cap:top"])


def test_logs_that_contradict_each_other_are_reported_in_one_line(logs: list[Path]) -> None:
    text = logs[1].read_text()
    other = logs[1].with_name("other.log")
    other.write_text(text.replace("# channel", "# bench tip_mass_g=3\n# channel", 1))
    logs[1].write_text(text.replace("# channel", "# bench tip_mass_g=2\n# channel", 1))

    with pytest.raises(InputError, match="differ in tip_mass_g"):
        join_logs([*logs, other], "mx-clear", bench=Bench())
