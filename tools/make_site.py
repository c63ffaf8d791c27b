"""Build the site from the documents, without network: ``python -m tools.make_site [FOLDER]``."""

from __future__ import annotations

import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from tools.markdown import LINK, links

REPOSITORY = Path(__file__).parents[1]
OUTPUT = REPOSITORY / "build" / "site"
DOCS = REPOSITORY / "docs"
CONTENTS = DOCS / "README.md"
"""The page whose sections order the site."""
FRONT = "README.md"
API = "docs/reference/api/README.md"
"""Leads to the pages of the rooms."""
TOP = (FRONT, "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md")


def sections() -> list[tuple[str, list[str]]]:
    """Give every section of the contents with the pages it leads to, relative to the repository."""
    found: list[tuple[str, list[str]]] = []
    for part in re.split(r"(?m)^## ", CONTENTS.read_text(encoding="utf-8"))[1:]:
        title, _, text = part.partition("\n")
        pages = [target for target in links(text) if target.endswith(".md")]
        found.append((title, [posixpath.normpath(f"docs/{page}") for page in pages]))
    return found


def stage(folder: Path) -> None:
    """Copy all pages, and whatever they lead to, where Sphinx finds them."""
    waiting = [*TOP, *(str(page.relative_to(REPOSITORY)) for page in sorted(DOCS.rglob("*.md")))]
    done: set[str] = set()
    while waiting:
        page = waiting.pop()
        if page in done or not (REPOSITORY / page).is_file():
            continue
        done.add(page)
        target = folder / _staged(page)
        target.parent.mkdir(parents=True, exist_ok=True)
        if not page.endswith(".md"):
            shutil.copyfile(REPOSITORY / page, target)
            continue
        text = (REPOSITORY / page).read_text(encoding="utf-8")
        target.write_text(_page(page, text), encoding="utf-8")
        waiting += [_resolved(page, link) for link in links(text) if not _is_outside(link)]


def _page(page: str, text: str) -> str:
    """Give a page as the site has it: folders and the front page under their names there, and contents."""
    moved = LINK.sub(lambda link: f"]({_moved(page, link[1])})", text)
    if page == FRONT:
        groups = "\n".join(_toctree(title, pages) for title, pages in sections())
        house = _toctree("House", ["docs/README.md", *TOP[1:]])
        return f"{moved}\n{groups}\n{house}"
    if page == API:
        return f"{moved}\n{_toctree('', sorted(target for target in links(text) if '/' not in target), '')}"
    if page not in TOP and (not page.startswith("docs/") or page.endswith("NOTICE.md")):
        return f"---\norphan: true\n---\n\n{moved}"  # found by its links alone
    return moved


def _toctree(caption: str, pages: list[str], base: str = "/") -> str:
    named = f":caption: {caption}\n" if caption else ""
    own = (page.partition("#")[0].removesuffix(".md") for page in pages if ".md" in page)
    lines = "\n".join(f"{base}{page}" for page in dict.fromkeys(own) if page)
    return f"```{{toctree}}\n:hidden:\n{named}\n{lines}\n```\n"


def _is_outside(link: str) -> bool:
    return link.startswith("#") or re.match(r"[a-z]+:", link) is not None


def _resolved(page: str, link: str) -> str:
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), link.partition("#")[0]))


def _staged(page: str) -> str:
    return "index.md" if page == FRONT else page


def _moved(page: str, link: str) -> str:
    if _is_outside(link):
        return link
    target = _resolved(page, link)
    if (REPOSITORY / target).is_dir():
        target = f"{target}/README.md" if (REPOSITORY / target / "README.md").is_file() else "docs/README.md"
    elif target != FRONT:
        return link
    mark = "#" + link.partition("#")[2] if "#" in link else ""
    return posixpath.relpath(_staged(target), posixpath.dirname(page) or ".") + mark


def build(output: Path) -> None:
    """Build the site, whole or not at all; whatever Sphinx warns of ends it (CalledProcessError)."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "source"
        stage(source)
        shutil.copytree(DOCS / "_static", source / "_static")
        made = Path(folder) / "site"
        command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-j", "2", "-b", "html"]
        where = ["-c", str(DOCS), "-d", str(Path(folder) / "trees"), str(source), str(made)]
        subprocess.run([*command, *where], check=True)
        shutil.rmtree(output, ignore_errors=True)
        shutil.copytree(made, output)


def missing() -> list[str]:
    """Give what the site needs and is not installed."""
    return [name for name in ("sphinx", "myst_parser", "furo") if find_spec(name) is None]


if __name__ == "__main__":
    if missing():
        sys.exit(f'the site needs {", ".join(missing())}: pip install "fdvv[docs]"')
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    build(folder)
    print(folder / "index.html")
