"""The log of a session: nothing of it is lost, nothing false is read back."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.rendering.session_log import PRESSES, PressEntry, PressLog, PressRecord, SessionRun
from fdvv.testing.scripted import ScriptedDevice

SURFACE = ForceSurface.of_model(load_builtin("mx-clear"), [50.0, 100.0])
RUN = SessionRun("2026-01-01T10:00:00.000+00:00", 3, {"fdvv": "0"}, {"pace_ratio": 0.35, "patience": 10})


def press(seed: int = 0) -> Press:
    device = ScriptedDevice(noise_cN=1.0, seed=seed)
    device.upload(SURFACE, 4.0)
    return device.press(100.0)


def record(number: int, reason: str = "") -> PressRecord:
    return PressRecord(
        PressEntry(number, 100.0, reason, 98.5, "2026-01-01T10:00:01.000+00:00"), SURFACE, press(number)
    )


def filled(folder: Path, presses: int = 3) -> PressLog:
    folder.mkdir(exist_ok=True)
    log = PressLog(folder)
    log.begin(RUN)
    for number in range(1, presses + 1):
        log.add(record(number, "too fast" if number == 2 else ""))
    return log


def same(left: Press, right: Press) -> bool:
    names = [f.name for f in fields(Press)]
    return all(np.array_equal(getattr(left, n), getattr(right, n)) for n in names)


def test_a_file_of_the_first_version_is_read_and_written_again_byte_for_byte(tmp_path: Path) -> None:
    old = Path(__file__).parent / "files" / "presses-0.1.jsonl"
    (tmp_path / PRESSES).write_bytes(old.read_bytes())
    log = PressLog(tmp_path)
    (first, second), (run,) = list(log.records()), log.runs
    log.close()
    assert first.press is not None
    assert first.press.displacement_mm.tobytes() == np.array([0.1, -0.0, np.nan]).tobytes()
    assert first.press.force_cN.tolist() == [1 / 3, 2.0, 1e-300]
    assert first.press.saturated is not None
    assert first.press.saturated.tolist() == [False, True, False]
    assert first.surface.press_cN.tolist() == [[0, 40.5, 90], [0, 41, np.pi]]
    assert (second.press, second.entry.reason, run.seed) == (None, "over speed", 3)
    (tmp_path / "again").mkdir()
    again = PressLog(tmp_path / "again")
    again.begin(run)
    again.add(first)
    again.add(second)
    again.close()
    assert (tmp_path / "again" / PRESSES).read_bytes() == old.read_bytes()


def test_every_column_of_every_press_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    filled(tmp_path).close()
    again = PressLog(tmp_path)
    found = list(again.records())
    assert [str(k.entry) for k in found] == [
        "press 1 at 100 mm/s: used",
        "press 2 at 100 mm/s: too fast",
        "press 3 at 100 mm/s: used",
    ]
    for number, one in enumerate(found, 1):
        assert one.press is not None
        assert same(one.press, press(number))
        np.testing.assert_array_equal(one.surface.release_cN, SURFACE.release_cN)
    assert (again.runs, again.used, again.warnings) == ([RUN], 2, [])
    again.close()


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25, deadline=None)
@given(part=st.floats(0, 1, exclude_max=True))
def test_wherever_the_file_is_cut_the_whole_records_before_are_there(tmp_path: Path, part: float) -> None:
    path = tmp_path / PRESSES
    path.unlink(missing_ok=True)
    filled(tmp_path).close()
    data = path.read_bytes()
    end = int(part * len(data))
    path.write_bytes(data[:end])
    whole = data[:end].count(b"\n")
    log = PressLog(tmp_path)
    assert len(log.runs) + len(log.entries) == whole
    assert bool(log.warnings) == (not data[:end].endswith(b"\n") and end > 0)
    # it goes on behind the last whole record
    log.add(record(len(log.entries) + 1))
    log.close()
    assert len(PressLog.read(path)[1]) == max(0, whole - 1) + 1


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=25, deadline=None)
@given(part=st.floats(0, 1, exclude_max=True), flip=st.integers(1, 255))
def test_a_changed_byte_is_never_read_as_a_press(tmp_path: Path, part: float, flip: int) -> None:
    path = tmp_path / PRESSES
    path.unlink(missing_ok=True)
    filled(tmp_path, 2).close()
    written = path.read_bytes()
    data = bytearray(written)
    at = int(part * len(data))
    assume(data[at] ^ flip != ord("\n"))
    data[at] ^= flip
    path.write_bytes(data)
    last = written.rfind(b"\n", 0, len(written) - 1)
    if at < last:
        with pytest.raises(InputError, match=r"line .*begin a new session"):
            PressLog.read(path)
    else:
        # the last record is taken for one that was cut short
        assert len(PressLog.read(path)[1]) == (at > last)


def test_a_missing_press_is_noticed_by_its_number(tmp_path: Path) -> None:
    filled(tmp_path).close()
    path = tmp_path / PRESSES
    lines = path.read_bytes().split(b"\n")
    path.write_bytes(b"\n".join([*lines[:2], *lines[3:]]))
    with pytest.raises(InputError, match="press 2: bears the number 3"):
        PressLog(tmp_path)
