from __future__ import annotations

import os
import subprocess
import sys

import pytest

from fdvv.force_text import VARIABLE, ForceTitle, force_name, force_number, force_text, force_unit, shown_in


def test_a_force_is_written_in_the_unit_shown_with_as_many_digits_as_say_the_same() -> None:
    assert force_text(12.34, ".1f") == "12.3 cN"
    with shown_in("N"):
        assert force_text(12.34, ".1f") == "0.123 N"
        assert (force_number(2), force_number(-3.5)) == ("0.02", "-0.035")
        assert force_number(3.5, "+.1f") == "+0.035"
    with shown_in("gf"):
        assert force_text(98.0665, ".1f", "/mm") == "100.0 gf/mm"
        assert force_number(float("nan"), ".1f") == "nan"
    assert force_unit() == "cN"


def test_a_name_of_a_force_becomes_a_title_and_others_stay() -> None:
    with shown_in("gf"):
        title = force_name("pre_slope_cN_mm", 3)
        assert title == "pre_slope_gf_mm"
        assert isinstance(title, ForceTitle)
        assert not isinstance(force_name("travel_mm"), ForceTitle)
    with shown_in("N"):
        assert ForceTitle("mean {}").digits == 4


def test_a_worker_inherits_the_unit() -> None:
    with shown_in("N"):
        code = "from fdvv.force_text import force_text; print(force_text(50))"
        assert subprocess.check_output([sys.executable, "-c", code], text=True) == "0.50 N\n"


def test_an_unknown_unit_in_the_environment_is_cN(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "pound")
    assert force_text(5) == "5 cN"
    with shown_in("gf"):
        pass
    assert os.environ[VARIABLE] == "pound"
