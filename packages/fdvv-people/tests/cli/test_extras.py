"""What extras add: found without importing them, and named where they are absent."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
from typing import Any

import pytest

from fdvv import extras
from fdvv.button.export_file import EXPORT_FORMATS
from fdvv.errors import BuildError
from fdvv.formats.exchange.exchange_format import ButtonFormat, ExportSettings
from fdvv.formats.exchange.exported import Exported
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.engines.registry import engine_names, engine_of, pair_engine_names
from tests.support.command_line import Run

OWN = ("fdvv", "fdvv_campaigns", "fdvv_people", "fdvv_studio")
"""Packages that are no extras."""


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> None:
    """No extra is installed."""
    every = extras.installed

    def own(kind: extras.Kind) -> MappingProxyType[str, Any]:
        return MappingProxyType({n: e for n, e in every(kind).items() if e.module.partition(".")[0] in OWN})

    monkeypatch.setattr(extras, "installed", own)


@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize(
    ("words", "package"),
    [
        (["hardware", "parts"], "fdvv-rig"),
        (["mechanism", "mx-red"], "fdvv-switch"),
        (["device", "info", "--device", "emulated"], "fdvv-m0"),
        (["device", "info", "--device", "moteus:stage.toml"], "fdvv-drives"),
        (["device", "strip", "--strip", "host"], "fdvv-strip"),
        (["optimize", "run", "--folder", "run", "--strip", "host"], "fdvv-strip"),
        (["export", "mx-clear", "--to", "ahap", "-o", "a.ahap"], "fdvv-haptics"),
        (["export", "mx-red", "-o", "a.xml"], "fdvv-haptics"),
        (["import", "a.haptic", "--into", "mx-red", "-o", "a.fdvv.json"], "fdvv-haptics"),
    ],
)
def test_what_an_absent_extra_brings_is_refused_with_what_to_install(
    fdvv: Run, tmp_path: Path, words: list[str], package: str
) -> None:
    (tmp_path / "a.haptic").write_text('{"signals": {}}')
    ran = fdvv(*words)
    assert ran.status == 1
    assert ran.err.count("\n") == 1
    assert ran.err.rstrip().endswith(f"it comes with {package}: pip install {package}")


@pytest.mark.usefixtures("bare")
def test_an_absent_engine_is_known_and_names_its_extra() -> None:
    assert "botorch" in engine_names()
    with pytest.raises(BuildError, match="pip install fdvv-botorch"):
        engine_of("botorch")
    assert "preference-botorch" in pair_engine_names()
    with pytest.raises(BuildError, match="pip install fdvv-botorch"):
        engine_of("preference-botorch")


@pytest.mark.usefixtures("bare")
def test_help_lists_the_commands_that_are_installed(fdvv: Run) -> None:
    shown = fdvv("--help").out
    assert "compensate" in shown
    assert "mechanism" not in shown
    assert "LED strip" not in fdvv("device", "--help").out


@pytest.mark.usefixtures("bare")
def test_the_list_of_formats_names_those_that_are_absent_and_what_brings_them(fdvv: Run) -> None:
    *table, last = fdvv("export", "--list").out.splitlines()
    assert [row.split()[0] for row in table[1:]] == [form.name for form in EXPORT_FORMATS]
    absent = "mjcf, smartknob, ahap, haptic, hjif"
    assert last == f"not installed: {absent}; they come with fdvv-haptics: pip install fdvv-haptics"


@pytest.mark.usefixtures("bare")
def test_formats_of_the_core_need_no_extra(fdvv: Run) -> None:
    for name, suffix in (("haata", ".csv"), ("tester-json", ".json"), ("wav", ".wav")):
        assert fdvv("export", "mx-clear", "--to", name, "-o", f"a{suffix}").status == 0
    assert fdvv("import", "a.csv", "-o", "a.fdvv.json").status == 0


def test_a_format_of_another_package_is_listed_and_written(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def written(model: FDVVModel, _settings: ExportSettings) -> Exported:
        return Exported("own", model.name.encode())

    own = ButtonFormat("own", ".own", "the name", "button", write=written)
    entry = SimpleNamespace(load=lambda: own)
    every = extras.installed

    def with_own(kind: extras.Kind) -> MappingProxyType[str, Any]:
        return MappingProxyType({"own": entry}) if kind == "exchange_formats" else every(kind)

    monkeypatch.setattr(extras, "installed", with_own)
    assert "own" in fdvv("export", "--list").out
    assert fdvv("export", "mx-red", "-o", "a.own").status == 0
    assert (tmp_path / "a.own").read_bytes() == b"mx-red"


def test_help_imports_no_command_of_another_package() -> None:
    code = (
        "import sys\nfrom fdvv.cli.main import cli\n"
        "cli(['--help'], standalone_mode=False)\n"
        "print(*sorted(m for m in sys.modules if m.startswith('fdvv_')))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "mechanism" in ran.stdout
    assert ran.stdout.splitlines()[-1].split() == sorted(
        ["fdvv_rig", "fdvv_switch", *OWN[1:], *(f"{p}.cli" for p in OWN[1:])]
    )


def test_an_engine_is_loaded_without_torch() -> None:
    assert engine_of("botorch").name == "botorch"
