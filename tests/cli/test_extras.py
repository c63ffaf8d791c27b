"""What extras add: found without importing them, and named where they are absent."""

from __future__ import annotations

import subprocess
import sys
from types import MappingProxyType

import pytest

from fdvv import extras
from fdvv.errors import BuildError
from fdvv.optimize.engines.registry import engine_names, engine_of, pair_engine_of
from tests.cli.conftest import Run


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> None:
    """No extra is installed."""
    monkeypatch.setattr(extras, "installed", lambda _kind: MappingProxyType({}))


@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize(
    ("words", "package"),
    [
        (["hardware", "parts"], "fdvv-rig"),
        (["mechanism", "mx-red"], "fdvv-switch"),
        (["device", "info", "--device", "emulated"], "fdvv-m0"),
        (["device", "strip", "--strip", "host"], "fdvv-strip"),
        (["optimize", "run", "--folder", "run", "--strip", "host"], "fdvv-strip"),
    ],
)
def test_what_an_absent_extra_brings_is_refused_with_what_to_install(
    fdvv: Run, words: list[str], package: str
) -> None:
    ran = fdvv(*words)
    assert ran.status == 1
    assert ran.err.count("\n") == 1
    assert ran.err.rstrip().endswith(f"it comes with {package}: pip install {package}")


@pytest.mark.usefixtures("bare")
def test_an_absent_engine_is_known_and_names_its_extra() -> None:
    assert "botorch" in engine_names()
    with pytest.raises(BuildError, match="pip install fdvv-botorch"):
        engine_of("botorch")
    with pytest.raises(BuildError, match="pip install fdvv-botorch"):
        pair_engine_of("preference-botorch")


@pytest.mark.usefixtures("bare")
def test_help_lists_the_commands_that_are_installed(fdvv: Run) -> None:
    shown = fdvv("--help").out
    assert "compensate" in shown
    assert "mechanism" not in shown
    assert "LED strip" not in fdvv("device", "--help").out


def test_help_imports_no_extra() -> None:
    code = (
        "import sys\nfrom fdvv.cli.main import cli\n"
        "cli(['--help'], standalone_mode=False)\n"
        "print([m for m in sys.modules if m.startswith('fdvv_')])"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "mechanism" in ran.stdout
    assert ran.stdout.splitlines()[-1] == "[]"


def test_an_engine_is_loaded_without_torch() -> None:
    assert engine_of("botorch").name == "botorch"
