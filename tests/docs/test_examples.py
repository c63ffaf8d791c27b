"""What the documents show is what runs: programs, commands and what they print, options of the rest."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from tests.docs.pages import (
    API,
    DOCS,
    PAGES,
    REPOSITORY,
    LEARNED_absolute,
    alike,
    blocks_of,
    follow,
    name_of,
    steps,
)
from tools.markdown import SPAN, blocks

from fdvv.cli import cli

RUN_ELSEWHERE = {
    "README.md": "test_tutorials.py",
    "docs/tutorials/first-button.md": "test_tutorials.py",
    "docs/tutorials/new-program.md": "test_tutorials.py",
    "docs/tutorials/compensate-a-rig.md": "test_tutorials.py",
    "docs/tutorials/capture-a-button.md": "test_tutorials.py",
    "docs/tutorials/run-a-study.md": "test_tutorials.py",
    "docs/tutorials/optimise.md": "test_tutorials.py",
    "docs/reference/recording-file.md": "recording/test_documents.py",
    "docs/reference/answers-file.md": "workflow/test_study_analyse_csv.py",
    "docs/reference/library-files.md": "workflow/test_library.py",
    "docs/reference/sweep-files.md": "workflow/test_sweep.py",
}
"""Pages whose examples have a test of their own."""
NOT_RUN: dict[str, str] = {
    "docs/how-to/exchange.md": "begins from a recording of one's own",
}
"""Pages whose examples no test runs, and why."""
EXTRAS = {"docs/how-to/work-in-a-notebook.md": ("matplotlib", "pandas")}
"""Optional packages that a page needs."""
NOT_SEEN = {"py", "python3", "pycon", "bash", "shell", "shell-session"}
"""Languages under which an example would escape the tests."""


def runs(page: Path) -> bool:
    """Tell whether a page shows anything to run."""
    return any(block.language in ("console", "python") for block in blocks_of(page))


WRITTEN = [page for page in PAGES if page.parent != API and page != DOCS / "reference" / "cli.md"]
"""Pages that are not made from the code."""
SHOWING = [page for page in WRITTEN if runs(page)]
HERE = [page for page in SHOWING if name_of(page) not in {**RUN_ELSEWHERE, **NOT_RUN}]


@pytest.fixture
def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONUTF8": "1", "COLUMNS": "100", "MPLBACKEND": "agg"}


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("page", HERE, ids=name_of)
def test_a_page_goes_as_it_shows(page: Path, tmp_path: Path, environment: dict[str, str]) -> None:
    for package in EXTRAS.get(name_of(page), ()):
        pytest.importorskip(package)
    follow(page, tmp_path, environment)


def test_pages_that_are_not_run_here_are_named_with_their_test_or_reason() -> None:
    names = {name_of(page) for page in SHOWING}
    assert set(RUN_ELSEWHERE) | set(NOT_RUN) <= names, "take pages off the lists that show nothing to run"
    for name, test in RUN_ELSEWHERE.items():
        assert Path(name).name in (REPOSITORY / "tests" / test).read_text(encoding="utf-8"), (name, test)
    assert all(NOT_RUN.values())


@pytest.mark.parametrize("page", WRITTEN, ids=name_of)
def test_blocks_say_what_they_are(page: Path) -> None:
    for block in blocks_of(page):
        where = f"{name_of(page)}:{block.line}"
        assert block.language not in NOT_SEEN, f"{where}: write python, console, or text for what is not run"
        if block.language == "console":
            assert block.text.startswith("$ "), f"{where}: begin with '$ ' and a command"
            assert steps(block.text)


@pytest.mark.parametrize("page", WRITTEN, ids=name_of)
def test_commands_that_are_shown_have_these_options(page: Path) -> None:
    for line in shown(page.read_text(encoding="utf-8")):
        told = problem(line)
        assert not told, f"{name_of(page)} shows {line!r}: {told}"


def shown(text: str) -> Iterator[str]:
    """Give every command line of this package on a page, in blocks and within lines."""
    for block in blocks(text):
        for line in block.text.replace("\\\n", "").splitlines():
            if found := re.match(r"(?:\$ )?(fdvv [a-z].*)", line):
                yield found[1]
    for span in SPAN.finditer(re.sub(r"(?ms)^```.*?^```$", "", text)):
        words = " ".join(span[0].strip("`").split())
        if re.match(r"fdvv [a-z]+( |$)", words):
            yield words


def problem(line: str) -> str:
    """Tell what is wrong with the command and the options of a line, "" if nothing is."""
    text = re.split(r" (?:\||>|&&|…|\.\.\.)|[;…]", line)[0]
    words = shlex.split(text, comments=True)[1:]
    command: click.Command = cli
    context = click.Context(cli, **cli.context_settings)
    while isinstance(command, click.Group) and words and not words[0].startswith("-"):
        found = command.get_command(context, words[0])
        if found is None:
            return f"there is no command {words[0]}"
        if not isinstance(found, click.Group) or len(words) > 1:
            words = words[1:]
        else:
            return ""
        command, context = found, click.Context(found, context)
    try:
        command.make_parser(context).parse_args(words)
    except click.NoSuchOption as error:
        return f"there is no option {error.option_name}"
    except click.UsageError:
        return ""  # a part of a line, without the value of its option
    return ""


def test_a_wrong_option_would_be_found() -> None:
    assert problem("fdvv fit curve.csv --control-points 9 -o x.json") == ""
    assert "--controll" in problem("fdvv fit curve.csv --controll 9")
    assert "fitt" in problem("fdvv fitt curve.csv")
    assert "frezze" in problem("fdvv study frezze x")


def test_figures_of_learning_may_differ_a_little_and_words_may_not() -> None:
    assert alike("press 50 mm/s 4.0 12", "press 50 mm/s 4.9 14", learned=True)
    assert not alike("press 50 mm/s 4.0 12", "press 50 mm/s 4.9 14", learned=False)
    assert not alike("press 50 mm/s 4.0 12", f"press 50 mm/s {4.1 + LEARNED_absolute} 12", learned=True)
    assert not alike("press 50 mm/s 4.0", "release 50 mm/s 4.0", learned=True)
    assert not alike("press 4.0", "press 4.0 5.0", learned=True)


def test_a_console_block_is_split_into_commands_and_what_they_print() -> None:
    one, other = steps("$ fdvv fit a.csv \\\n  -o b.json # a remark\nfitted\n$ fdvv show 'b c'\n")
    assert one.command == ("fdvv", "fit", "a.csv", "-o", "b.json")
    assert one.shown == ("fitted",)
    assert other.command == ("fdvv", "show", "b c")
    assert other.shown == ()


def test_a_block_that_follows_the_name_of_a_file_is_that_file() -> None:
    named, unnamed = blocks("This is `a.csv`:\n\n```csv\n1\n```\n\nThis is `b.csv`.\n\n```csv\n2\n```\n")
    assert (named.name, named.text, unnamed.name) == ("a.csv", "1\n", "")
