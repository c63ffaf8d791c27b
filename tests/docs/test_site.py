"""The site builds without a warning, all of its links lead somewhere, and it asks nothing from outside."""

from __future__ import annotations

from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest
from tests.docs.pages import DOCS, REPOSITORY
from tools import make_site

FETCHED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href", "object": "data"}
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
        if tag in FETCHED and FETCHED[tag] in found:
            self.loads.append(found[FETCHED[tag]])


def is_outside(address: str) -> bool:
    return address.startswith(("http:", "https:", "//", "mailto:"))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if make_site.missing():
        pytest.skip(f"the site needs {make_site.missing()}")
    folder = tmp_path_factory.mktemp("site") / "html"
    make_site.build(folder)
    return folder


@pytest.mark.slow
@pytest.mark.timeout(580)
def test_the_site_is_whole_and_asks_nothing_from_outside(site: Path) -> None:
    pages = {path: Page(path) for path in site.rglob("*.html")}
    assert len(pages) > 100
    for path, page in pages.items():
        for address in page.loads:
            assert not is_outside(address), f"{path.name} loads {address}"
            known = address == "#" or target(path, address).is_file()  # "#": this page itself
            assert known, f"{path.name} loads {address}, which is not there"
        for address in page.links:
            if not is_outside(address):
                check_link(path, address, pages)
    assert list(outside_in_styles(site)) == []
    check_contents(site)


def target(path: Path, address: str) -> Path:
    return (path.parent / unquote(address.partition("#")[0].partition("?")[0])).resolve()


def check_link(path: Path, address: str, pages: dict[Path, Page]) -> None:
    file, mark = target(path, address) if address[0] != "#" else path, address.partition("#")[2]
    assert file.is_file(), f"{path.name} links to {address}"
    if mark and file in pages:
        assert unquote(mark) in pages[file].anchors, f"{path.name} links to {address}: no such place"


def outside_in_styles(site: Path) -> Iterator[str]:
    """Give what a style sheet would load from elsewhere."""
    for path in site.rglob("*.css"):
        text = path.read_text(encoding="utf-8")
        yield from (f"{path.name}: {mark}" for mark in ("url(http", "url(//", "@import") if mark in text)


def check_contents(site: Path) -> None:
    """The search knows every page, and the front page leads to every section of the contents."""
    index = (site / "searchindex.js").read_text(encoding="utf-8")
    for page in DOCS.rglob("*.md"):
        name = str(page.relative_to(REPOSITORY)).removesuffix(".md")
        assert f'"{name}"' in index, f"the search does not know {name}"
    front = (site / "index.html").read_text(encoding="utf-8")
    for title, _ in make_site.sections():
        assert title in front


def test_the_contents_are_ordered_by_what_people_want() -> None:
    titles = [title for title, _ in make_site.sections()]
    assert titles == ["Learn", "Do", "Look up", "Understand", "Decisions"]
    pages = [page for _, found in make_site.sections() for page in found]
    assert all((REPOSITORY / page).is_file() for page in pages)
    kinds = dict(make_site.sections())
    for title, folder in (("Learn", "tutorials"), ("Do", "how-to"), ("Understand", "explanation")):
        assert {Path(page).parts[1] for page in kinds[title]} == {folder}, f"{title}: pages of docs/{folder}"


def test_a_staged_front_page_leads_where_it_did(tmp_path: Path) -> None:
    make_site.stage(tmp_path)
    front = (tmp_path / "index.md").read_text(encoding="utf-8")
    assert "](docs/tutorials/studio.md)" in front
    assert ":caption: Learn" in front
    assert not (tmp_path / "README.md").exists()
    assert (tmp_path / "docs" / "images" / "overview.png").is_file()
    credit = (tmp_path / "src" / "fdvv" / "model" / "builtin" / "NOTICE.md").read_text(encoding="utf-8")
    assert credit.startswith("---\norphan: true\n---")
