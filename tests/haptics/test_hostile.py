"""Whatever stands in a haptic file, reading it gives a vibration or one line that says what is wrong."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv_haptics.ahap import ahap, read_ahap
from fdvv_haptics.hjif import hjif, read_hjif
from fdvv_haptics.meta_haptic import meta_haptic, read_meta_haptic
from fdvv_haptics.pulse import mode_of

SNAP = Vibration(Stroke.PRESS, None, 1.0, 0.03, (Mode(239.0, 4.6, 131.0),))
FILES: dict[str, tuple[bytes, Callable[[bytes, float], Any]]] = {
    "ahap": (ahap(SNAP).data, read_ahap),
    "haptic": (meta_haptic(SNAP).data, read_meta_haptic),
    "hjif": (hjif(SNAP, "2026-01-01").data, read_hjif),
}
odd = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**30), 10**30),
    st.floats(),
    st.text(max_size=5),
    st.lists(st.integers(), max_size=2),
    st.dictionaries(st.text(max_size=2), st.integers(), max_size=2),
)


def _reads_or_says_why(form: str, data: bytes) -> None:
    read = FILES[form][1]
    try:
        found = read(data, 1.0)
    except InputError as error:
        message = str(error)
    else:
        if form != "hjif" and found.amplitude_m_s2.any():
            mode_of(found)
        return
    assert "\n" not in message
    assert len(message) < 500


@pytest.mark.parametrize("form", FILES)
@settings(max_examples=40, deadline=None)
@given(data=st.binary(max_size=60))
def test_bytes_of_nothing_are_refused(form: str, data: bytes) -> None:
    with pytest.raises(InputError):
        FILES[form][1](data, 1.0)


def _places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    if isinstance(value, dict):
        inside = [p for k, v in value.items() for p in _places(v, (*path, k))]
    elif isinstance(value, list):
        inside = [p for i, v in enumerate(value[:3]) for p in _places(v, (*path, i))]
    else:
        inside = []
    return [*inside, path] if path else inside


@pytest.mark.parametrize("form", FILES)
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_value_in_any_place_is_read_or_refused(form: str, data: st.DataObject) -> None:
    record = json.loads(FILES[form][0])
    place = data.draw(st.sampled_from(_places(record)))
    inside = record
    for key in place[:-1]:
        inside = inside[key]
    if data.draw(st.booleans()):
        inside[place[-1]] = data.draw(odd)
    else:
        del inside[place[-1]]
    _reads_or_says_why(form, json.dumps(record).encode())


@pytest.mark.parametrize("form", FILES)
def test_a_cut_file_is_refused(form: str) -> None:
    whole = FILES[form][0]
    for end in range(0, len(whole) - 2, 97):
        with pytest.raises(InputError):
            FILES[form][1](whole[:end], 1.0)


@pytest.mark.parametrize("form", FILES)
def test_too_much_is_refused_unread(form: str) -> None:
    with pytest.raises(InputError, match="larger than 4 MB"):
        FILES[form][1](b" " * 4_000_001, 1.0)
    with pytest.raises(InputError):
        FILES[form][1](b"[" * 100_000, 1.0)


def test_more_points_than_a_snap_has_are_refused() -> None:
    points = [{"time": i / 1000, "amplitude": 0.5} for i in range(20_001)]
    record = {"version": {"major": 1}, "signals": {"continuous": {"envelopes": {"amplitude": points}}}}
    with pytest.raises(InputError, match="20001 points, at most 20000 are read"):
        read_meta_haptic(json.dumps(record).encode(), 1.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"version": {"major": 2}}, "version 2 is not known here"),
        ({"signals": {"continuous": {"envelopes": {"amplitude": []}}}}, "2 or more times"),
    ],
)
def test_a_haptic_file_of_another_kind_is_refused(change: dict[str, Any], message: str) -> None:
    record = {**json.loads(FILES["haptic"][0]), **change}
    with pytest.raises(InputError, match=message):
        read_meta_haptic(json.dumps(record).encode())


def test_effects_that_begin_at_different_times_are_no_snap() -> None:
    two = Vibration(Stroke.PRESS, None, 1.0, 0.03, (Mode(239.0, 4.6, 131.0), Mode(100.0, 1.0, 50.0)))
    record = json.loads(hjif(two, "2026-01-01").data)
    record["perceptions"][0]["channels"][0]["bands"][1]["effects"][0]["position"] = 48
    with pytest.raises(InputError, match="begin at different times"):
        read_hjif(json.dumps(record).encode())
