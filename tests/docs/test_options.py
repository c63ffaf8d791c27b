"""Every command, option and argument tells what it is for; every environment variable stands on its page."""

from __future__ import annotations

import re
from collections.abc import Iterator

import click
import pytest
from tests.docs.pages import DOCS, REPOSITORY

from fdvv.cli import cli

ENVIRONMENT = DOCS / "reference" / "environment.md"
VARIABLE = re.compile(
    r"environ(?:\.get|\.setdefault|\.pop)?[(\[]\s*[\"']([A-Z][A-Z0-9_]+)|getenv\(\s*[\"']([A-Z][A-Z0-9_]+)"
    r"|\$\{([A-Z][A-Z0-9_]+)(?::-|:\?|-)"
)
SET_IN_MAKE = re.compile(r"^(?:export )?([A-Z][A-Z0-9_]+) \?=", flags=re.MULTILINE)


def commands(group: click.Group, path: str = "fdvv") -> Iterator[tuple[str, click.Command]]:
    """Give every command with the words that call it."""
    context = click.Context(group, **cli.context_settings)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield f"{path} {name}", command
        if isinstance(command, click.Group):
            yield from commands(command, f"{path} {name}")


ALL = dict(commands(cli))


def test_every_command_has_a_sentence_of_help() -> None:
    poor = [name for name, command in ALL.items() if len((command.help or "").split()) < 4]
    assert poor == [], "write a docstring for each: what it does, then what its arguments are"


@pytest.mark.parametrize("name", ALL)
def test_every_option_tells_more_than_its_name(name: str) -> None:
    for option in ALL[name].params:
        if isinstance(option, click.Option) and not option.hidden:
            own = {word for text in option.opts for word in re.findall(r"[a-z]+", text.lower())}
            told = set(re.findall(r"[a-z]+", (option.help or "").lower()))
            assert len(told - own) >= 2, f"{name} {option.opts[0]}: write help that says what it is for"


@pytest.mark.parametrize("name", ALL)
def test_every_argument_is_told_in_the_help_of_its_command(name: str) -> None:
    context = click.Context(ALL[name], **cli.context_settings)
    for argument in ALL[name].params:
        if isinstance(argument, click.Argument):
            word = argument.make_metavar(context).strip("[].")
            told = (ALL[name].help or "").upper()
            assert re.search(rf"\b{word}S?\b", told), f"{name}: its help does not tell what {word} is"


def test_every_environment_variable_is_on_its_page_and_no_other() -> None:
    told = set(
        re.findall(r"^\| `([A-Z0-9_]+)` \|", ENVIRONMENT.read_text(encoding="utf-8"), flags=re.MULTILINE)
    )
    assert read() == told, "docs/reference/environment.md has one row for each that is read"


def read() -> set[str]:
    """Give every variable that the package, its tools, tests and benchmarks read."""
    folders = ("src", "tools", "tests", "benchmarks")
    files = [p for folder in folders for p in (REPOSITORY / folder).rglob("*") if p.suffix in (".py", ".sh")]
    files += [REPOSITORY / "Makefile", REPOSITORY / "hatch_build.py"]
    found: set[str] = set()
    for file in files:
        if file.name != "test_options.py":
            text = file.read_text(encoding="utf-8")
            found |= {name for match in VARIABLE.findall(text) for name in match if name}
            found |= set(SET_IN_MAKE.findall(text)) if file.name == "Makefile" else set()
    return found
