"""A known rig, and what it has taught, survive their file to the bit; a broken file gives one line."""

from __future__ import annotations

import json
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.compensation.identification.rig_file import LearnedRig, load_learned_rig, load_rig, save_rig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import InputError
from fdvv.model.surface import ForceSurface

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
    known = RigModel(gain=gain, mass_g=mass, presses=presses, error=error)
    with TemporaryDirectory() as folder:
        save_rig(known, Path(folder) / "a.rig.json")
        assert load_rig(Path(folder) / "a.rig.json") == known


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"format": "other"}, r"\$.format: not an identified rig"),
        ({"version": 9}, "this fdvv reads version 1"),
        ({"mass_g": "heavy"}, r"\$.mass_g: Expected `float`, got `str`"),
        ({"gain": [1.0]}, r"\$.gain"),
        ({"colour": 1}, "unknown field `colour`"),
    ],
)
def test_a_broken_file_is_refused_in_one_line(tmp_path: Path, change: dict[str, object], says: str) -> None:
    path = tmp_path / "a.rig.json"
    save_rig(RigModel(), path)
    path.write_text(json.dumps({**json.loads(path.read_text()), **change}))
    with pytest.raises(InputError, match=says) as caught:
        load_rig(path)
    assert str(caught.value).startswith(f"{path}: ")


def memory(seed: int = 0) -> LearnedRig:
    random = np.random.default_rng(seed)
    tables = random.normal(size=(2, 3, 81))
    residual = ForceSurface(
        0.05 * np.arange(81, dtype=np.float64), np.array([50.0, 100.0, 150.0]), tables[0], tables[1]
    )
    return LearnedRig(RigModel(gain=(0.9, 0.07, -0.01)), residual, 4.0, random.uniform(1, 5, (2, 3)))


@pytest.mark.parametrize("seed", range(3))
def test_what_was_taught_comes_back_to_the_bit(tmp_path: Path, seed: int) -> None:
    saved = memory(seed)
    save_rig(saved, tmp_path / "a.rig.json")
    again = load_learned_rig(tmp_path / "a.rig.json")
    assert again.rig == saved.rig == load_rig(tmp_path / "a.rig.json")
    assert again.travel_mm == saved.travel_mm
    np.testing.assert_array_equal(again.error_cN, saved.error_cN)
    for name in ("displacement_mm", "velocity_mm_s", "press_cN", "release_cN"):
        np.testing.assert_array_equal(getattr(again.residual, name), getattr(saved.residual, name))


def test_a_rigs_numbers_alone_have_taught_nothing(tmp_path: Path) -> None:
    save_rig(RigModel(), tmp_path / "a.rig.json")
    with pytest.raises(InputError, match=r"\$\.learned: holds the rig's model.*--save-rig") as caught:
        load_learned_rig(tmp_path / "a.rig.json")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"press_cN": [[1.0]]}, r"\$\.learned: tables must be"),
        ({"press_cN": [[1.0], [1.0, 2.0]]}, r"\$\.learned: "),
        ({"error_cN": [[1.0], [2.0]]}, "finite errors"),
        ({"error_cN": [[1.0]]}, r"\$\.learned\.error_cN"),
        ({"travel_mm": 0.0}, "travel above 0"),
        ({"velocity_mm_s": [1.0, 1.0, 2.0]}, "rise strictly"),
        ({"velocity_mm_s": "fast"}, r"\$\.learned\.velocity_mm_s"),
        ({"surprise": 1}, "unknown field `surprise`"),
    ],
)
def test_damage_in_learned_values_is_refused_in_one_line(
    tmp_path: Path, change: dict[str, object], says: str
) -> None:
    path = tmp_path / "a.rig.json"
    save_rig(memory(), path)
    document = json.loads(path.read_text())
    document["learned"] |= change
    path.write_text(json.dumps(document))
    for read in (load_learned_rig, load_rig):
        with pytest.raises(InputError, match=says) as caught:
            read(path)
        assert str(caught.value).startswith(f"{path}: ")
        assert "\n" not in str(caught.value)


def test_a_cut_file_is_refused_and_a_failed_write_leaves_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.rig.json"
    save_rig(memory(), path)
    before = path.read_bytes()
    path.write_bytes(before[:1000])
    with pytest.raises(InputError, match="not valid JSON"):
        load_learned_rig(path)
    path.write_bytes(before)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(OSError, match="No space"):
        save_rig(memory(1), path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.rig.json"]
