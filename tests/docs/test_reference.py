"""Everything that a user can name is described: options, fields, messages, parameters, variables."""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, Literal, get_args, get_origin, get_type_hints
from urllib.parse import unquote

import click
import msgspec
import pytest
from tools import make_site
from tools.docstrings import read
from tools.file_kinds import FILES
from tools.make_record_reference import messages
from tools.record_docs import describe
from tools.record_types import fields, reached

import fdvv
from fdvv.cli.main import cli
from fdvv.formats.force.read import READERS
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.finger import Finger
from fdvv.twin.quantity import about
from fdvv.twin.rig import Rig
from tests.docs.pages import DOCS, REPOSITORY
from tests.formats.conftest import TEXTS
from tests.support.campaign import in_turn

BY_HAND = {
    "model-file.md": "Model",
    "program-file.md": "Program",
    "recording-file.md": "Recording",
    "study-file.md": "Study",
    "timing-file.md": "Timing study",
    "answers-file.md": "Code book",
}
"""Pages that describe a kind of file by hand."""
OPTIONAL = re.compile(r"\.(__main__|libfdvv)$|\.cad\b|\._?(botorch|torch)|_botorch")
"""Modules that need packages which are mostly not installed; they define no files."""
VARIABLE = re.compile(
    r"environ(?:\.get|\.setdefault|\.pop)?[(\[]\s*[\"']([A-Z][A-Z0-9_]+)|getenv\(\s*[\"']([A-Z][A-Z0-9_]+)"
    r"|\$\{([A-Z][A-Z0-9_]+)(?::-|:\?|-)|(?m:^(?:export )?([A-Z][A-Z0-9_]+) \?=)"
    r"|envvar=[\"']([A-Z][A-Z0-9_]+)"
)


def _commands(group: click.Group, path: str = "fdvv") -> Iterator[tuple[str, click.Command]]:
    context = click.Context(group, **cli.context_settings)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield f"{path} {name}", command
        if isinstance(command, click.Group):
            yield from _commands(command, f"{path} {name}")


def test_commands_options_and_arguments_have_help() -> None:
    bare = []
    for name, command in _commands(cli):
        text = command.help or ""
        bare += [] if len(text.split()) >= 4 else [name]
        context = click.Context(command, **cli.context_settings)
        for parameter in command.params:
            if isinstance(parameter, click.Option) and not parameter.hidden:
                own = {word for option in parameter.opts for word in re.findall(r"[a-z]+", option.lower())}
                said = set(re.findall(r"[a-z]+", (parameter.help or "").lower()))
                bare += [] if len(said - own) >= 2 else [f"{name} {parameter.opts[0]}"]
            elif isinstance(parameter, click.Argument):
                word = parameter.make_metavar(context).strip("[].")
                bare += [] if re.search(rf"\b{word}S?\b", text.upper()) else [f"{name} {word}"]
    assert bare == []


def test_the_changelog_names_every_command() -> None:
    text = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    assert [name for name in cli.list_commands(click.Context(cli)) if f"`{name}`" not in text] == []


def test_fields_of_files_and_messages_are_described() -> None:
    records = [record for kind in FILES for record in reached(kind.classes)]
    assert (len(records) > 60, len(messages()) > 150) == (True, True)
    silent = []
    for record in [*records, *messages()]:
        doc = describe(record)
        silent += [f"{record.__name__}.{f.name}" for f in doc.fields.values() if not f.explained]
        silent += [] if doc.text else [record.__name__]
    assert silent == [], "write `name : meaning` into the docstring, or into tools/field_words.toml"
    missing = [record.__name__ for record in _structs() if _has_format(record) and record not in records]
    assert missing == [], "add each to tools/file_kinds.py"
    for page, title in BY_HAND.items():
        text = (DOCS / "reference" / page).read_text(encoding="utf-8")
        kinds = [kind for kind in FILES if kind.title == title]
        names = {f.encode_name for kind in kinds for record in reached(kind.classes) for f in fields(record)}
        assert names
        assert [n for n in names if not re.search(rf"`[^`]*\b{n}\b[^`]*`|\b{n}\b =", text)] == [], page


def _structs() -> list[type[msgspec.Struct]]:
    for module in pkgutil.walk_packages(fdvv.__path__, "fdvv."):
        if not OPTIONAL.search(module.name):
            importlib.import_module(module.name)
    found: list[type[msgspec.Struct]] = []
    waiting: list[type[msgspec.Struct]] = [msgspec.Struct]
    while waiting:
        below = waiting.pop().__subclasses__()
        found += below
        waiting += below
    return [record for record in found if record.__module__.startswith("fdvv.")]


def _has_format(record: type[msgspec.Struct]) -> bool:
    if "format" not in record.__struct_fields__:
        return False
    kind = get_type_hints(record)["format"]
    return get_origin(kind) is Literal and str(get_args(kind)[0]).startswith("fdvv-")


def test_formats_of_force_curves_are_described() -> None:
    page = (DOCS / "reference" / "force-files.md").read_text(encoding="utf-8")
    described = set(re.findall(r"^\| `([\w-]+)` \|", page, flags=re.MULTILINE))
    heads = {name: sample.text().strip().splitlines()[:60] for name, sample in TEXTS.items()}
    for recognise, read_lines in READERS:
        known = [name for name, head in heads.items() if recognise(head)]
        assert known, f"{read_lines.__name__}: add a sample to packages/fdvv/tests/formats/conftest.py"
    assert {*TEXTS, "bluepylons-ods"} - described == set()


def test_parameters_of_the_twin_are_described_with_their_source() -> None:
    for root in (Rig, Finger, ButtonPhysics):
        parameters = list(_parameters(root))
        assert len(parameters) > 10
        assert [f.name for f in parameters if not (about(f).text and about(f).source)] == []


def _parameters(root: type[Any]) -> Iterator[dataclasses.Field[Any]]:
    hints = get_type_hints(root)
    for field in dataclasses.fields(root):
        if "about" in field.metadata:
            yield field
        elif dataclasses.is_dataclass(hints[field.name]):
            yield from _parameters(hints[field.name])


def test_environment_variables_are_described() -> None:
    page = (DOCS / "reference" / "environment.md").read_text(encoding="utf-8")
    folders = ("packages", "tools", "tests", "benchmarks")
    files = [p for folder in folders for p in (REPOSITORY / folder).rglob("*") if p.suffix in (".py", ".sh")]
    texts = [p.read_text(encoding="utf-8") for p in files if p != Path(__file__)]
    texts += [(REPOSITORY / name).read_text(encoding="utf-8") for name in ("Makefile", "conftest.py")]
    used = {name for text in texts for match in VARIABLE.findall(text) for name in match if name}
    assert used == set(re.findall(r"^\| `([A-Z0-9_]+)` \|", page, flags=re.MULTILINE))


def test_a_docstring_is_split_into_text_and_entries() -> None:
    text, entries = read(
        "Fit a curve.\n\nx_mm, y : points; size : number of points,\nat least 4. More text.\n\n    a = b\n\n"
        "Attributes\n----------\nkept : whether it\n    was kept.\nother : no parameter.",
        ("x_mm", "y", "size", "kept"),
    )
    assert text is not None
    assert text.summary == "Fit a curve."
    assert {*text.paragraphs} >= {"    a = b", "other : no parameter."}
    assert entries["x_mm"] == entries["y"] == "points"
    assert entries["size"].startswith("number of points, at least 4")
    assert entries["kept"] == "whether it was kept"


LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href", "object": "data"}
"""What a browser loads by itself, by the attribute that names it."""


class Page(HTMLParser):
    """Collects the anchors of a page, what it links to and what it loads."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = {name: value for name, value in attrs if value}
        self.anchors |= {found[name] for name in ("id", "name") if name in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if tag in LOADED and LOADED[tag] in found:
            self.loads.append(found[LOADED[tag]])


@pytest.mark.slow
@in_turn(3)
def test_the_site_builds_without_warnings_its_links_resolve_and_it_loads_nothing_from_outside(
    tmp_path: Path,
) -> None:
    if make_site.missing():
        pytest.skip(f"the site needs {make_site.missing()}")
    site = tmp_path / "site"
    make_site.build(site, tmp_path / "source")
    pages = {path: Page(path) for path in site.rglob("*.html")}
    assert len(pages) > 100
    broken = []
    for path, page in pages.items():
        for address in {*page.loads, *page.links}:
            if re.match(r"(https?:|mailto:|//)", address):
                broken += [f"{path.name} loads {address}"] if address in page.loads else []
                continue
            file, _, mark = unquote(address.partition("?")[0]).partition("#")
            target = (path.parent / file).resolve() if file else path
            known = not mark or target not in pages or mark in pages[target].anchors
            broken += [] if target.is_file() and known else [f"{path.name} links to {address}"]
    assert broken == []
    styles = [path.read_text(encoding="utf-8") for path in site.rglob("*.css")]
    assert not any(mark in text for text in styles for mark in ("url(http", "url(//", "@import"))
    index = (site / "searchindex.js").read_text(encoding="utf-8")
    names = [str(page.relative_to(REPOSITORY)).removesuffix(".md") for page in DOCS.rglob("*.md")]
    assert [name for name in names if f'"{name}"' not in index] == []
    for title, _ in make_site.sections():
        assert title in (site / "index.html").read_text(encoding="utf-8")
