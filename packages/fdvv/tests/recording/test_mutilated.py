"""Damaged logs of every format: a recording or one line of refusal, nothing else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.eventlog import line_of
from fdvv.recording.read import read_log
from fdvv.recording.types import Recording
from tests.recording.files import NAMES, TEXTS, wav
from tests.recording.takes import TAKE, head
from tests.support.campaign import pick
from tests.support.damage import DAMAGES, Damage

pytestmark = pytest.mark.campaign
SETTINGS = settings(
    max_examples=pick(15, 1000),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def read_or_refused(path: Path) -> Recording | None:
    """Read a file; None if one line said why it cannot be."""
    refused = ""
    try:
        return read_log(path)
    except InputError as error:
        refused = str(error)
    assert "\n" not in refused
    assert refused.startswith(str(path))
    return None


def check(path: Path, content: bytes) -> None:
    """Read a file: what comes out is valid, or one line says why nothing does."""
    path.write_bytes(content)
    found = read_or_refused(path)
    if found is None:
        return
    # a Recording cannot be built wrong; that its takes hold what the file does is to be checked
    assert all("\n" not in warning for warning in found.warnings)
    assert found.takes[0].streams or found.takes[0].marks
    assert all(stream.t_s.size for stream in found.takes[0].streams)


@pytest.mark.parametrize("name", TEXTS)
@given(damages=st.lists(DAMAGES, min_size=1, max_size=3))
@SETTINGS
def test_a_mutilated_log_is_read_or_refused(tmp_path: Path, name: str, damages: list[Damage]) -> None:
    data = TEXTS[name].encode()
    for damage in damages:
        data = damage(data)
    check(tmp_path / NAMES.get(name, "a.csv"), data)


@pytest.mark.parametrize("width", [1, 2, 3])
@given(damages=st.lists(DAMAGES, min_size=1, max_size=3))
@SETTINGS
def test_a_mutilated_sound_is_read_or_refused(tmp_path: Path, width: int, damages: list[Damage]) -> None:
    pytest.importorskip("soundfile")
    data = wav(np.random.default_rng(1).integers(-100, 100, 300), width, 2)
    for damage in damages:
        data = damage(data)
    check(tmp_path / "a.wav", data)


@given(data=st.binary(max_size=300))
@SETTINGS
def test_any_bytes_at_all_are_read_or_refused(tmp_path: Path, data: bytes) -> None:
    check(tmp_path / "a.csv", data)


PLAIN = st.none() | st.booleans() | st.integers(-9, 2**40) | st.floats(-1e9, 1e9) | st.text(max_size=8)
VALUE = st.recursive(
    PLAIN,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)
FIELDS = ("name", "bench", "takes", "streams", "marks", "number", "values", "stream", "version", "t_s", "raw")


@given(
    records=st.lists(
        st.tuples(st.sampled_from(["head", "take", "mend"]), st.sampled_from(FIELDS), VALUE), max_size=4
    )
)
@SETTINGS
def test_any_record_at_all_is_read_or_refused(tmp_path: Path, records: list[tuple[str, str, object]]) -> None:
    whole: dict[str, dict[str, object]] = {
        "head": head(),
        "take": {**TAKE, "streams": []},
        "mend": {"values": {"person": "A"}, "take": None, "stream": None, "why": "", "made": ""},
    }
    lines = [line_of({"head": head()}), line_of({"take": {**TAKE, "streams": []}})]
    lines += [line_of({key: {**whole[key], field: value}}) for key, field, value in records]
    path = tmp_path / "a.recording.jsonl"
    path.write_bytes(b"".join(lines))
    read_or_refused(path)
