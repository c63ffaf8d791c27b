"""JNDs of a study's people in their file: identities, beside the literature's, and broken files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.model.jnd_file import FILE_NAME, jnds_of, load_jnds, project_jnds, save_jnds
from fdvv.model.noticeable import DIMENSIONS, LITERATURE, Dimension
from tests.support.jnds import as_literature, measured, record_of
from tests.support.kill import Killed, kill_at


def test_people_who_notice_as_the_literature_says_change_no_figure() -> None:
    found = jnds_of(record_of(*map(as_literature, DIMENSIONS)))
    for name, value in LITERATURE.to_dict().items():
        if name != "origin":
            assert found.to_dict()[name] == pytest.approx(value)
    assert found.origin == "JNDs of 12 people of study weights"


@given(st.floats(0.1, 10.0), st.floats(5.0, 400.0))
def test_the_jnd_at_the_reference_is_what_was_measured(times: float, force_cN: float) -> None:
    ratio = min(max(times * 0.1, 0.001), 10.0)
    found = jnds_of(record_of(measured("force", ratio, force_cN), measured("snap", ratio, 20.0)))
    assert float(found.force_cN(force_cN)) == pytest.approx(ratio * force_cN)
    assert found.snap_cN == pytest.approx(ratio * 20.0)
    above = 7.0
    found = jnds_of(record_of(measured("vibration", ratio, 4.0, above=above)))
    assert float(found.vibration(above)) == pytest.approx(ratio * above)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_twice_the_jnd_is_half_the_distance_and_leaves_the_others(dimension: Dimension) -> None:
    once, twice = (jnds_of(record_of(as_literature(dimension, times))) for times in (1.0, 2.0))
    sizes = np.array([1.0, 30.0, 200.0])
    share = {one: 0.5 if one == dimension else 1.0 for one in DIMENSIONS}
    np.testing.assert_allclose(twice.force_steps(sizes), share["force"] * once.force_steps(sizes))
    np.testing.assert_allclose(1 / twice.snap_cN, share["snap"] / once.snap_cN)
    np.testing.assert_allclose(twice.vibration_steps(sizes), share["vibration"] * once.vibration_steps(sizes))
    assert f"JNDs of {dimension} of 12 people" in once.origin


def test_far_above_the_reference_a_jnd_is_a_constant_part_and_far_below_a_constant_force() -> None:
    found = jnds_of(record_of(measured("force", 0.2, 60.0)))
    assert float(found.force_cN(1e6)) / 1e6 == pytest.approx(found.force_ratio, rel=1e-3)
    assert float(found.force_cN(0.0)) == pytest.approx(found.force_ratio * 30.0)


def test_a_threshold_at_another_share_is_carried_over_to_three_of_four() -> None:
    # 70.7 % right is 0.545 of the unit normal, 75 % is 0.674
    strict = jnds_of(record_of(measured("force", 0.1, 60.0), share_correct=0.5**0.5))
    usual = jnds_of(record_of(measured("force", 0.1, 60.0)))
    assert strict.force_ratio / usual.force_ratio == pytest.approx(0.67449 / 0.54495, rel=1e-3)


def test_of_two_references_the_geometric_mean_counts() -> None:
    pair = (as_literature("force", 0.5, 40.0), as_literature("force", 8.0, 90.0))
    assert jnds_of(record_of(*pair)).force_ratio == pytest.approx(2.0 * LITERATURE.force_ratio)


def test_a_project_judges_by_its_file_and_without_it_by_the_literature(tmp_path: Path) -> None:
    assert project_jnds(tmp_path) is LITERATURE
    record = record_of(as_literature("force", 2.0), simulated=True)
    save_jnds(record, tmp_path / FILE_NAME)
    found = project_jnds(tmp_path)
    assert found == load_jnds(tmp_path) == load_jnds(tmp_path / FILE_NAME) == jnds_of(record)
    assert found.origin == "JNDs of force of 12 people of study weights (simulated)"
    (tmp_path / FILE_NAME).unlink()
    assert project_jnds(tmp_path) is LITERATURE


def test_a_killed_write_leaves_the_file_that_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / FILE_NAME
    save_jnds(record_of(as_literature("force", 2.0)), path)
    before = path.read_bytes()
    with kill_at(0, monkeypatch), pytest.raises(Killed):
        save_jnds(record_of(as_literature("force", 3.0)), path)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == [FILE_NAME]


def test_the_sources_say_who_was_measured_at_what_and_keep_the_others() -> None:
    sources = {one.of: one for one in jnds_of(record_of(measured("force", 0.11, 66.0))).sources}
    assert sources["force"].source == (
        "12 people of study weights, 75 % right at 11.0 % (8.8 to 13.8 %) of the 66 cN of MX Clear"
    )
    assert "every place of a stroke" in sources["force"].assumed
    literature = {one.of: one for one in LITERATURE.sources}
    assert {of for of, one in sources.items() if one != literature[of]} == {"force"}


def test_what_should_not_be_relied_on_is_said() -> None:
    assert record_of(measured("force", 0.1, 60.0)).doubts() == []
    (proxy,) = record_of(measured("force", 0.1, 60.0), simulated=True).doubts()
    assert "no evidence" in proxy
    for low, high in ((0.02, 0.5), (None, None)):
        jnd = msgspec.structs.replace(measured("force", 0.1, 60.0), low=low, high=high)
        assert "measure more people" in record_of(jnd).doubts()[0]


def document(**changes: Any) -> dict[str, Any]:
    found: dict[str, Any] = msgspec.to_builtins(record_of(measured("force", 0.1, 60.0)))
    first = {**found["jnds"][0], **changes.pop("first", {})}
    return {**found, "jnds": [first], **changes}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "not valid JSON"),
        ("{", "not valid JSON"),
        (json.dumps(document(format="fdvv-rig")), "not a file of JNDs"),
        (json.dumps(document(version=2)), "file version 2"),
        (json.dumps(document(jnds=[])), "$.jnds"),
        (json.dumps(document(share_correct=0.5)), "$.share_correct"),
        (json.dumps(document(people=0)), "$.people"),
        (json.dumps(document(weight=1)), "weight"),
        (json.dumps(document(first={"ratio": 0})), "$.jnds[0].ratio"),
        (json.dumps(document(first={"standard": -1})), "$.jnds[0].standard"),
        (json.dumps(document(first={"dimension": "sound"})), "$.jnds[0].dimension"),
        (json.dumps(document(first={"above": 3.0})), "a JND of force must not have it"),
        (json.dumps(document(first={"dimension": "vibration", "unit": "m/s²"})), "must have it"),
    ],
)
def test_a_broken_file_is_refused_in_one_line_that_names_it(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / FILE_NAME
    path.write_text(text)
    with pytest.raises(InputError) as refused:
        project_jnds(tmp_path)
    line = str(refused.value)
    assert said in line
    assert str(path) in line
    assert "\n" not in line
    assert "fdvv study jnds" in line or "install" in line


def test_a_folder_without_the_file_is_no_project_that_measured(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"holds no jnds\.json; write one: fdvv study jnds"):
        load_jnds(tmp_path)
