"""What the pages on files say is what the code reads."""

from __future__ import annotations

import json
import re
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from tools import make_schema

from fdvv.recording.file import load_recording, schema
from fdvv.recording.read import read_log

REFERENCE = Path(__file__).resolve().parents[4] / "docs" / "reference"


def block(page: str, language: str) -> str:
    """Return the first block of code in a language of a page."""
    text = (REFERENCE / page).read_text()
    blocks: list[tuple[str, str]] = re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return next(code for tag, code in blocks if tag == language)


@pytest.fixture
def example(tmp_path: Path) -> Path:
    path = tmp_path / "example.recording.jsonl"
    path.write_text(block("recording-file.md", "jsonl"))
    return path


def test_the_example_of_the_recording_file_is_one(example: Path) -> None:
    force, left = load_recording(example).takes[0].streams
    np.testing.assert_allclose(force.values, 0.0512 * np.array([0, 8, 32, 88]))
    assert (force.raw.dtype.str, left.raw.shape) == ("<i2", (2, 3))


def test_the_published_schema_is_up_to_date_and_knows_every_line_of_the_example(example: Path) -> None:
    published = make_schema.RECORDING_OUTPUT.read_text()
    assert published == make_schema.text(schema()), "run python tools/make_schema.py"
    validator = jsonschema.Draft202012Validator(json.loads(published))
    for line in example.read_text().splitlines():
        found = json.loads(line)
        validator.validate(found)
        found["record"]["more"] = 1
        assert not validator.is_valid(found)


def test_the_example_is_decoded_with_the_standard_library_alone(example: Path) -> None:
    printed = StringIO()
    program = block("recording-file.md", "python")
    with chdir(example.parent), redirect_stdout(printed):
        exec(compile(program, "recording-file.md", "exec"), {})
    assert printed.getvalue() == block("recording-file.md", "")


def test_the_example_of_the_serial_text_is_read(tmp_path: Path) -> None:
    (tmp_path / "log.txt").write_text(block("capture-serial.md", ""))
    found = read_log(tmp_path / "log.txt")
    force, sound = found.takes[0].streams
    np.testing.assert_allclose(force.values, 0.0512 * np.array([0, 8, 32]))
    np.testing.assert_allclose(sound.t_s, [0, 0.001, 0.002])
    assert [(mark.name, round(mark.t_s, 9)) for mark in found.takes[0].marks] == [("light on", 0.00125)]
    assert (found.bench.sound_filter_ms, found.warnings) == (0.1, ())
