"""Drives by name, and what the commands know of them."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType

import pytest

from fdvv import extras
from fdvv.device.open import KINDS, open_board, open_device, pressed_by_person
from fdvv.errors import BuildError, DeviceError, InputError

DRIVES = ("moteus", "odrive", "simplefoc")


@pytest.mark.parametrize("kind", DRIVES)
def test_a_drive_is_a_known_device_that_a_person_presses(kind: str) -> None:
    assert f"{kind}:FILE.toml" in KINDS
    assert pressed_by_person(f"{kind}:stage.toml")
    assert not pressed_by_person(kind)
    assert extras.installed("devices")[kind].load() is not None


@pytest.mark.parametrize("kind", DRIVES)
def test_an_absent_package_is_one_line(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "installed", lambda _kind: MappingProxyType({}))
    with pytest.raises(BuildError, match="it comes with fdvv-drives: pip install fdvv-drives"):
        open_device(f"{kind}:stage.toml")


@pytest.mark.parametrize("kind", DRIVES)
def test_no_file_or_no_such_file_is_one_line(kind: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"names no stage file; write {kind}:FILE.toml"):
        open_device(kind)
    with pytest.raises(InputError, match="No such file"):
        open_device(f"{kind}:{tmp_path / 'none.toml'}")


def test_a_drive_is_no_board(monkeypatch: pytest.MonkeyPatch) -> None:
    class Entry:
        @staticmethod
        def load() -> object:
            return lambda _where: object()

    monkeypatch.setattr(extras, "installed", lambda _kind: MappingProxyType({"moteus": Entry()}))
    with pytest.raises(InputError, match="has no board with the firmware"):
        open_board("moteus:stage.toml")


def test_a_port_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "stage.toml"
    path.write_text(
        '[moteus]\nport = "/dev/no-such-port"\n[stage]\nlead_mm_rev = 10.0\ntravel_mm = 6.0\n'
        "[limits]\nforce_N = 3.0\n"
    )
    with pytest.raises(DeviceError, match="/dev/no-such-port: cannot be opened") as error:
        open_device(f"moteus:{path}")
    assert "\n" not in str(error.value)
