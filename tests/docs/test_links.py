"""Links lead somewhere: to a file, to a heading in it, or to an address that can be one."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from tests.docs.pages import API, DOCS, PAGES, name_of
from tools.markdown import anchors, links, slug, slugs

CONTENTS = DOCS / "README.md"


@cache
def anchors_of(page: Path) -> set[str]:
    return anchors(page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    for link in dict.fromkeys(links(page.read_text(encoding="utf-8"))):
        if re.match(r"[a-z]+:", link):
            check_address(page, link)
            continue
        file, _, mark = link.partition("#")
        target = (page.parent / file).resolve() if file else page
        assert target.exists(), f"{name_of(page)} links to {link}: there is no such file"
        if mark and target.suffix == ".md":
            assert mark in anchors_of(target), f"{name_of(page)} links to {link}: there is no such heading"


def check_address(page: Path, link: str) -> None:
    """Look at an address without following it: tests ask nothing from a network."""
    parts = urlsplit(link)
    if parts.scheme == "mailto":
        return
    assert parts.scheme in ("https", "http"), f"{name_of(page)} links to {link}"
    assert re.fullmatch(r"[a-z0-9-]+(\.[a-z0-9-]+)+(:\d+)?", parts.netloc), f"{name_of(page)} links to {link}"


def test_every_page_is_in_the_contents() -> None:
    told = {
        (DOCS / link).resolve()
        for link in links(CONTENTS.read_text(encoding="utf-8"))
        if link.endswith(".md")
    }
    pages = {page for page in DOCS.rglob("*.md") if page.name != "NOTICE.md" and page.parent != API}
    missing = sorted(name_of(page) for page in pages - told - {CONTENTS})
    assert missing == [], (
        "link each from docs/README.md, below what people want: learn, do, look up, understand"
    )


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_a_page_has_one_title_and_it_comes_first(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert text.startswith("# "), f"{name_of(page)}: begin with '# Title'"
    outside = re.sub(r"(?ms)^```.*?^```$", "", text)
    assert len(re.findall(r"(?m)^# ", outside)) == 1, f"{name_of(page)}: one title, '## ' below it"


def test_anchors_are_those_of_github() -> None:
    assert slug("The model file, `*.fdvv.json`") == "the-model-file-fdvvjson"
    assert slug("Do [this](that.md) at 1 kHz") == "do-this-at-1-khz"
    assert slugs(["Landmarks", "landmarks", "Other", "LANDMARKS"]) == [
        *("landmarks", "landmarks-1"),
        *("other", "landmarks-2"),
    ]


def test_links_in_code_are_none() -> None:
    assert links("[a](b.md) `[c](d.md)` ![e](f.svg)\n```\n[g](h.md)\n```\n") == ["b.md", "f.svg"]
