import os
import subprocess
import sys
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from fdvv.model.model import FDVVModel
from fdvv.report import style
from fdvv.report.model_figures import plot_comparison
from fdvv.report.svg import figure_svg
from tests.support.gallery import FigureRules


class TestEveryFigure(FigureRules):
    """The figures of buttons and renderings."""


def test_another_process_with_other_hashes_gives_the_same_bytes(gallery: Any) -> None:
    code = (
        "import sys\nfrom fdvv import load_builtin\n"
        "from fdvv.report.svg import figure_svg\n"
        "from fdvv.report.model_figures import plot_vibration\n"
        "sys.stdout.buffer.write(figure_svg(plot_vibration(load_builtin('mx-clear'))).encode())"
    )
    other = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        check=True,
        env=os.environ | {"PYTHONHASHSEED": "7"},
    )
    assert other.stdout.decode() == gallery.svg("vibration")


def test_a_users_own_settings_do_not_reach_the_figures(gallery: Any) -> None:
    with matplotlib.rc_context({"font.size": 30.0, "axes.grid": False, "lines.linestyle": ":"}):
        assert figure_svg(gallery.draw("vibration")) == gallery.svg("vibration")


def test_faster_is_darker_in_steps_an_eye_can_tell() -> None:
    colours = style.velocity_colours([200.0, 0.5, 50.0, None, 100.0, 0.5])
    assert list(colours) == [None, 0.5, 50.0, 100.0, 200.0]
    # relative luminance of the sRGB colour space
    linear = [np.array(to_rgb(c)) ** 2.2 @ [0.2126, 0.7152, 0.0722] for c in colours.values()]
    assert np.all(np.diff(linear) < -0.02)


def test_text_contrasts_with_white() -> None:
    for colour in (style.INK, "#b42318"):
        luminance = np.array(to_rgb(colour)) ** 2.2 @ [0.2126, 0.7152, 0.0722]
        assert 1.05 / (luminance + 0.05) > 4.5


@pytest.mark.parametrize(
    ("foreign", "drawn"),
    [
        ("plain", "plain"),
        ("_hidden", " _hidden"),
        ("two\nlines\tand\x00more", "two lines and more"),
        ("x" * 99, "x" * (style.LONGEST_NAME - 1) + "…"),
    ],
)
def test_a_foreign_name_is_drawn_on_one_short_line(foreign: str, drawn: str) -> None:
    assert style.name_text(foreign) == drawn


def test_hostile_names_are_drawn_as_they_stand(gallery: Any, model: FDVVModel) -> None:
    names = ["a $x_1$ b", r"$\frac", "<script>& -- -->", "_x", "樱桃 MX", "\U0001f600"]
    ax = plot_comparison([model.renamed(name) for name in names])
    assert all(name in gallery.texts(ax) for name in names)
    svg = figure_svg(ax, " ".join(names))
    assert "<script" not in svg
    assert "<!--" not in svg


def test_without_matplotlib_the_error_tells_how_to_get_it() -> None:
    code = (
        "import sys\nsys.modules['matplotlib'] = None\n"
        "from fdvv.errors import BuildError\nfrom fdvv import load_builtin\n"
        "from fdvv.report.report import Section, render_html\n"
        "from fdvv.report.model_figures import plot_model\n"
        "assert 'words' in render_html('t', 'words', [Section('s')])\n"
        "try:\n    plot_model(load_builtin('mx-clear'))\nexcept BuildError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip().endswith('pip install "fdvv[plot]"')
    assert len(done.stdout.splitlines()) == 1
