"""How errors are told on the page."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import DeviceError, InputError
from fdvv.studio.contract import Watchers, error_line


def test_no_path_of_the_machine_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as missing:
        (tmp_path / "none" / "kept.json").read_text()
    assert error_line(missing.value) == "kept.json: No such file or directory"
    assert (
        error_line(InputError(tmp_path / "a.json", "$.name", "is empty", "name it"))
        == "$.name: is empty; name it"
    )


def test_what_has_no_file_or_no_number_is_told_as_it_is() -> None:
    assert error_line(OSError(28, "No space left on device")) == "No space left on device"
    assert error_line(OSError("broken")) == "broken"
    assert error_line(DeviceError("gone")) == "gone"


def test_all_that_watch_are_told_in_order_and_once() -> None:
    watchers, heard = Watchers[int](), list[tuple[str, int]]()

    def first(news: int) -> None:
        heard.append(("first", news))

    def second(news: int) -> None:
        heard.append(("second", news))

    for tell in (first, second, first):
        watchers.watch(tell)
    watchers.tell(1)
    watchers.forget(first)
    watchers.forget(first)
    watchers.tell(2)
    assert heard == [("first", 1), ("second", 1), ("second", 2)]


def test_one_that_is_told_may_stop_listening_at_once() -> None:
    watchers, heard = Watchers[int](), list[int]()

    def once(news: int) -> None:
        heard.append(news)
        watchers.forget(once)

    watchers.watch(once)
    watchers.tell(1)
    watchers.tell(2)
    assert heard == [1]
