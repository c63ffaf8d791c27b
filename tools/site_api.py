"""A Sphinx extension: pages of every package and every command, and docstrings as reStructuredText."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from typing import Any

import click
from sphinx.application import Sphinx
from tools.docstrings import SECTION, read

import fdvv
import fdvv_campaigns
import fdvv_people
import fdvv_studio
from fdvv.cli.main import cli

DISTRIBUTIONS = (fdvv, fdvv_studio, fdvv_people, fdvv_campaigns)
HIDDEN = ("__main__", "_native", "cad", "static", "cli", "serve", "studio", "pages")
"""Packages without names for users; commands and messages have pages of their own."""
CODE = re.compile(
    r"(`+)(.+?)\1|(?<![\w*])(?P<stars>\*\*?)(?=[^\s*])[^*]*[^\s*](?P=stars)(?![\w*])", flags=re.DOTALL
)
"""Code, and emphasis, which is kept."""
SPECIAL = re.compile(r"([*|\\]|_(?=\W|$))")


def api_pages() -> dict[str, str]:
    """Return pages by name: of each distribution its face, then one page for each package or module."""
    pages: dict[str, str] = {}
    for package in DISTRIBUTIONS:
        top = package.__name__
        parts = [name for name, _ in _modules(package.__path__, f"{top}.")]
        pages |= {top: _page(top, []), **{name: _page(name, list(_below(name))) for name in parts}}
    return pages


def _modules(path: Any, prefix: str) -> Iterator[tuple[str, bool]]:
    for module in pkgutil.iter_modules(path, prefix):
        last = module.name.rpartition(".")[2]
        if last not in HIDDEN and not last.startswith("_"):
            yield module.name, module.ispkg


def _below(name: str) -> Iterator[str]:
    """Yield the modules of a package and of the packages in it."""
    package = importlib.import_module(name)
    for inner, is_package in _modules(getattr(package, "__path__", []), f"{name}."):
        yield inner
        if is_package:
            yield from _below(inner)


def _page(name: str, inner: list[str]) -> str:
    parts = [f"{name}\n{'=' * len(name)}\n", f".. automodule:: {name}\n"]
    for module in inner:
        parts += [f"{module}\n{'-' * len(module)}\n", f".. automodule:: {module}\n"]
    return "\n".join(parts)


def command_pages() -> dict[str, str]:
    """Return the pages of the commands by name."""
    context = click.Context(cli)
    return {name: _command_page(name, cli.get_command(context, name)) for name in cli.list_commands(context)}


def _command_page(name: str, command: click.Command | None) -> str:
    assert command is not None
    assert command.callback is not None
    module = inspect.unwrap(command.callback).__module__
    attribute = next(key for key, value in vars(importlib.import_module(module)).items() if value is command)
    return f".. click:: {module}:{attribute}\n   :prog: fdvv {name}\n   :nested: full\n"


def as_rst(text: str) -> str:
    """Return a paragraph with code as literals and all else as plain text."""
    pieces, last = [], 0
    for span in CODE.finditer(text):
        pieces += [
            SPECIAL.sub(r"\\\1", text[last : span.start()]),
            f"``{span[2].strip()}``" if span[1] else span[0],
        ]
        last = span.end()
    return "".join([*pieces, SPECIAL.sub(r"\\\1", text[last:])])


def docstring_as_rst(doc: str, names: tuple[str, ...]) -> str:
    """Return a docstring with its entries as fields; napoleon turns the sections at its end into more."""
    sections = SECTION.search(doc)
    top, end = (doc[: sections.start()], doc[sections.start() :]) if sections else (doc, "")
    text, entries = read(top.strip(), names)
    parts = [as_rst(text.summary)] if text else []
    paragraphs = text.paragraphs if text else ()
    parts += [f"::\n\n{code}" if code.startswith("    ") else as_rst(code) for code in paragraphs]
    parts.append("\n".join(f":param {name}: {as_rst(meaning)}" for name, meaning in entries.items()))
    parts.append(as_rst(end))
    return "\n\n".join(part for part in parts if part)


def _process(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    lines[:] = [*docstring_as_rst("\n".join(lines).strip(), _names(obj)).splitlines(), ""]


def _names(obj: Any) -> tuple[str, ...]:
    try:
        return tuple(inspect.signature(obj).parameters)
    except (TypeError, ValueError):
        return ()


def _skip(app: Sphinx, what: str, name: str, obj: Any, skip: bool, options: Any) -> bool | None:
    """Show functions and classes without a docstring too; their signature says what they are."""
    if skip and not name.startswith("_") and (inspect.isfunction(obj) or inspect.isclass(obj)):
        return not (getattr(obj, "__module__", "") or "").startswith("fdvv")
    return None


def _process_command(app: Sphinx, context: click.Context, lines: list[str]) -> None:
    is_markup = re.compile(r"\s*(\.\. |:\w|\| )")
    lines[:] = [line if is_markup.match(line) else as_rst(line) for line in lines]


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect to autodoc and to sphinx-click."""
    app.connect("autodoc-process-docstring", _process, priority=400)  # before napoleon
    app.connect("autodoc-skip-member", _skip)
    for part in ("description", "options", "epilog"):
        app.connect(f"sphinx-click-process-{part}", _process_command)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
