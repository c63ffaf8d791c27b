"""What Python needs of a system: nothing that only POSIX has, unless it is asked for."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.package.conftest import REPOSITORY

SOURCES = (*REPOSITORY.glob("packages/*/src"), *REPOSITORY.glob("extras/*/src"))
READS_TEXT = {"read_text", "write_text", "open", "fdopen"}
SUSPECT = re.compile("|".join(READS_TEXT))

WINDOWS = '''
import asyncio, asyncio.unix_events, multiprocessing.popen_spawn_posix, os, signal, subprocess, sys
import multiprocessing.connection, multiprocessing.shared_memory, ssl, tempfile, webbrowser
import click.testing, numpy, rich.console, scipy.interpolate, scipy.optimize, scipy.signal, scipy.stats
import starlette.applications, uvicorn.server, websockets
import fdvv._native  # its library is that of the system we are really on
import fcntl as really

class Msvcrt:
    """Locks as Windows does: a second one is refused at once, with PermissionError."""
    LK_NBLCK = 2
    @staticmethod
    def locking(file, mode, count):
        try:
            really.flock(file, really.LOCK_EX | really.LOCK_NB)
        except BlockingIOError as error:
            raise PermissionError(13, "Permission denied") from error

for name in ("fcntl", "pty", "termios", "tty", "resource", "pwd", "grp", "syslog"):
    sys.modules[name] = None
sys.modules["msvcrt"] = Msvcrt
for name in ("openpty", "fork", "killpg", "getuid", "O_CLOEXEC", "set_blocking"):
    delattr(os, name)
for name in ("pthread_sigmask", "pause", "SIGKILL", "SIGUSR1", "SIGALRM"):
    delattr(signal, name)
sys.platform = "win32"
'''
"""What an import of fdvv finds on Windows, as far as another system can show it; what the standard library
and the dependencies load of this one stays."""
IMPORTS = """
import importlib, pkgutil
packages = map(importlib.import_module, ("fdvv", "fdvv_studio", "fdvv_people", "fdvv_campaigns"))
names = [m.name for p in packages for m in pkgutil.walk_packages(p.__path__, f"{p.__name__}.")]
for name in names:
    if name != "fdvv.__main__" and not name.startswith("fdvv._native."):
        importlib.import_module(name)
print(len(names) > 600)
"""
WORKS = """
from pathlib import Path
from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_records
from fdvv.device.open import open_device
path, busy = Path("journal.jsonl"), InputError("journal", "file", "busy", "wait")
first = Journal(path, busy)
first.write({"a": "line\\n"})
try:
    Journal(path, busy)
    print("two at once")
except InputError:
    print("busy")
print([record for record, _ in read_records(path, JournalKind({"a": str}, ""))])
first.close()
Journal(path, busy).close()
host = open_device("host")
print(host.info().simulated)
host.close()
from fdvv.cli.main import main
sys.argv = ["fdvv", *sys.argv[1:]]
main()
"""


def on_windows(code: str, folder: Path, *words: str, first: str = "") -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", first + WINDOWS + code, *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_every_module_imports_and_journals_lock_without_what_only_posix_has(tmp_path: Path) -> None:
    ran = on_windows(IMPORTS + WORKS, tmp_path, "library")
    assert (ran.returncode, ran.stderr) == (0, "")
    lines = ran.stdout.splitlines()
    assert lines[:4] == ["True", "busy", "[{'a': 'line\\n'}]", "True"]
    assert any("mx-clear" in line for line in lines)


@pytest.mark.slow
def test_the_demo_runs_without_what_only_posix_has(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    ran = on_windows(WORKS, tmp_path, "demo", first="import matplotlib.pyplot")
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "demo" / "report.html").is_file()


def unnamed(tree: ast.AST) -> list[int]:
    """Return the lines where text is read or written in the system's default encoding."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute | ast.Name):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else node.func.id
            named = any(word.arg == "encoding" for word in node.keywords) or any(
                isinstance(part, ast.Constant)
                and isinstance(part.value, str)
                and part.value.startswith("utf")
                for part in node.args
            )
            if name in ("read_text", "write_text") and not named:
                found.append(node.lineno)
            modes = [part.value for part in node.args if isinstance(part, ast.Constant)]
            if name in READS_TEXT and not named and any(mode in ("r", "w", "a", "x") for mode in modes):
                found.append(node.lineno)
    return found


def test_text_is_read_and_written_in_a_named_encoding() -> None:
    # Windows reads another one than UTF-8 unless asked for it
    wrong = {
        str(path.relative_to(REPOSITORY)): lines
        for sources in SOURCES
        for path in sorted(sources.rglob("*.py"))
        if SUSPECT.search(text := path.read_text(encoding="utf-8")) and (lines := unnamed(ast.parse(text)))
    }
    assert wrong == {}
    assert unnamed(ast.parse('p.read_text()\nopen(p, "w")\np.read_text("utf-8")\np.open("rb")')) == [1, 2]


@pytest.mark.slow
def test_a_pipe_that_knows_few_signs_gets_the_rest(tmp_path: Path) -> None:
    fdvv = [sys.executable, "-m", "fdvv", "study"]
    subprocess.run([*fdvv, "new", "realism"], cwd=tmp_path, check=True, capture_output=True)
    shown = [
        subprocess.run(
            [*fdvv, "preview", "realism"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONIOENCODING": encoding},
            capture_output=True,
            check=True,
        ).stdout.decode(encoding)
        for encoding in ("utf-8", "cp1253")
    ]
    assert "näher" in shown[0]
    assert "n?her" in shown[1]
