"""Runs commands of fdvv, each in a process forked after all was imported: that saves a second a command.

``python -m tools.snapshot.worker`` reads a request a line and answers each with a line, both JSON.
"""

from __future__ import annotations

import importlib
import itertools
import json
import os
import pkgutil
import secrets
import sys
import traceback
from collections import defaultdict
from collections.abc import Callable, Iterator
from importlib.metadata import entry_points
from typing import Any

PACKAGES = ("fdvv", "fdvv_studio", "fdvv_people", "fdvv_campaigns")
LIBRARIES = (
    *("scipy.interpolate", "scipy.optimize", "scipy.signal", "scipy.stats"),
    *("matplotlib.pyplot", "matplotlib.backends.backend_svg"),
    *("sklearn.gaussian_process", "pyarrow.parquet", "nacl.public", "nacl.pwhash"),
    *("rich.console", "rich.progress", "rich.table"),
)
"""What commands import where they use it."""
NO_MODULES = (".__main__", ".libfdvv")

Command = Callable[[], object]


def main() -> None:
    """Import everything, then run what standard input asks for."""
    (entry,) = entry_points(group="console_scripts", name="fdvv")
    command = entry.load()
    for package in PACKAGES:
        import_all(package)
    for name in LIBRARIES:
        importlib.import_module(name)
    for line in sys.stdin:
        print(json.dumps(run(command, **json.loads(line))), flush=True)


def import_all(package: str) -> None:
    """Import every module of a package."""
    for module in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
        if not module.name.endswith(NO_MODULES):
            importlib.import_module(module.name)


def run(command: Command, words: list[str], folder: str, output: str, errors: str) -> dict[str, Any]:
    """Run a command in a folder, with what it prints in two files; return status and processor time."""
    process = os.fork()
    if not process:
        os.chdir(folder)
        for descriptor, path in enumerate(("/dev/null", output, errors)):
            os.dup2(os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC), descriptor)
        sys.argv = ["fdvv", *words]
        seed_draws()
        os._exit(status_of(command))
    _, status, used = os.wait4(process, 0)
    return {"status": os.waitstatus_to_exitcode(status), "cpu_s": used.ru_utime + used.ru_stime}


def seed_draws() -> None:
    """Make what a command leaves to chance the same every time: the schedules and the keys of people."""
    import numpy as np

    make, drawn = np.random.default_rng, itertools.count()
    vars(np.random)["default_rng"] = lambda seed=None: make(next(drawn) if seed is None else seed)
    # counted by their size, so that one salt more changes no key
    tokens = defaultdict[int, Iterator[int]](itertools.count)
    vars(secrets)["token_hex"] = lambda size: f"{next(tokens[size]):0{2 * size}x}"


def status_of(command: Command) -> int:
    """Call a command and return its exit status."""
    try:
        returned = command()
    except SystemExit as stop:
        returned = stop.code
    except BaseException:
        traceback.print_exc()
        returned = 1
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
    return returned if isinstance(returned, int) else int(returned is not None)


if __name__ == "__main__":
    main()
