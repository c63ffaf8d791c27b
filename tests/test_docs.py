"""The documents say what the program does."""

from __future__ import annotations

import importlib.util
import re
import resource
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
PAGES = [*REPOSITORY.glob("*.md"), *(REPOSITORY / "docs").rglob("*.md")]


def tool(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, REPOSITORY / "tools" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("page", "name", "function"),
    [
        ("cli.md", "make_cli_reference", "reference"),
        ("protocol.md", "make_protocol_reference", "reference"),
        ("strip-protocol.md", "make_protocol_reference", "strip_reference"),
        ("rig.md", "make_rig_reference", "reference"),
        ("button.md", "make_rig_reference", "button_reference"),
    ],
)
def test_a_generated_reference_is_that_of_the_code(page: str, name: str, function: str) -> None:
    text = (REPOSITORY / "docs" / "reference" / page).read_text()
    assert text == getattr(tool(name), function)(), f"run python tools/{name}.py"


def test_the_firmwares_sine_table_is_that_of_the_code() -> None:
    sine = tool("make_sine")
    assert sine.HEADER.read_text() == sine.reference(), "run python tools/make_sine.py"


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(REPOSITORY)))
def test_commands_in_documents_exist(page: Path) -> None:
    from fdvv.cli._main import COMMANDS

    for name in re.findall(r"(?:^|`)fdvv ([a-z]+)", page.read_text(), flags=re.MULTILINE):
        assert name in COMMANDS, f"{page.name} tells of fdvv {name}"


def test_the_changelog_tells_of_every_command() -> None:
    from fdvv.cli._main import COMMANDS

    text = (REPOSITORY / "CHANGELOG.md").read_text()
    assert [name for name in COMMANDS if f"`{name}`" not in text] == []


def test_help_is_there_in_three_tenths_of_a_second() -> None:
    command = [sys.executable, "-m", "fdvv", "--help"]
    subprocess.run(command, check=True, capture_output=True)
    spent = []
    for _ in range(5):
        begun = own_time_s()
        subprocess.run(command, check=True, capture_output=True)
        spent.append(own_time_s() - begun)
    assert min(spent) < 0.3


def own_time_s() -> float:
    """Give the processor time of finished children: other work on the machine does not count."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
