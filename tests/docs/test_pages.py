"""Links resolve, and the commands and programs on the pages run as shown."""

from __future__ import annotations

import json
import os
import re
import shlex
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

import click
import pytest
from tools.markdown import anchors, links

from fdvv.cli.main import cli
from tests.docs.pages import DOCS, PAGES, REPOSITORY, blocks_of, commands_on, follow, name_of, steps
from tests.support.campaign import wait_for_turn

UNSEEN = {"py", "python3", "pycon", "bash", "shell", "shell-session"}
"""Languages that the tests would not run."""
RUN_ELSEWHERE = {
    "docs/reference/recording-file.md": "recording/test_documents.py",
    "docs/reference/answers-file.md": "study/test_study_analyse_csv.py",
    "docs/reference/library-files.md": "library/test_library.py",
    "docs/reference/sweep-files.md": "sweep/test_sweep.py",
}
"""Pages whose examples have a test of their own."""
NOT_RUN = {"docs/how-to/exchange.md"}
"""Pages that start from a recording of the reader."""
FAST = {
    "docs/features.md",
    "docs/how-to/drive-from-another-program.md",
    "docs/tutorials/first-button.md",
    "docs/tutorials/new-program.md",
    "docs/tutorials/capture-a-button.md",
}
NEEDS = {
    "docs/how-to/drive-from-another-program.md": ("sklearn",),
    "docs/how-to/use-from-python.md": ("matplotlib",),
    "docs/how-to/from-a-model-to-a-switch.md": ("matplotlib", "ezdxf"),
    "docs/tutorials/first-button.md": ("matplotlib",),
}
"""Optional packages of a page."""
SHORTER = {
    "docs/tutorials/optimise.md": {
        "population": ("--people", "2", "--grid", "4"),
        "experiment": ("--people", "3", "--trials", "2"),
        "clear-run": ("--trials", "4", "--retest", "2"),
        "warm-run": ("--trials", "4", "--retest", "2"),
    }
}
"""Options that make a command of a page shorter, by a word of it; of one given twice the last counts."""


SELDOM = {"docs/tutorials/optimise.md": 3}
"""Pages that run for minutes: one usual run in so many plays them."""


def _showing() -> list[str]:
    pages = {name_of(p) for p in PAGES if any(b.language in ("console", "python") for b in blocks_of(p))}
    assert pages >= {*RUN_ELSEWHERE, *NOT_RUN, *FAST, *NEEDS, *SHORTER}
    return sorted(pages - {*RUN_ELSEWHERE, *NOT_RUN})


def _marks(name: str) -> tuple[pytest.MarkDecorator, ...]:
    return () if name in FAST else (pytest.mark.slow, wait_for_turn(name, SELDOM.get(name, 1)))


@cache
def _anchors_of(page: Path) -> set[str]:
    return anchors(page.read_text(encoding="utf-8"))


def _broken(page: Path, link: str) -> bool:
    if re.match(r"[a-z]+:", link):  # tests do not use the network
        parts = urlsplit(link)
        host = re.fullmatch(r"[a-z0-9-]+(\.[a-z0-9-]+)+(:\d+)?", parts.netloc)
        return parts.scheme != "mailto" and (parts.scheme not in ("https", "http") or host is None)
    file, _, mark = link.partition("#")
    target = (page.parent / file).resolve() if file else page
    known = not mark or target.suffix != ".md" or not target.exists() or mark in _anchors_of(target)
    return not (target.exists() and known)


def test_links_and_their_anchors_resolve() -> None:
    every = [(page, link) for page in PAGES for link in links(page.read_text(encoding="utf-8"))]
    assert len(every) > 300
    assert [f"{name_of(page)}: {link}" for page, link in every if _broken(page, link)] == []


def test_pages_have_one_title_a_place_in_the_contents_and_blocks_that_the_tests_run() -> None:
    contents = {(DOCS / link).resolve() for link in links((DOCS / "README.md").read_text(encoding="utf-8"))}
    problems = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        titles = re.findall(r"(?m)^# ", re.sub(r"(?ms)^```.*?^```$", "", text))
        if len(titles) != 1 or not text.startswith("# "):
            problems.append(f"{name_of(page)}: start with one title")
        if page.is_relative_to(DOCS) and page not in contents and page.name not in ("README.md", "NOTICE.md"):
            problems.append(f"{name_of(page)}: link it from docs/README.md")
        for block in blocks_of(page):
            if block.language in UNSEEN or (block.language == "console" and not block.text.startswith("$ ")):
                problems.append(f"{name_of(page)}:{block.line}: write python, or console with '$ ', or text")
            elif block.language == "console":
                assert steps(block.text)
    assert problems == []


def _problem(line: str) -> str:
    """Return what is wrong with the command and the options of a line, or an empty string."""
    text = re.split(r" (?:\||>|&&|…|\.\.\.)|[;…]", line)[0]
    words = shlex.split(text, comments=True)[1:]
    command: click.Command = cli
    context = click.Context(cli, **cli.context_settings)
    while isinstance(command, click.Group) and words and not words[0].startswith("-"):
        inner = command.get_command(context, words[0])
        if inner is None:
            return f"there is no command {words[0]}"
        words = words[1:]
        command, context = inner, click.Context(inner, context)
    try:
        command.make_parser(context).parse_args(words)
    except click.NoSuchOption as error:
        return f"there is no option {error.option_name}"
    except click.UsageError:
        return ""  # a part of a line, without the value of its option
    return ""


def test_shown_commands_and_their_options_exist() -> None:
    every = [(page, line) for page in PAGES for line in commands_on(page.read_text(encoding="utf-8"))]
    assert len(every) > 200
    wrong = [f"{name_of(page)}: {line}: {_problem(line)}" for page, line in every if _problem(line)]
    assert wrong == []
    assert "--controll" in _problem("fdvv fit curve.csv --controll 9")
    assert "frezze" in _problem("fdvv study frezze x")


@pytest.mark.parametrize("name", [pytest.param(name, marks=_marks(name)) for name in _showing()])
def test_a_page_runs_as_shown(name: str, tmp_path: Path) -> None:
    for package in NEEDS.get(name, ()):
        pytest.importorskip(package)
    (tmp_path / "passphrase.txt").write_text("four words of one keeper\n")  # run-a-study asks for it
    environment = {**os.environ, "PYTHONUTF8": "1", "COLUMNS": "100", "MPLBACKEND": "agg"}
    page = REPOSITORY / name
    follow(page, tmp_path, environment, SHORTER.get(name, {}))
    text = page.read_text(encoding="utf-8")
    if name.endswith("from-a-model-to-a-switch.md"):
        files = {path.name for path in (tmp_path / "switch").iterdir()}
        assert all(f"`{file}`" in text for file in files)
        assert json.loads((tmp_path / "switch" / "mechanism.json").read_text())["met"] is True
    if name.endswith("compensate-a-rig.md"):
        files = {path.name for path in (tmp_path / "clear.session").iterdir()}
        assert files == set(re.findall(r"^\| `(.*?\.jsonl?)` \|", text, flags=re.MULTILINE))
