"""fdvv device strip, as a person runs it."""

from __future__ import annotations

import json

import pytest

from fdvv_strip.library import LibraryStrip
from tests.support.command_line import Run


def test_a_strip_is_checked_and_every_press_printed(fdvv: Run) -> None:
    ran = fdvv("device", "strip", "--strip", "host", "--rounds", "2")
    assert ran.status == 0
    assert ran.out.splitlines()[:3] == ["round 1: +80.00 ms", "round 2: +80.00 ms", "host (simulated)"]
    report = json.loads(fdvv("device", "strip", "--strip", "host", "--level", "hard", "--json").out)
    assert (report["simulated"], report["edges"], len(report["rounds"])) == (True, 3, 3)
    assert report["asynchrony_ms"] == pytest.approx(80.0, abs=2e-3)


def test_a_rig_renders_a_button_meanwhile(fdvv: Run) -> None:
    played = ("device", "strip", "--strip", "host", "--rounds", "1", "--device", "host")
    assert fdvv(*played, "--button", "mx-brown").status == 0
    ran = fdvv(*played, "--button", "no-such-button")
    assert (ran.status, ran.out) == (2, "")


def test_a_key_line_that_never_rises_is_reported(fdvv: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LibraryStrip, "press_at", lambda line, at_s: None)
    ran = fdvv("device", "strip", "--strip", "host", "--rounds", "1")
    assert ran.status == 1
    assert "round 1: no press" in ran.out
    assert "the key line never rose" in ran.err


def test_a_port_without_a_strip_is_one_line(fdvv: Run) -> None:
    ran = fdvv("device", "strip", "--strip", "serial:/dev/there-is-none")
    assert ran.status == 1
    assert ran.err.startswith("fdvv: /dev/there-is-none: cannot be opened")
    assert fdvv("device", "strip", "--strip", "uno").status == 2
