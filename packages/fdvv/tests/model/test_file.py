import contextlib
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tools import make_schema

from fdvv.errors import InputError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import (
    load_builtin,
    load_model,
    model_from_json,
    model_to_json,
    save_model,
    schema,
)
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpread, ModeSpread, PointSpread, VibrationSpread
from tests.model.strategies import models

ROOT = Path(__file__).parents[4]
CLEAR = load_builtin("mx-clear")
TEXT = model_to_json(CLEAR)
"""As files are that tell of no spread: of version 1."""


def spread_model() -> FDVVModel:
    """The published button as if it had been measured on presses."""
    force_spread = CurveSpread(np.array([0.0, 1.5, 3.9]), np.array([0.5, 2.5, 0.75]), 14, 48.5, 3.25)
    shaken = VibrationSpread(12, 0.05, None, (ModeSpread(6.5, None, 20.0),))
    return replace(
        CLEAR,
        curves=(*(replace(c, spread=force_spread) for c in CLEAR.curves[:2]), *CLEAR.curves[2:]),
        vibrations=(replace(CLEAR.vibrations[0], spread=shaken), *CLEAR.vibrations[1:]),
        travel_spread=PointSpread(0.0125, 46),
        actuation_spread=PointSpread(0.025, 44),
    )


SPREAD = model_to_json(spread_model())
SPREAD_0 = "$.curves[0].spread"


def bits(model: FDVVModel) -> list[bytes]:
    """Every number of a model, sign of zero included."""
    scalars = [model.travel_mm, model.actuation_mm or 0.0, model.reset_mm or 0.0]
    for v in model.vibrations:
        scalars += [v.onset_mm, v.duration_s]
        for mode in v.modes:
            scalars += [mode.frequency_Hz, mode.amplitude_m_s2, mode.decay_1_s, mode.phase_rad]
    arrays = [a for c in model.curves for a in (c.knots_mm, c.control_points_cN)]
    return [np.array(scalars).tobytes(), *(a.tobytes() for a in arrays)]


@settings(max_examples=60, deadline=None)
@given(models())
def test_a_model_comes_back_from_its_text_to_the_bit(model: FDVVModel) -> None:
    text = model_to_json(model)
    again = model_from_json(text)
    assert again == model
    assert bits(again) == bits(model)
    assert model_to_json(again) == text


@pytest.mark.parametrize(
    "number", [-0.0, 1e-300, 5e-324, 0.1 + 0.2, 999999.9999999999, 123456.78901234567, -1 / 3]
)
def test_awkward_numbers_come_back_to_the_bit(number: float) -> None:
    curve = ForceCurve(Stroke.PRESS, None, 1, [0, 0, 4, 4], [number, 1.0])  # type: ignore[arg-type]
    again = model_from_json(model_to_json(FDVVModel("awkward", 4.0, (curve,))))
    assert again.curves[0].control_points_cN.tobytes() == np.array([number, 1.0]).tobytes()


def test_a_saved_model_is_loaded_as_it_was_with_a_name_in_any_script(tmp_path: Path) -> None:
    model = CLEAR.renamed("Schälter-クリック")
    save_model(model, tmp_path / "new" / "m.fdvv.json")
    assert load_model(tmp_path / "new" / "m.fdvv.json") == model


def test_changing_one_control_point_changes_one_line() -> None:
    curve = CLEAR.curves[3]
    forces = curve.control_points_cN.copy()
    forces[7] += 1.0
    curves = tuple(replace(c, control_points_cN=forces) if c is curve else c for c in CLEAR.curves)
    before, after = TEXT.splitlines(), model_to_json(replace(CLEAR, curves=curves)).splitlines()
    assert sum(a != b for a, b in zip(before, after, strict=True)) == 1


def edited(change: Callable[[dict[str, Any]], object], text: str = TEXT) -> str:
    """The text of the published button after a change to its tree."""
    tree = json.loads(text)
    change(tree)
    return json.dumps(tree)


def put(*path: str | int, value: object) -> Callable[[dict[str, Any]], object]:
    def change(tree: Any) -> None:
        for step in path[:-1]:
            tree = tree[step]
        tree[path[-1]] = value

    return change


def drop(*path: str | int) -> Callable[[dict[str, Any]], object]:
    def change(tree: Any) -> None:
        for step in path[:-1]:
            tree = tree[step]
        del tree[path[-1]]

    return change


def refusal(text: str | bytes) -> str:
    """Return the line with which a text is refused, without the name of its file."""
    with pytest.raises(InputError) as caught:
        model_from_json(text, "bad.fdvv.json")
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 300
    return message.removeprefix("bad.fdvv.json: ")


@pytest.mark.parametrize(
    ("change", "place", "said"),
    [
        (put("version", value=3), "$.version", "file version 3, this fdvv reads version 1 or 2"),
        (put("version", value="x" * 9999), "$.version", "file version 'xxx"),
        (drop("version"), "$.version", "file version None"),
        (put("format", value="other"), "$.format", "not an FDVV model"),
        (drop("travel_mm"), "$", "missing required field `travel_mm`"),
        (put("colour", value="red"), "$", "unknown field `colour`"),
        (put("curves", 3, "colour", value="red"), "$.curves[3]", "unknown field `colour`"),
        (put("travel_mm", value="4"), "$.travel_mm", "Expected `float`, got `str`"),
        (put("travel_mm", value=0), "$.travel_mm", "> 0"),
        (put("travel_mm", value=1.0), "$", "actuation_mm must lie within the travel of 1.0 mm, got 2.0"),
        (put("name", value=""), "$.name", "length >= 1"),
        (put("interpolation", value="magic"), "$.interpolation", "expected one of nearest, linear, pchip"),
        (put("curves", value=[]), "$.curves", "length >= 1"),
        (put("curves", 0, "stroke", value="pull"), "$.curves[0].stroke", "expected one of press, release"),
        (put("curves", 2, "degree", value=9), "$.curves[2].degree", "<= 5"),
        (put("curves", 2, "degree", value=4), "$.curves[2]", "15 control points of degree 4 need 20 knots"),
        (put("curves", 1, "knots_mm", 5, value=None), "$.curves[1].knots_mm[5]", "got `null`"),
        (put("curves", 1, "velocity_mm_s", value=-5), "$.curves[1].velocity_mm_s", "> 0"),
        (put("vibrations", 1, "modes", 0, "decay_1_s", value=-1), "$.vibrations[1].modes[0].decay", ">= 0"),
        (lambda tree: tree.clear(), "$.format", "not an FDVV model"),
    ],
)
def test_a_file_that_is_no_model_is_refused_in_one_line_with_the_place(
    change: Callable[[dict[str, Any]], object], place: str, said: str
) -> None:
    message = refusal(edited(change))
    assert message.startswith(place)
    assert said in message


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", "end of file"),
        (TEXT[:1000], "end of file"),
        (TEXT.replace("2.952", "NaN", 1), "line 15, column 29"),
        (TEXT.replace("2.952", "1e999", 1), "$.curves[0].control_points_cN[0]: Number out of range"),
        (TEXT.replace("2.952", "02.952", 1), "line 15, column 30"),
        (TEXT.replace('"name"', "'name'"), "line 4, column 3"),
        ("[" * 1_000_000, "$: Expected `object`"),
        ('{"colour":' + "[" * 1_000_000, "whole file: not valid JSON (maximum recursion"),
        ('{"format":' * 100_000, "whole file"),
        ("\ufeff" + TEXT, "line 1, column 1"),
        (TEXT.encode("utf-16"), "line 1, column 1"),
        (TEXT.replace("mx-clear", "\\ud800", 1), "line 4, column"),
        (TEXT.encode().replace(b"mx-clear", b"\xff\xfe", 1), "whole file: not valid JSON ('utf-8'"),
        (b"\x00" * 100, "line 1, column 1"),
        ("[1, 2]", "$: Expected `object`"),
    ],
)
def test_a_text_that_is_no_json_is_refused_in_one_line_with_the_place(text: str | bytes, place: str) -> None:
    assert refusal(text).startswith(place)


@pytest.mark.parametrize(
    ("change", "place", "said"),
    [
        (put("version", value=1), "$.version", "a file of version 1 has no spreads"),
        (put("travel_spread", "spread_mm", value=-0.1), "$.travel_spread.spread_mm", ">= 0"),
        (put("travel_spread", "presses", value=1), "$.travel_spread.presses", ">= 2"),
        (put("travel_spread", "spread_cN", value=0.1), "$.travel_spread", "unknown field `spread_cN`"),
        (put("actuation_mm", value=None), "$", "actuation_mm is unknown, so it has no spread"),
        (put("curves", 0, "spread", value=3.0), "$.curves[0].spread", "Expected `object | null`"),
        (put("curves", 0, "spread", "displacement_mm", value=[0.0, 1.0]), SPREAD_0, "got 2 and 3"),
        (put("curves", 0, "spread", "displacement_mm", 1, value=4.0), SPREAD_0, "must rise strictly"),
        (put("curves", 0, "spread", "displacement_mm", 2, value=1e9), SPREAD_0, "must stay within"),
        (put("curves", 1, "spread", "spread_cN", 2, value=-1.0), "$.curves[1].spread.spread_cN[2]", ">= 0"),
        (put("curves", 1, "spread", "spread_cN", value=[]), "$.curves[1].spread.spread_cN", "length >= 2"),
        (put("curves", 1, "spread", "achieved_mm_s", value=0), "$.curves[1].spread.achieved_mm_s", "> 0"),
        (put("vibrations", 0, "spread", "modes", value=[{}, {}]), "$.vibrations[0]", "tells of 2 modes"),
        (
            put("vibrations", 0, "spread", "modes", 0, "decay_1_s", value="slow"),
            "$.vibrations[0].spread.modes[0].decay_1_s",
            "Expected `float | null`",
        ),
    ],
)
def test_a_spread_that_is_none_is_refused_in_one_line_with_the_place(
    change: Callable[[dict[str, Any]], object], place: str, said: str
) -> None:
    message = refusal(edited(change, SPREAD))
    assert message.startswith(f"{place}: ")
    assert said in message


def test_a_file_has_the_version_that_it_takes() -> None:
    assert json.loads(TEXT)["version"] == 1
    assert json.loads(SPREAD)["version"] == 2
    without = edited(put("version", value=2))
    assert model_to_json(model_from_json(without)) == TEXT


def test_what_differs_in_nothing_but_a_spread_is_another_model() -> None:
    model = model_from_json(SPREAD)
    assert model == spread_model()
    assert hash(model) == hash(spread_model())
    assert model != CLEAR
    assert replace(model, travel_spread=None) != model
    other = CurveSpread(np.array([0.0, 1.5, 3.9]), np.array([0.5, 2.5, 0.75]), 15, 48.5, 3.25)
    assert replace(model, curves=(replace(model.curves[0], spread=other), *model.curves[1:])) != model


def test_the_order_of_keys_makes_no_difference() -> None:
    turned = json.loads(SPREAD, object_pairs_hook=lambda pairs: dict(reversed(pairs)))
    assert model_from_json(json.dumps(turned)) == spread_model()


@settings(max_examples=100, deadline=None)
@given(st.sampled_from([TEXT, SPREAD]), st.floats(0, 1, exclude_max=True), st.binary(min_size=0, max_size=3))
def test_a_damaged_file_is_refused_or_is_a_model_but_never_a_crash(
    text: str, part: float, damage: bytes
) -> None:
    data = text.encode()
    at = int(part * len(data))
    with contextlib.suppress(InputError):
        model = model_from_json(data[:at] + damage + data[at + 2 :], "bad")
        assert model_from_json(model_to_json(model)) == model


def test_files_that_cannot_be_read_are_refused_by_name(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.fdvv.json", tmp_path):
        with pytest.raises(InputError, match="check the path") as caught:
            load_model(path)
        assert str(path) in str(caught.value)


def test_a_file_that_is_too_large_is_refused_before_it_fills_the_memory(tmp_path: Path) -> None:
    with (tmp_path / "large.fdvv.json").open("wb") as stream:
        stream.truncate(1 << 40)
    with pytest.raises(InputError, match="larger than 64 MB"):
        load_model(tmp_path / "large.fdvv.json")


def test_the_published_schema_is_up_to_date() -> None:
    assert make_schema.OUTPUT.read_text() == make_schema.text(), "run python tools/make_schema.py"


@settings(max_examples=30, deadline=None)
@given(models())
def test_every_model_that_can_be_made_is_valid_by_the_schema(model: FDVVModel) -> None:
    jsonschema.Draft202012Validator(schema()).validate(json.loads(model_to_json(model)))


@pytest.mark.parametrize(
    "change",
    [put("colour", value=1), drop("travel_mm"), put("curves", 0, "degree", value=9), put("version", value=3)],
)
def test_the_schema_refuses_what_the_reader_refuses(change: Callable[[dict[str, Any]], object]) -> None:
    text = edited(change)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(schema()).validate(json.loads(text))
    with pytest.raises(InputError):
        model_from_json(text)


def test_every_field_of_the_schema_is_described_and_documented() -> None:
    page = (ROOT / "docs" / "reference" / "model-file.md").read_text()
    for record in schema()["$defs"].values():
        for field, field_schema in record.get("properties", {}).items():
            assert field_schema.get("description"), field
            assert f"`{field}`" in page, field
