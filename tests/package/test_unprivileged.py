"""The wheel where nothing of it may be written, run by a user without rights, home or an English locale."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import urllib.request
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.package.conftest import Packages

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root can become another user"),
    pytest.mark.skipif(shutil.which("setpriv") is None, reason="setpriv (util-linux) is not installed"),
]
NOBODY = 65534
# it may read what root may, as an interpreter under /root, and write only what is its own
AS_NOBODY = [
    "setpriv",
    f"--reuid={NOBODY}",
    f"--regid={NOBODY}",
    "--clear-groups",
    "--bounding-set=-all,+dac_read_search",
]
AS_NOBODY += ["--inh-caps=-all,+dac_read_search", "--ambient-caps=-all,+dac_read_search"]
LOCALES = {"C": "C", "tr_TR": "tr_TR.UTF-8", "de_DE": "de_DE.UTF-8"}


class Installed(NamedTuple):
    """A wheel that was unpacked and made read-only, and a folder of the user's own."""

    package: Path
    folder: Path

    def environment(self, locale: str) -> dict[str, str]:
        """Return nothing but paths and a locale: LANG as it is, LC_ALL where the system has that one."""
        paths = [str(self.package), sysconfig.get_path("purelib")]
        found = {"PATH": "/usr/bin:/bin", "PYTHONPATH": os.pathsep.join(paths), "LANG": "C"}
        if locale != "C":
            found["LC_ALL"] = locale if locale in known_locales() else "C.UTF-8"
        return found

    def command(self, *words: str) -> list[str]:
        return [*AS_NOBODY, sys.executable, "-P", "-m", "fdvv", *words]

    def run(self, locale: str, *words: str, folder: Path | None = None) -> str:
        """Run fdvv; return what it prints."""
        ran = subprocess.run(
            self.command(*words),
            cwd=folder or self.folder,
            env=self.environment(locale),
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            check=False,
        )
        assert ran.returncode == 0, f"fdvv {' '.join(words)}: {ran.stdout[-2000:]}{ran.stderr[-2000:]}"
        return ran.stdout


def known_locales() -> list[str]:
    listed = subprocess.run(["locale", "-a"], capture_output=True, text=True, check=False).stdout.split()
    return [re.sub(r"\.utf-?8$", ".UTF-8", name, flags=re.IGNORECASE) for name in listed]


@pytest.fixture(scope="module")
def installed(packages: Packages) -> Iterator[Installed]:
    root = Path(tempfile.mkdtemp(prefix="fdvv-nobody-"))
    try:
        root.chmod(0o755)
        package, folder = root / "site", root / "work"
        zipfile.ZipFile(packages.wheel).extractall(package)
        for path in (package, *package.rglob("*")):
            path.chmod(0o555 if path.is_dir() or path.name == "fdvv-host" else 0o444)
        folder.mkdir()
        os.chown(folder, NOBODY, NOBODY)
        yield Installed(package, folder)
    finally:
        shutil.rmtree(root)


@pytest.mark.parametrize("locale", LOCALES.values(), ids=LOCALES)
def test_a_button_is_shown_fitted_and_compensated(installed: Installed, locale: str) -> None:
    where = installed.folder / locale.replace(".", "-")
    where.mkdir()
    os.chown(where, NOBODY, NOBODY)
    assert "hysteresis_loss_mJ" in installed.run(locale, "show", "mx-clear", folder=Path("/"))
    curve = installed.run(locale, "show", "mx-clear", "--json", folder=Path("/"))
    assert curve.startswith("{")
    (where / "measured.csv").write_text(measured(), encoding="utf-8")
    installed.run(locale, "fit", "measured.csv", "-o", "fitted.fdvv.json", folder=where)
    job = ["compensate", "mx-clear", "-o", "clear.actuation.json", "--rig", "voltage", "--method", "paper"]
    installed.run(locale, *job, "--velocity", "100", "--rounds", "1", folder=where)
    assert (where / "fitted.fdvv.json").stat().st_uid == NOBODY
    assert (where / "clear.actuation.json").stat().st_uid == NOBODY


def measured() -> str:
    """A click of 4 mm, there and back, in mm and cN."""
    places = [i / 50 for i in range(201)]
    down = [40 + 8 * x - 20 * max(0.0, 1 - abs(x - 2) / 0.5) for x in places]
    rows = [f"{x:.3f},{f:.3f}" for x, f in zip(places, down, strict=True)]
    rows += [f"{x:.3f},{f - 6:.3f}" for x, f in zip(reversed(places), reversed(down), strict=True)]
    return "\n".join(["displacement_mm,force_cN", *rows]) + "\n"


@pytest.mark.parametrize("locale", LOCALES.values(), ids=LOCALES)
def test_the_studio_answers(installed: Installed, locale: str) -> None:
    with subprocess.Popen(
        installed.command("studio", "--no-browser", "--port", "0"),
        cwd=installed.folder,
        env=installed.environment(locale),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    ) as server:
        try:
            assert server.stdout
            said = server.stdout.readline()
            assert "http" in said, said + server.stdout.read()
            opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
            with opener.open(said.split()[-1], timeout=30) as answer:
                assert "<script" in str(answer.read(), "utf-8")
        finally:
            server.terminate()


def test_nothing_of_the_package_was_written(installed: Installed) -> None:
    assert not list(installed.package.rglob("*.pyc"))
    assert {path.stat().st_uid for path in installed.package.rglob("*")} == {0}
