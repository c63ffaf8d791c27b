"""How errors are shown on the page."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import DeviceError, InputError
from fdvv_studio.studio.contract import Watchers, error_line


def test_no_path_of_the_machine_is_shown(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as missing:
        (tmp_path / "none" / "kept.json").read_text()
    assert error_line(missing.value) == "kept.json: No such file or directory"
    assert (
        error_line(InputError(tmp_path / "a.json", "$.name", "is empty", "name it"))
        == "$.name: is empty; name it"
    )


def test_an_error_without_file_or_number_is_shown_unchanged() -> None:
    assert error_line(OSError(28, "No space left on device")) == "No space left on device"
    assert error_line(OSError("broken")) == "broken"
    assert error_line(DeviceError("gone")) == "gone"


def test_all_subscribers_are_called_in_order_and_once() -> None:
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


def test_a_subscriber_may_unsubscribe_when_called() -> None:
    watchers, heard = Watchers[int](), list[int]()

    def once(news: int) -> None:
        heard.append(news)
        watchers.forget(once)

    watchers.watch(once)
    watchers.tell(1)
    watchers.tell(2)
    assert heard == [1]
