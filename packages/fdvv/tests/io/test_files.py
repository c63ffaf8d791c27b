from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv.io.files import (
    LONGEST_NAME_bytes,
    make_private,
    open_plain,
    read_limited,
    write_atomic,
)

POSIX = pytest.mark.skipif(os.name != "posix", reason="Windows knows no such permissions")


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


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


@POSIX
def test_a_private_file_and_its_folder_are_their_owners_alone(tmp_path: Path) -> None:
    write_atomic(tmp_path / "people" / "P01" / "a.txt", "old", private=True)
    write_atomic(tmp_path / "people" / "P01" / "a.txt", "new", private=True)
    assert mode(tmp_path / "people" / "P01") == 0o700
    assert mode(tmp_path / "people" / "P01" / "a.txt") == 0o600


@POSIX
def test_what_others_could_read_is_made_private_with_all_that_lies_in_it(tmp_path: Path) -> None:
    write_atomic(tmp_path / "people" / "P01" / "a.txt", "")
    (tmp_path / "outside").write_text("")
    (tmp_path / "outside").chmod(0o644)
    (tmp_path / "people" / "link").symlink_to(tmp_path / "outside")
    make_private(tmp_path / "people")
    make_private(tmp_path / "gone")
    assert mode(tmp_path / "people") == mode(tmp_path / "people" / "P01") == 0o700
    assert mode(tmp_path / "people" / "P01" / "a.txt") == 0o600
    assert mode(tmp_path / "outside") == 0o644


def test_writing_never_changes_the_umask_of_the_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another thread would make its files open to all meanwhile."""
    monkeypatch.setattr("os.umask", lambda _mask: pytest.fail("the umask was changed"))
    write_atomic(tmp_path / "a.txt", "")


def test_a_small_file_is_read_and_a_larger_or_absent_one_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b"x" * 1_000_000)
    assert len(read_limited(path, 1_000_000, "pass another")) == 1_000_000
    with pytest.raises(InputError, match=r"a\.json: whole file: larger than 0 MB; pass another"):
        read_limited(path, 999_999, "pass another")
    with pytest.raises(InputError, match="No such file"):
        read_limited(tmp_path / "gone", 10, "pass another")
