"""The Jinja2 templates of reports and notebooks; text is escaped unless it is marked as HTML."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from markupsafe import Markup

from fdvv.report.svg import prefix_ids

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def environment() -> Environment:
    """Return the environment that loads the templates beside this module."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    made = Environment(
        loader=PackageLoader("fdvv.report", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters["own_ids"] = lambda svg, prefix: Markup(prefix_ids(svg, prefix))
    return made
