"""Try what is installed, as the one who installed it: no checkout, no extras.

Run by a fresh environment's own Python, in any folder: ``python -P tools/try_wheel.py``. Prints one line per
step with its seconds; ends with status 1 at the first step that does not do what it says.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
import json
import os
import pkgutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path

FDVV = [sys.executable, "-P", "-m", "fdvv"]
EXTRAS = {
    "fdvv_studio": (["library"], "fdvv-studio"),
    "fdvv_people": (["study", "new", "realism"], "fdvv-people"),
    "fdvv_campaigns": (["sweep", "plan.toml"], "fdvv-campaigns"),
    "matplotlib": (["show", "mx-clear", "--figure", "clear.svg"], "fdvv[plot]"),
    "nacl": (["study", "freeze", "realism", "--passphrase-file", "word.txt"], "fdvv[study]"),
    "sklearn": (["optimize", "run", "--folder", "run", "--trials", "1"], "fdvv[optimize]"),
    "serialx": (["device", "info", "--device", "serial:none"], "fdvv[serial]"),
    "fdvv_rig": (["hardware", "parts"], "fdvv-rig"),
    "fdvv_strip": (["device", "strip", "--strip", "host"], "fdvv-strip"),
    "fdvv_switch": (["mechanism", "mx-red"], "fdvv-switch"),
    "fdvv_m0": (["device", "info", "--device", "emulated"], "fdvv-m0"),
    "fdvv_haptics": (["export", "mx-clear", "-o", "clear.ahap"], "fdvv-haptics"),
    "fdvv_drives": (["device", "info", "--device", "moteus:stage.toml"], "fdvv-drives"),
}
"""A command that needs what an extra brings, by a module of it."""
ABOVE = ("fdvv_studio", "fdvv_people", "fdvv_campaigns")
"""What `fdvv[all]` brings beside the core."""


def fdvv(folder: Path, *words: str, status: int = 0) -> tuple[str, str]:
    """Run the command in a folder; give what it prints and says."""
    command, environment = [*FDVV, *words], {**os.environ, "PYTHONUTF8": "1"}
    ran = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, encoding="utf-8", check=False
    )
    if ran.returncode != status:
        raise SystemExit(f"fdvv {' '.join(words)} ended with {ran.returncode}:\n{ran.stdout}{ran.stderr}")
    return ran.stdout, ran.stderr


def every_room(folder: Path) -> str:
    """Import every module there is."""
    packages = map(importlib.import_module, filter(importlib.util.find_spec, ("fdvv", *ABOVE)))
    found = [
        m.name
        for package in packages
        for m in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    ]
    # the compiled library looks like a module, and __main__ would run
    names = [name for name in found if not name.startswith("fdvv._native.") and name != "fdvv.__main__"]
    for name in names:
        importlib.import_module(name)
    return f"{len(names)} modules"


def version(folder: Path) -> str:
    """Return the version, that of the installed distribution."""
    said, known = fdvv(folder, "--version")[0].split()[-1], importlib.metadata.version("fdvv")
    if said != known:
        raise SystemExit(f"fdvv says {said}, what is installed is {known}")
    return said


def library(folder: Path) -> str:
    """List the built-in buttons."""
    return f"{len(json.loads(fdvv(folder, 'library', '--json')[0])['buttons'])} buttons"


def demo(folder: Path) -> str:
    """Render the first button; the report alone needs an extra."""
    status = 0 if importlib.util.find_spec("matplotlib") else 1
    out, _ = fdvv(folder, "demo", status=status)
    if "mx-clear on the simulated rig" not in out:
        raise SystemExit(f"the demo printed no table:\n{out}")
    return "rendered and judged, simulated"


def firmware(folder: Path) -> str:
    """Press a program on the firmware of this machine."""
    fdvv(folder, "device", "press", "multi-level", "--device", "host")
    return "pressed, simulated"


def study(folder: Path) -> str:
    """Declare a study and preview it."""
    fdvv(folder, "study", "new", "realism")
    fdvv(folder, "study", "check", "realism")
    return f"{len(fdvv(folder, 'study', 'preview', 'realism')[0].splitlines())} lines of preview"


def extras(folder: Path) -> str:
    """Meet what needs an extra that is not there: one line that names it."""
    (folder / "word.txt").write_text("correct horse battery staple\n", encoding="utf-8")
    met = []
    people = importlib.util.find_spec("fdvv_people") is not None
    for module, (words, extra) in EXTRAS.items():
        if importlib.util.find_spec(module) is None and (
            people or extra not in ("fdvv[study]", "fdvv[optimize]")
        ):
            said = fdvv(folder, *words, status=1)[1].splitlines()[-1]
            if extra not in said:
                raise SystemExit(f"fdvv {' '.join(words)} does not tell of {extra}: {said}")
            met.append(extra)
    return ", ".join(met) or "all are here"


def studio(folder: Path) -> str:
    """Open the studio and ask it for its page."""
    command = [*FDVV, "studio", "--no-browser", "--port", "0"]
    with (
        (folder / "studio.txt").open("w") as said,
        subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=said, text=True) as server,
    ):
        try:
            assert server.stdout
            address = server.stdout.readline().split()[-1]
            return fetched(address)
        finally:
            server.terminate()


def fetched(address: str) -> str:
    """Ask for the page with its token, and without: the guard lets only one of them in."""
    opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    with opener.open(address, timeout=30) as answer:
        page = str(answer.read(), "utf-8")
    if "<script" not in page:
        raise SystemExit("the studio's page is not what it should be")
    try:
        urllib.request.urlopen(address.split("?")[0], timeout=30)
    except urllib.error.HTTPError as refused:
        return f"{len(page)} bytes of page; without the token {refused.code}"
    raise SystemExit("the studio let somebody in without the token")


STEPS: list[Callable[[Path], str]] = [version, library, every_room, firmware, demo, studio, study, extras]


NEEDED: dict[Callable[[Path], str], str] = {
    library: "fdvv_studio",
    studio: "fdvv_studio",
    study: "fdvv_people",
}
"""The package that a step needs beside the core."""


def main() -> None:
    """Take every step in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        for step in STEPS:
            if importlib.util.find_spec(NEEDED.get(step, "fdvv")) is None:
                continue
            begun = time.monotonic()
            result = step(Path(folder))
            print(f"{step.__name__:12s} {time.monotonic() - begun:6.1f} s  {result}", flush=True)


if __name__ == "__main__":
    main()
