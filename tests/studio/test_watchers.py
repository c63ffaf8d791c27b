"""Whoever watches is told."""

from __future__ import annotations

from fdvv.studio._watchers import Watchers


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
