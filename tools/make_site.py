"""Build the site from the documents and the code, without network: ``python -m tools.make_site [FOLDER]``."""

from __future__ import annotations

import posixpath
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from tools.markdown import LINK, links

REPOSITORY = Path(__file__).parents[1]
SOURCE = REPOSITORY / "build" / "docs"
"""The pages as Sphinx reads them: those of the repository, and those made from the code."""
OUTPUT = REPOSITORY / "build" / "site"
DOCS = REPOSITORY / "docs"
CONTENTS = DOCS / "README.md"
"""The page whose sections order the site."""
FRONT = "README.md"
TOP = (FRONT, "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md")
PLACEHOLDER = re.compile(r"<!-- from the code: ([\w-]+) -->\n.*?<!-- end -->\n", flags=re.DOTALL)
"""What stands for a part that is made from the code; the text inside is for readers of the repository."""


def sections() -> list[tuple[str, list[str]]]:
    """Return every section of the contents with the pages it links to, relative to the repository."""
    found: list[tuple[str, list[str]]] = []
    for part in re.split(r"(?m)^## ", CONTENTS.read_text(encoding="utf-8"))[1:]:
        title, _, text = part.partition("\n")
        pages = [target for target in links(text) if target.endswith(".md")]
        found.append((title, [posixpath.normpath(f"docs/{page}") for page in pages]))
    return found


def stage(folder: Path) -> None:
    """Write all pages, and the files that they link to, where Sphinx finds them."""
    kept = set()
    for name, content in {**_pages(), **_made_from_code()}.items():
        target = folder / name
        kept.add(target)
        if not target.is_file() or target.read_bytes() != content:  # Sphinx reads only what changed
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
    for old in {path for path in folder.rglob("*") if path.is_file()} - kept:
        old.unlink()


def _pages() -> dict[str, bytes]:
    """Return every page and linked file of the repository by its name on the site."""
    waiting = [*TOP, *(str(page.relative_to(REPOSITORY)) for page in sorted(DOCS.rglob("*.md")))]
    staged: dict[str, bytes] = {}
    while waiting:
        page = waiting.pop()
        if _staged(page) in staged or not (REPOSITORY / page).is_file():
            continue
        content = (REPOSITORY / page).read_bytes()
        if page.endswith(".md"):
            text = content.decode()
            content = _page(page, text).encode()
            waiting += [_resolved(page, link) for link in links(text) if not _is_outside(link)]
        staged[_staged(page)] = content
    return staged


def _made_from_code() -> dict[str, bytes]:
    """Return the pages of packages and commands by their name on the site."""
    from tools.site_api import api_pages, command_pages

    found = {f"docs/reference/api/{name}.rst": text for name, text in api_pages().items()}
    found |= {f"docs/reference/cli/{name}.rst": text for name, text in command_pages().items()}
    return {name: text.encode() for name, text in found.items()}


def from_code(name: str) -> str:
    """Return the part of a page that is made from the code."""
    from tools import make_protocol_reference, make_record_reference, make_rig_reference, site_api

    if name == "api":
        return _toctree("", [f"{page}.md" for page in site_api.api_pages()], "api/", hidden=False)
    if name == "cli":
        return _toctree("", [f"{page}.md" for page in site_api.command_pages()], "cli/", hidden=False)
    makers = {
        "files": make_record_reference.files_tables,
        "settings": make_record_reference.settings_tables,
        "studio-messages": make_record_reference.message_tables,
        "protocol": make_protocol_reference.rig_tables,
        "strip-protocol": make_protocol_reference.strip_tables,
        "rig": make_rig_reference.rig_parameters,
        "button": make_rig_reference.button_parameters,
    }
    return makers[name]()


def _page(page: str, text: str) -> str:
    """Return a page as the site has it: links to folders and to the front page changed, contents added."""
    filled = PLACEHOLDER.sub(lambda mark: from_code(mark[1]), text)
    moved = LINK.sub(lambda link: f"]({_moved(page, link[1])})", filled)
    if page == FRONT:
        groups = "\n".join(_toctree(title, pages) for title, pages in sections())
        project = _toctree("Project", ["docs/README.md", *TOP[1:]])
        return f"{moved}\n{groups}\n{project}"
    if page not in TOP and (not page.startswith("docs/") or page.endswith("NOTICE.md")):
        return f"---\norphan: true\n---\n\n{moved}"  # reached by links only
    return moved


def _toctree(caption: str, pages: list[str], base: str = "/", hidden: bool = True) -> str:
    options = [":hidden:"] if hidden else [":maxdepth: 1"]
    options += [f":caption: {caption}"] if caption else []
    own = (page.partition("#")[0].removesuffix(".md") for page in pages if ".md" in page)
    lines = [f"{base}{page}" for page in dict.fromkeys(own) if page]
    return "\n".join(["```{toctree}", *options, "", *lines, "```", ""])


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


def build(output: Path, source: Path = SOURCE) -> None:
    """Build the site; any warning of Sphinx ends it (CalledProcessError)."""
    stage(source)
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-j", "auto", "-b", "html"]
    folders = ["-c", str(DOCS), "-d", str(source.with_name(f"{source.name}-trees")), str(source), str(output)]
    subprocess.run([*command, *folders], check=True, cwd=REPOSITORY)


def missing() -> list[str]:
    """Return the packages that the site needs and that are not installed."""
    return [name for name in ("sphinx", "myst_parser", "furo", "sphinx_click") if find_spec(name) is None]


if __name__ == "__main__":
    if missing():
        sys.exit(f"the site needs {', '.join(missing())}: pip install --group docs")
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    build(folder)
    print(folder / "index.html")
