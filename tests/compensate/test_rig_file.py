"""A known rig survives its file to the bit; a broken file gives one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.compensate import KnownRig, load_rig, rig_from_json, rig_to_json, save_rig
from fdvv.errors import InputError

NUMBER = st.floats(-1e6, 1e6)


@settings(max_examples=10)
@given(
    st.tuples(NUMBER, NUMBER, NUMBER),
    NUMBER,
    st.integers(0, 100),
    st.dictionaries(st.sampled_from(["gain", "mass_g"]), NUMBER),
)
def test_a_round_trip_is_exact(
    gain: tuple[float, float, float], mass: float, presses: int, error: dict[str, float]
) -> None:
    known = KnownRig(gain=gain, mass_g=mass, presses=presses, error=error)
    assert rig_from_json(rig_to_json(known)) == known


def test_a_file_is_written_whole_and_read_back(tmp_path: Path) -> None:
    known = KnownRig(gain=(0.9, 0.07, -0.01), delay_s=3e-4, error={"gain": 0.01})
    save_rig(known, tmp_path / "new" / "a.rig.json")
    assert load_rig(tmp_path / "new" / "a.rig.json") == known
    assert [p.name for p in (tmp_path / "new").iterdir()] == ["a.rig.json"]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"format": "other"}, r"\$.format: not a known rig"),
        ({"version": 9}, "this fdvv reads version 1"),
        ({"mass_g": "heavy"}, r"\$.mass_g: Expected `float`, got `str`"),
        ({"gain": [1.0]}, r"\$.gain"),
        ({"colour": 1}, "unknown field `colour`"),
    ],
)
def test_a_broken_file_is_told_in_one_line(change: dict[str, object], says: str) -> None:
    text = json.dumps({**json.loads(rig_to_json(KnownRig())), **change})
    with pytest.raises(InputError, match=says) as told:
        rig_from_json(text, "a.rig.json")
    assert str(told.value).startswith("a.rig.json: ")


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="check the path"):
        load_rig(tmp_path / "none.rig.json")
