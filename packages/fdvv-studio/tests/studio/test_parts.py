"""What is made ready before the first question is answered."""

from __future__ import annotations

import subprocess
import sys
import threading
import types
from pathlib import Path

import msgspec
import pytest

from fdvv import extras
from fdvv_studio.studio.api.about import about
from fdvv_studio.studio.contract import Call, Empty
from fdvv_studio.studio.parts import PartLoader
from fdvv_studio.studio.studio import Studio

RACE = """
import sys, threading
from fdvv_studio.studio.parts import load_parts
from fdvv import load_builtin
load_parts()
sys.setswitchinterval(1e-6)
names = ("mx-clear", "mx-red", "mx-blue", "rubber-dome")
together = threading.Barrier(len(names))
threads = [threading.Thread(target=lambda n=n: (together.wait(), load_builtin(n))) for n in names]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
"""


@pytest.mark.parametrize("attempt", range(3))
def test_threads_that_are_the_first_to_read_a_record_do_not_crash_the_process(attempt: int) -> None:
    # without the preparation about every second attempt ends with a segmentation fault
    ended = subprocess.run([sys.executable, "-c", RACE], capture_output=True, check=False)
    assert ended.returncode == 0, ended.stderr


class Nothing(msgspec.Struct):
    """A message without content."""


def call(name: str) -> Call:
    return Call(name, Nothing, Nothing, lambda _studio, ask: ask)


@pytest.fixture
def _own_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, *calls in (
        ("first", call("a.a")),
        ("second", call("b.b")),
        ("third", call("a.a")),
        ("package.fourth", call("d.d")),
    ):
        module = types.ModuleType(name)
        module.__dict__.update({one.name: one for one in calls})
        monkeypatch.setitem(sys.modules, module.__name__, module)


@pytest.mark.usefixtures("_own_parts")
def test_a_call_is_there_as_soon_as_its_own_part_is() -> None:
    loader = PartLoader(("first", "second"))
    waiting = threading.Thread(target=loader.load)
    waiting.start()
    found = loader.call("a.a")
    assert found is not None
    assert found.name == "a.a"
    waiting.join()
    assert loader.call("b.b") is not None
    assert loader.call("c.c") is None
    assert set(loader.all().calls) == {"a.a", "b.b"}


@pytest.mark.usefixtures("_own_parts")
@pytest.mark.parametrize(
    ("names", "fault"), [(("first", "third"), ValueError), (("first", "not_there"), ModuleNotFoundError)]
)
def test_a_part_that_cannot_be_loaded_fails_for_all_that_wait(
    names: tuple[str, ...], fault: type[Exception]
) -> None:
    loader = PartLoader(names)
    loader.load()
    with pytest.raises(fault):
        loader.all()
    with pytest.raises(fault):
        loader.call("c.c")
    assert loader.call("a.a") is not None


@pytest.mark.usefixtures("_own_parts")
def test_the_parts_of_another_package_are_there_together() -> None:
    """Else a call prepares records while the loader does, and the process crashes now and then."""
    loader = PartLoader(("first", "package.fourth", "package.not_there"))
    loader.load()
    assert loader.call("a.a") is not None
    with pytest.raises(ModuleNotFoundError):
        loader.call("d.d")


def test_the_page_hears_which_of_its_pages_are_not_installed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(extras, "installed", lambda _kind: {})
    assert about.function(Studio(tmp_path), Empty()).absent == {"fdvv-people": ["optimize", "studies"]}
