"""One look for every figure: colours, fonts, labels, and files whose bytes depend on the data alone.

Figures are made without pyplot, so nothing is registered, nothing needs closing and no window opens.
"""

from __future__ import annotations

import functools
import textwrap
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np

from fdvv.errors import BuildError
from fdvv.force_text import force_unit, in_cN
from fdvv.model.curve import Stroke

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

P = ParamSpec("P")
R = TypeVar("R")

DISPLACEMENT = "displacement (mm)"
FORCE = "force (cN)"
VELOCITY = "velocity (mm/s)"

INK = "#1f2933"
QUIET = "#7b8794"
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#8c6d31")
"""Categories that a colour-blind reader can tell apart (after Okabe and Ito, yellow left out on white)."""

LINE = {Stroke.PRESS: "-", Stroke.RELEASE: "--"}

BAND = 0.2
"""Opacity of bands: two that overlap can still be seen apart."""

LONGEST_NAME = 36
"""Names come from foreign files; a longer one would push the axes off the page."""

STYLE: Any = {
    # matplotlib ships this font: the same shapes on every machine
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    # a dollar sign in the name of a switch is not mathematics
    "text.parse_math": False,
    "text.color": INK,
    "axes.titlesize": 11.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelcolor": INK,
    "axes.edgecolor": QUIET,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e7eb",
    "grid.linewidth": 0.8,
    "xtick.color": INK,
    "ytick.color": INK,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


def require_matplotlib() -> None:
    """Raise BuildError that tells how to get matplotlib, unless it is there."""
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise BuildError('figures need matplotlib; install it with: pip install "fdvv[plot]"') from error


@contextmanager
def house_style(**more: Any) -> Iterator[None]:
    """Draw in the house style inside, whatever the user's own matplotlib settings; then put those back.

    more : further settings, dots written as double underscores. Raises BuildError without matplotlib.
    """
    require_matplotlib()
    import matplotlib

    extra: Any = {name.replace("__", "."): value for name, value in more.items()}
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE | extra)
        yield


def in_house_style(draw: Callable[P, R]) -> Callable[P, R]:
    """Make a function draw in the house style; it raises BuildError where matplotlib is absent."""

    @functools.wraps(draw)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> R:
        with house_style():
            return draw(*args, **kwargs)

    return wrapper


@in_house_style
def new_figure(width_in: float = 7.0, height_in: float = 4.2) -> Figure:
    """Make an empty figure that lays itself out around labels and legends."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width_in, height_in), layout="constrained")


def axes_or_new(ax: Axes | None, width_in: float = 7.0, height_in: float = 4.2) -> Axes:
    return new_figure(width_in, height_in).add_subplot() if ax is None else ax


def velocity_colour(part: float) -> tuple[float, float, float]:
    """Return the colour of a velocity, part 0 (slowest, light) to 1 (fastest, dark).

    The map is viridis without its palest third: lightness falls evenly and it survives colour blindness.
    """
    from matplotlib import colormaps

    red, green, blue, _ = colormaps["viridis"](0.72 * (1.0 - part))
    return float(red), float(green), float(blue)


def velocity_colours(
    velocities_mm_s: Iterable[float | None],
) -> dict[float | None, tuple[float, float, float]]:
    """Return a colour for each distinct velocity by rank; an unknown velocity ranks as the slowest."""
    ranked = sorted(set(velocities_mm_s), key=lambda v: v or 0.0)
    last = max(len(ranked) - 1, 1)
    return {v: velocity_colour(i / last if len(ranked) > 1 else 0.6) for i, v in enumerate(ranked)}


def velocity_text(velocity_mm_s: float | None) -> str:
    return "speed unknown" if velocity_mm_s is None else f"{velocity_mm_s:g} mm/s"


def name_text(name: str) -> str:
    """Make a name from a foreign file fit to be drawn: one line, no control characters, not too long."""
    clean = " ".join("".join(c if c.isprintable() else " " for c in name).split())
    short = clean if len(clean) <= LONGEST_NAME else f"{clean[: LONGEST_NAME - 1]}…"
    # matplotlib hides legend entries that begin with an underscore
    return f" {short}" if short.startswith("_") else short


def wrap(text: str, width: int = 30) -> str:
    return "\n".join(textwrap.wrap(text, width))


def set_titles(ax: Axes, title: str, simulated: bool) -> None:
    """Write the title at the left and, for data that no hardware produced, "simulated" at the right."""
    ax.set_title(title, loc="left")
    if simulated:
        ax.set_title("simulated", loc="right", fontstyle="italic", fontweight="normal", color="#b42318")


def show_force_unit(fig: Figure) -> None:
    """Label axes of force in the unit shown: they hold cN, and say so in their label."""
    unit = force_unit()
    if unit == "cN":
        return
    label = ""
    for ax in fig.axes:
        # of a row of axes only the first is labelled
        label = ax.get_ylabel() or label
        ax.set_ylabel(ax.get_ylabel().replace("(cN)", f"({unit})"))
        axes = [ax.yaxis] if "(cN)" in label else []
        if "(cN)" in getattr(ax, "get_zlabel", str)():
            axes.append(ax.zaxis)  # type: ignore[attr-defined]
            ax.set_zlabel(ax.get_zlabel().replace("(cN)", f"({unit})"))  # type: ignore[attr-defined]
        for axis in axes:
            _scale(axis, in_cN(unit))


def _scale(axis: Any, unit: float) -> None:
    """Set round ticks in a unit of so many cN."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

    log = axis.get_scale() == "log"
    base = LogLocator(subs=(1.0, 2.0, 5.0)) if log else MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
    low, high = sorted(axis.get_view_interval())
    ticks = np.array([unit * tick for tick in base.tick_values(low / unit, high / unit)])
    axis.set_ticks(ticks[(ticks >= low) & (ticks <= high)])
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / unit:.4g}".replace("-", "−")))
    axis.set_minor_formatter(NullFormatter())


def handle(label: str, **look: Any) -> Line2D:
    """Make a legend entry that stands for a look rather than for one curve."""
    from matplotlib.lines import Line2D

    return Line2D([], [], **({"color": QUIET} | look), label=label)


def draw_band(ax: Axes, x: Any, middle: Any, half: Any, colour: Any) -> None:
    """Draw a band of one standard deviation on either side of a curve, below every line."""
    ax.fill_between(x, middle - half, middle + half, color=colour, alpha=BAND, linewidth=0.0, zorder=1.5)


def band_handles(presses: Iterable[int]) -> list[Patch]:
    """Make the legend entry of bands: what they are and of how many presses; none where there are none."""
    from matplotlib.patches import Patch

    counts = sorted(set(presses))
    if not counts:
        return []
    n = f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
    return [Patch(facecolor=QUIET, alpha=2 * BAND, label=f"mean ± 1 SD,\nn = {n} presses")]


def stroke_handles(strokes: Iterable[Stroke]) -> list[Line2D]:
    """Make the legend entries that tell press (solid) from release (dashed)."""
    present = set(strokes)
    return [handle(str(stroke), linestyle=LINE[stroke]) for stroke in Stroke if stroke in present]


def legend_beside(ax: Axes, handles: Sequence[Line2D | Patch]) -> None:
    """Put the legend at the right of the axes, where it hides no curve; two columns if it is long."""
    labels = [str(item.get_label()) for item in handles]
    columns = 1 + (len(labels) - 1) // 22
    beside = (1.01, 1.0)
    ax.legend(
        list[Any](handles), labels, ncols=columns, loc="upper left", bbox_to_anchor=beside, borderaxespad=0.0
    )


def limits_around(*columns: Any, margin: float = 0.05) -> tuple[float, float]:
    """Return limits that hold every finite value of the columns with a margin, never of no length."""
    values = np.concatenate([np.ravel(np.asarray(column, dtype=np.float64)) for column in columns])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    room = margin * (high - low) or 0.5
    return low - room, high + room
