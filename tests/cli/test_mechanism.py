"""fdvv mechanism: a switch for a model, from the shell."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.command_line import Run


def test_a_spring_is_printed_with_its_residual_and_the_reason(fdvv: Run) -> None:
    ran = fdvv("mechanism", "mx-red", "--kind", "spring", "--speed", "100")
    assert ran.status == 0
    for said in (
        "wire_mm",
        "within tolerance",
        "wire diameter",
        "twin 100 mm/s (simulated)",
        "straight line",
    ):
        assert said in ran.out


def test_a_miss_has_status_1_and_its_json_says_so(fdvv: Run) -> None:
    ran = fdvv("mechanism", "mx-brown", "--kind", "spring", "--speed", "100", "--json")
    report = json.loads(ran.out)
    assert ran.status == 1
    assert report["met"] is False
    assert report["residual"]["press"]["rms_cN"] > report["wanted_cN"]
    assert [p["speed_mm_s"] for p in report["twin"]["pressed"]] == [0.5, 100.0]
    assert report["twin"]["simulated"] is True


def test_unusable_input_is_refused_in_one_line(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for arguments in (
        ("mechanism", "nothing"),
        ("mechanism", "mx-red", "--kind", "magnet"),
        ("mechanism", "mx-red", "--friction", "9"),
        ("mechanism", "mx-red", "--kind", "spring", "-o", str(tmp_path / "file" / "deep")),
    ):
        ran = fdvv(*arguments)
        assert ran.status == 2
        assert ran.err.count("\n") == 1


def test_without_the_extra_nothing_is_written_and_the_remedy_is_named(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "ezdxf", None)
    folder = tmp_path / "switch"
    ran = fdvv("mechanism", "mx-red", "--kind", "spring", "--speed", "100", "-o", str(folder))
    assert ran.status == 1
    assert "pip install ezdxf" in ran.err
    assert not folder.exists()
