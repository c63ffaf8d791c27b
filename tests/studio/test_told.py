"""How errors are told on the page."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import DeviceError, InputError
from fdvv.studio._told import told


def test_no_path_of_the_machine_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as missing:
        (tmp_path / "none" / "kept.json").read_text()
    assert told(missing.value) == "kept.json: No such file or directory"
    assert (
        told(InputError(tmp_path / "a.json", "$.name", "is empty", "name it")) == "$.name: is empty; name it"
    )


def test_what_has_no_file_or_no_number_is_told_as_it_is() -> None:
    assert told(OSError(28, "No space left on device")) == "No space left on device"
    assert told(OSError("broken")) == "broken"
    assert told(DeviceError("gone")) == "gone"
