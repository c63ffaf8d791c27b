"""Drives by name, and what the commands know of them."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import MappingProxyType

import pytest

from fdvv import extras
from fdvv.device.open import KINDS, is_manual, open_board, open_device
from fdvv.errors import BuildError, DeviceError, InputError
from tests.drives.conftest import LIBRARIES, need

DRIVES = ("moteus", "odrive", "simplefoc")
PORT = '"/dev/no-such-port"'
PARTS = {
    "moteus": (f"port = {PORT}", "Nm"),
    "odrive": (f'channel = {PORT}\ninterface = "slcan"\nwatchdog_ms = 50.0', "Nm"),
    "simplefoc": (f"port = {PORT}\nwatchdog_ms = 50.0", "A"),
}
"""What a stage file says of a drive, and the unit of its command."""


@pytest.mark.parametrize("kind", DRIVES)
def test_a_drive_is_a_known_device_that_a_person_presses(kind: str) -> None:
    assert f"{kind}:FILE.toml" in KINDS
    assert is_manual(f"{kind}:stage.toml")
    assert not is_manual(kind)
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


def stage_file(kind: str, folder: Path) -> Path:
    """Write the stage file of a drive at a port that is not there."""
    part, unit = PARTS[kind]
    path = folder / "stage.toml"
    path.write_text(
        f"[{kind}]\n{part}\n[stage]\nlead_mm_rev = 10.0\ntravel_mm = 6.0\nforce_N_{unit} = 4.0\n"
        "[limits]\nforce_N = 3.0\n"
    )
    return path


@pytest.mark.parametrize("kind", DRIVES)
def test_a_port_that_is_not_there_is_one_line(kind: str, tmp_path: Path) -> None:
    need(kind)
    with pytest.raises(DeviceError, match="cannot be opened") as error:
        open_device(f"{kind}:{stage_file(kind, tmp_path)}")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("kind", "package"),
    [("moteus", "'fdvv-drives[moteus]'"), ("odrive", "'fdvv-drives[odrive]'"), ("simplefoc", "pyserial")],
)
def test_without_its_library_one_line_says_what_to_install(
    kind: str, package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, LIBRARIES[kind], None)
    with pytest.raises(BuildError, match=re.escape(f"pip install {package}")):
        open_device(f"{kind}:{stage_file(kind, tmp_path)}")
