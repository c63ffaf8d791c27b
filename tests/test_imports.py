"""What importing costs: a command loads what it needs."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator

import click
import pytest

from fdvv.cli.main import cli

MOST = 40
"""Modules of ours that a help may load."""
MEASURE = """
import contextlib, io, json, os, sys
from fdvv.cli.main import cli

for line in sys.stdin:
    sys.stdout.flush()
    if os.fork():
        os.wait()
        continue
    with contextlib.redirect_stdout(io.StringIO()) as shown:
        cli.main([*line.split(), "--help"], prog_name="fdvv", standalone_mode=False)
    tops = [name.partition(".")[0] for name in sys.modules]
    ours = sum(top.startswith("fdvv") for top in tops)
    heavy = sorted({"numpy", "scipy", "matplotlib", "rich"}.intersection(tops))
    print(json.dumps([line.strip(), shown.getvalue()[:6], ours, heavy]))
    sys.stdout.flush()
    os._exit(0)
"""


def walk(group: click.Group, context: click.Context, path: str = "") -> Iterator[str]:
    """Yield the words of every command and group below one."""
    yield path
    for name in group.list_commands(context):
        command, below = group.get_command(context, name), f"{path} {name}".strip()
        if isinstance(command, click.Group):
            yield from walk(command, click.Context(command, context, name), below)
        else:
            yield below


PATHS = list(walk(cli, click.Context(cli)))


@pytest.fixture(scope="module")
def loaded() -> dict[str, list[object]]:
    """Return how every help begins and what it loads, each in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", MEASURE], input="\n".join(PATHS), capture_output=True, text=True, check=True
    )
    return {path: facts for path, *facts in map(json.loads, done.stdout.splitlines())}


@pytest.mark.parametrize("path", PATHS)
def test_a_help_loads_few_modules_of_ours_and_nothing_heavy(
    loaded: dict[str, list[object]], path: str
) -> None:
    begins, count, heavy = loaded[path]
    assert (begins, heavy) == ("Usage:", [])
    assert isinstance(count, int)
    assert count <= MOST, "import where it is used, not at the head of a command's module"
