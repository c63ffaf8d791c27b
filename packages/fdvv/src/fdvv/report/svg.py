"""Figures as text and pixels: the same figure gives the same bytes, and several can share one page."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.report.style import house_style, show_force_unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SALT = "fdvv"
"""matplotlib names clip paths and glyphs by a random salt unless it is given one."""


@contextmanager
def _saving() -> Iterator[None]:
    """Set what saving reads, and let a name in a script that the font lacks be drawn as boxes."""
    with house_style(svg__hashsalt=SALT, svg__fonttype="path"), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from", category=UserWarning)
        yield


def figure_of(drawn: Any) -> Figure:
    """Return the figure of what a plot function returned: axes, several axes, or a figure itself."""
    while isinstance(drawn, (tuple, np.ndarray)):
        drawn = drawn[0]
    if drawn.figure is None:
        raise ModelError("these axes were taken off their figure")
    # axes may sit in a part of a figure, which knows the whole
    whole: Figure = drawn.figure.figure
    show_force_unit(whole)
    return whole


def figure_svg(drawn: Any, description: str = "") -> str:
    """Draw a figure as one `<svg>` element for a page or a file.

    drawn : a figure, or what a plot function gave.
    description : what the figure shows, for those who cannot see it; by default its titles.
    The element holds no date, no comment, no document-wide style and no address outside itself; the same
    figure gives the same text.
    """
    fig, stream = figure_of(drawn), io.StringIO()
    nothing = {"Date": None, "Creator": None, "Format": None, "Type": None}
    with _saving():
        fig.savefig(stream, format="svg", metadata=nothing)
    return _standalone(stream.getvalue(), description or _titles(fig))


def figure_png(drawn: Any, dpi: float = 110.0) -> bytes:
    """Draw a figure, or what a plot function gave, as PNG bytes without date or program name."""
    fig, stream = figure_of(drawn), io.BytesIO()
    with _saving():
        fig.savefig(stream, format="png", dpi=dpi, metadata={"Software": None})
    return stream.getvalue()


def prefix_ids(svg: str, prefix: str) -> str:
    """Rename every id of an svg element and every use of one, so that two figures cannot mix theirs up."""
    return re.sub(r"<[^>]+>", lambda tag: _prefix_tag(tag[0], prefix), svg)


def _prefix_tag(tag: str, prefix: str) -> str:
    """Rename ids and their uses within one tag; text between tags may look like either and is let be."""
    tag = re.sub(r'(\s(?:id|aria-labelledby)=")', rf"\g<1>{prefix}", tag)
    return re.sub(r'(\s(?:xlink:)?href="#|url\(#)', rf"\g<1>{prefix}", tag)


def _titles(fig: Figure) -> str:
    texts = [ax.get_title(loc=loc) for ax in fig.axes for loc in ("left", "center", "right")]
    return "; ".join(dict.fromkeys(text for text in texts if text)) or "figure"


def _standalone(document: str, description: str) -> str:
    """Cut matplotlib's document down to its svg element and say what it shows."""
    svg = document[document.index("<svg") :].rstrip()
    svg = re.sub(r"<!--.*?-->\s*", "", svg, flags=re.DOTALL)
    # its style sheet speaks to the whole page; both properties are inherited, so the root can say them
    svg = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>\s*", "", svg, count=1, flags=re.DOTALL)
    look = 'stroke-linejoin="round" stroke-linecap="butt" role="img" aria-labelledby="title"'
    opening, rest = svg.split(">", 1)
    # XML has no place for control characters
    spoken = escape("".join(c if c.isprintable() else " " for c in description))
    return f'{opening} {look}>\n <title id="title">{spoken}</title>{rest}\n'
