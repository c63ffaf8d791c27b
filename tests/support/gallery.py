"""One of every figure, and what holds for all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import matplotlib
import matplotlib.pyplot as plt

from fdvv.report.svg import figure_of, figure_svg

UNITS = ("(mm)", "(cN)", "(mm/s)", "(s)", "(ms)", "(m/s²)", "(count)", "(no unit, lower is better)")


class Gallery:
    """Figures by name, drawn once where that is enough. draw : called with whether the data is simulated."""

    def __init__(self, figures: Mapping[str, Callable[[bool], Any]]) -> None:
        self.draws = figures
        self.figures: dict[str, Any] = {}
        self.svgs: dict[str, str] = {}

    def draw(self, name: str, said: bool = False) -> Any:
        return figure_of(self.draws[name](said))

    def figure(self, name: str) -> Any:
        if name not in self.figures:
            self.figures[name] = self.draw(name)
        return self.figures[name]

    def svg(self, name: str) -> str:
        if name not in self.svgs:
            self.svgs[name] = figure_svg(self.figure(name))
        return self.svgs[name]

    @staticmethod
    def texts(drawn: Any) -> str:
        """Join everything that a figure writes."""
        from matplotlib.text import Text

        return "\n".join(text.get_text() for text in figure_of(drawn).findobj(Text))


class FigureRules:
    """Tests of every figure of a gallery; a subclass has the fixtures `gallery` and `name`."""

    def test_every_axis_of_every_figure_names_its_unit(self, gallery: Gallery, name: str) -> None:
        labels = []
        for ax in gallery.figure(name).axes:
            labels += [ax.get_xlabel(), ax.get_ylabel(), getattr(ax, "get_zlabel", str)()]
        written = [label for label in labels if label]
        assert len(written) >= 2
        assert all(label.endswith(UNITS) for label in written), written

    def test_a_figure_of_simulated_data_says_so_and_one_of_measured_data_does_not(
        self, gallery: Gallery, name: str
    ) -> None:
        assert "simulated" in gallery.texts(gallery.draw(name, said=True)).splitlines()
        assert "simulated" not in gallery.texts(gallery.figure(name))

    def test_the_same_data_gives_the_same_bytes(self, gallery: Gallery, name: str) -> None:
        assert figure_svg(gallery.draw(name)) == gallery.svg(name)

    def test_drawing_leaves_no_open_figure_and_no_changed_setting(self, gallery: Gallery, name: str) -> None:
        before = dict(matplotlib.rcParams)
        gallery.draw(name)
        gallery.svg(name)
        assert plt.get_fignums() == []
        assert dict(matplotlib.rcParams) == before

    def test_nothing_is_cut_off_at_the_edges(self, gallery: Gallery, name: str) -> None:
        gallery.svg(name)
        figure = gallery.figure(name)
        box, page = figure.get_tightbbox(), figure.bbox_inches
        assert box.x0 >= page.x0 - 0.03
        assert box.y0 >= page.y0 - 0.03
        assert box.x1 <= page.x1 + 0.03
        assert box.y1 <= page.y1 + 0.03
