"""A drawing as SVG on an A4 sheet: three views and an oblique one, sizes, round edges, title block."""

from __future__ import annotations

from dataclasses import dataclass
from xml.sax.saxutils import escape

from fdvv_rig.cad.view import Line, View
from fdvv_rig.dimensions import Dimensions, meaning_of, source_of
from fdvv_rig.parts import Part

SHEET_mm = (297.0, 210.0)
MARGIN_mm = 8.0
TITLE_mm = (134.0, 44.0)
LEFT_mm = MARGIN_mm + 14.0
SCALES = (5.0, 2.0, 1.0, 0.5, 0.4, 0.25, 0.2)
AIR_mm = 24.0
"""Between views: room for their sizes."""

STYLE = """
.s{fill:none;stroke:#14213d;stroke-width:.35;stroke-linejoin:round;stroke-linecap:round}
.h{fill:none;stroke:#8a94a6;stroke-width:.18;stroke-dasharray:1.2 .8}
.d{fill:none;stroke:#0072b2;stroke-width:.15}
.c{fill:none;stroke:#b4530a;stroke-width:.15}
.f{fill:none;stroke:#14213d;stroke-width:.5}
.t{fill:none;stroke:#14213d;stroke-width:.2}
text{font-family:Helvetica,Arial,sans-serif;font-size:2.9px;fill:#14213d}
.n{fill:#0072b2}.m{fill:#b4530a}.q{fill:#5b6472;font-size:2.2px}.b{font-size:5.2px;font-weight:bold}
"""


@dataclass(frozen=True)
class Placed:
    """A view on the sheet: the place of its own lower left corner, in mm of paper, y down."""

    view: View
    left_mm: float
    bottom_mm: float
    scale: float

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Return a point of the view on the paper."""
        left, low, _, _ = self.view.box_mm
        return self.left_mm + (x - left) * self.scale, self.bottom_mm - (y - low) * self.scale


def sheet(part: Part, drawn: tuple[View, ...], d: Dimensions) -> str:
    """Draw a part's views with the sizes that a maker checks, and what its dimensions mean."""
    front, right, above, oblique = drawn
    scale = _scale(front, right, above)
    body = [*_frame(), *_title(part, d, scale)]
    for placed in _arranged(front, right, above, oblique, scale):
        body += _lines(placed, placed.view.shown, "s") + _lines(placed, placed.view.hidden, "h")
        body += _sizes(placed, placed.view is not oblique, placed.view in (front, above))
        body += _rounds(placed)
        x, y = placed.at(placed.view.box_mm[0], placed.view.box_mm[3])
        body.append(_text(x, y - 2.0, placed.view.title, "q"))
    width, height = SHEET_mm
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm"'
    head += f' viewBox="0 0 {width:g} {height:g}"><title>{escape(part.title)}</title>'
    ground = f'<rect width="{width:g}" height="{height:g}" fill="white"/>'
    return "\n".join([head, f"<style>{STYLE}</style>", ground, *body, "</svg>"]) + "\n"


def _size(view: View) -> tuple[float, float]:
    left, low, right, top = view.box_mm
    return right - left, top - low


def _scale(front: View, right: View, above: View) -> float:
    return next((s for s in SCALES if _low(front, right, above, s) is not None), SCALES[-1])


def _low(front: View, right: View, above: View, scale: float) -> float | None:
    """Return where the lower views stand on the paper; None where they do not fit at this scale."""
    (wide, high), (deep, _), (_, back) = _size(front), _size(right), _size(above)
    end = LEFT_mm + scale * (wide + deep) + AIR_mm + 10
    tall = scale * (high + back) + AIR_mm + 10
    bottom = SHEET_mm[1] - MARGIN_mm - 14
    if end <= SHEET_mm[0] - MARGIN_mm - TITLE_mm[0] and bottom - tall >= MARGIN_mm:
        return bottom
    bottom -= TITLE_mm[1]
    return bottom if end <= SHEET_mm[0] - MARGIN_mm and bottom - tall >= MARGIN_mm else None


def _arranged(front: View, right: View, above: View, oblique: View, scale: float) -> list[Placed]:
    left, bottom = LEFT_mm, _low(front, right, above, scale) or SHEET_mm[1] - MARGIN_mm
    (wide, high), (deep, tall) = _size(front), _size(right)
    beside, over = left + wide * scale + AIR_mm, bottom - high * scale - AIR_mm
    made = [Placed(front, left, bottom, scale), Placed(right, beside, bottom, scale)]
    made.append(Placed(above, left, over, scale))
    x = left + max(wide, _size(above)[0]) * scale + AIR_mm
    free = beside + deep * scale + 10 <= SHEET_mm[0] - MARGIN_mm - TITLE_mm[0]
    floor = SHEET_mm[1] - MARGIN_mm - TITLE_mm[1] if free else bottom - tall * scale
    x = max(x, beside + deep * scale + AIR_mm) if free else x
    return [*made, _filling(oblique, x, MARGIN_mm + 8, SHEET_mm[0] - MARGIN_mm - 4, floor - 8)]


def _filling(view: View, left: float, top: float, right: float, low: float) -> Placed:
    across, tall = _size(view)
    scale = min((right - left) / across, (low - top) / tall, 3.0)
    x, y = (left + right - across * scale) / 2, (top + low + tall * scale) / 2
    return Placed(view, x, y, scale)


def _lines(placed: Placed, lines: tuple[Line, ...], kind: str) -> list[str]:
    if not lines:
        return []
    paths = []
    for line in lines:
        points = " ".join("{:.2f} {:.2f}".format(*placed.at(x, y)) for x, y in line)
        paths.append(f"M{points}")
    return [f'<path class="{kind}" d="{"".join(paths)}"/>']


def _sizes(placed: Placed, width: bool, height: bool) -> list[str]:
    left, low, right, top = placed.view.box_mm
    (x0, y0), (x1, y1) = placed.at(left, low), placed.at(right, top)
    y, x = y0 + 7, x0 - 7
    across = [
        f'<path class="d" d="M{x0:.2f} {y0 + 1:.2f}V{y + 1.5:.2f}M{x1:.2f} {y0 + 1:.2f}V{y + 1.5:.2f}'
        f'M{x0:.2f} {y:.2f}H{x1:.2f}{_arrow(x0, y, 1, 0)}{_arrow(x1, y, -1, 0)}"/>',
        _text((x0 + x1) / 2, y - 0.8, _mm(right - left), "n", "middle"),
    ]
    upright = [
        f'<path class="d" d="M{x0 - 1:.2f} {y0:.2f}H{x - 1.5:.2f}M{x0 - 1:.2f} {y1:.2f}H{x - 1.5:.2f}'
        f'M{x:.2f} {y0:.2f}V{y1:.2f}{_arrow(x, y0, 0, -1)}{_arrow(x, y1, 0, 1)}"/>',
        f'<text class="n" text-anchor="middle" transform="translate({x - 0.8:.2f} {(y0 + y1) / 2:.2f})'
        f' rotate(-90)">{_mm(top - low)}</text>',
    ]
    return [*(across if width else []), *(upright if height else [])]


def _arrow(x: float, y: float, dx: int, dy: int) -> str:
    a, b = (
        (x + 1.6 * dx + 0.5 * dy, y + 1.6 * dy + 0.5 * dx),
        (x + 1.6 * dx - 0.5 * dy, y + 1.6 * dy - 0.5 * dx),
    )
    return f"M{a[0]:.2f} {a[1]:.2f}L{x:.2f} {y:.2f}L{b[0]:.2f} {b[1]:.2f}"


def _rounds(placed: Placed) -> list[str]:
    circles = placed.view.circles
    _, low, right, top = placed.view.box_mm
    (edge, y0), (_, y1) = placed.at(right, low), placed.at(right, top)
    ends = [(placed.at(*max(circle.centres_mm)), circle) for circle in circles]
    ends.sort(key=lambda end: end[0][1])
    made: list[str] = []
    ty = min(y0, y1)
    for (x, y), circle in ends:
        count = f"{len(circle.centres_mm)}× " if len(circle.centres_mm) > 1 else ""
        radius = circle.diameter_mm / 2 * placed.scale
        tx, ty = edge + 4, max(y, ty + 4.0)
        made.append(f'<path class="c" d="M{x + 0.707 * radius:.2f} {y:.2f}L{tx:.2f} {ty:.2f}h1"/>')
        made.append(_text(tx + 1.4, ty + 1, f"{count}ø{_mm(circle.diameter_mm)}", "m"))
    return made


def _frame() -> list[str]:
    width, height = (size - 2 * MARGIN_mm for size in SHEET_mm)
    return [f'<rect class="f" x="{MARGIN_mm:g}" y="{MARGIN_mm:g}" width="{width:g}" height="{height:g}"/>']


def _title(part: Part, d: Dimensions, scale: float) -> list[str]:
    width, height = TITLE_mm
    x, y = SHEET_mm[0] - MARGIN_mm - width, SHEET_mm[1] - MARGIN_mm - height
    ratio = f"{scale:g} : 1" if scale >= 1 else f"1 : {1 / scale:g}"
    made = [
        f'<rect class="f" x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" fill="white"/>',
        _text(x + 4, y + 7.5, part.title, "b"),
        _text(x + width - 4, y + 6.5, f"scale {ratio}   mm", "", "end"),
        _text(
            x + 4, y + 13, f"fdvv button simulator · {part.name} · {part.count} needed · {part.material}", ""
        ),
        _text(x + 4, y + 17.5, f"prints {part.lies}; drawn as it lies", "q"),
        f'<path class="t" d="M{x:g} {y + 20:g}h{width:g}"/>',
    ]
    for i, name in enumerate(part.drawn):
        at = y + 24.5 + 4.2 * i
        made.append(_text(x + 4, at, f"{name} = {getattr(d, name):g}", ""))
        made.append(_text(x + 49, at, f"{meaning_of(name)} ({source_of(name)})", "q"))
    made.append(_text(x + 4, y + height - 2, f"dimensions {d.digest()}", "q"))
    return made


def _text(x: float, y: float, text: str, kind: str, anchor: str = "start") -> str:
    style = f' class="{kind}"' if kind else ""
    return f'<text{style} x="{x:.2f}" y="{y:.2f}" text-anchor="{anchor}">{escape(text)}</text>'


def _mm(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".")
