from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.io.files import LONGEST_NAME_bytes, open_plain, read_limited, sync_folder, write_atomic


def test_a_written_file_holds_the_content_and_leaves_no_other_file(tmp_path: Path) -> None:
    write_atomic(tmp_path / "new" / "a.txt", "héllo\n")
    assert (tmp_path / "new" / "a.txt").read_bytes() == "héllo\n".encode()
    assert [p.name for p in (tmp_path / "new").iterdir()] == ["a.txt"]


def test_a_failed_write_leaves_the_old_file_and_no_temporary_one(tmp_path: Path) -> None:
    target = tmp_path / "a.txt"
    write_atomic(target, "old")
    with pytest.raises(UnicodeEncodeError):
        write_atomic(target, "\ud800")
    with pytest.raises(TypeError):
        write_atomic(target, 12)  # type: ignore[arg-type]
    assert target.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


@pytest.mark.parametrize("name", ["a" * LONGEST_NAME_bytes, "𠀀" * (LONGEST_NAME_bytes // 4)])
def test_the_longest_name_that_the_system_takes_can_be_written(tmp_path: Path, name: str) -> None:
    write_atomic(tmp_path / name, "kept")
    assert (tmp_path / name).read_text() == "kept"


@pytest.mark.skipif(os.name != "posix", reason="this system has no such files")
def test_a_pipe_or_a_device_is_refused_at_once_and_in_one_line(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero")):
        with pytest.raises(InputError, match="is a device or a pipe, not a file") as error:
            open_plain(path)
        assert "\n" not in str(error.value)
        with pytest.raises(InputError, match="is a device or a pipe"):
            read_limited(path, 1000, "take a smaller one")


def test_a_process_killed_while_writing_leaves_the_old_file_whole(tmp_path: Path) -> None:
    target = tmp_path / "a.txt"
    write_atomic(target, "old")
    code = (
        "import os, sys, pathlib, fdvv.io.files as f\n"
        "os.fsync = lambda _fd: os._exit(9)\n"
        f"f.write_atomic(pathlib.Path({str(target)!r}), 'new' * 100000)\n"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 9
    assert target.read_text() == "old"


def test_a_written_file_has_the_permissions_of_an_ordinary_one(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_atomic(tmp_path / "atomic", "")
    assert (tmp_path / "atomic").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_small_file_is_read_and_a_larger_or_absent_one_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b"x" * 1_000_000)
    assert len(read_limited(path, 1_000_000, "pass another")) == 1_000_000
    with pytest.raises(InputError, match=r"a\.json: whole file: larger than 0 MB; pass another"):
        read_limited(path, 999_999, "pass another")
    with pytest.raises(InputError, match="No such file"):
        read_limited(tmp_path / "gone", 10, "pass another")


def test_only_a_folder_that_is_there_can_be_forced_to_disk(tmp_path: Path) -> None:
    sync_folder(tmp_path)
    with pytest.raises(FileNotFoundError):
        sync_folder(tmp_path / "none")
