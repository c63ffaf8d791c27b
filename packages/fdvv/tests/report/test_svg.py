import re
import struct
import xml.etree.ElementTree as ET
from typing import Any

import pytest

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv.report.model_figures import plot_model, plot_vibration
from fdvv.report.svg import figure_png, figure_svg, prefix_ids

SVG = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"


@pytest.fixture(scope="module")
def svg(gallery: Any) -> str:
    return str(gallery.svg("model"))


def test_a_figure_carries_no_date_comment_style_sheet_or_script(svg: str) -> None:
    for piece in ("<!--", "<!DOCTYPE", "<?xml", "<style", "<script", "<metadata", "dc:date"):
        assert piece not in svg


def test_a_figure_points_only_into_itself(svg: str) -> None:
    root = ET.fromstring(svg)
    uses = {e.attrib[LINK].removeprefix("#") for e in root.iter() if LINK in e.attrib}
    uses |= set(re.findall(r"url\(#([^)]+)\)", svg)) | {root.attrib["aria-labelledby"]}
    assert uses
    assert uses <= {e.attrib["id"] for e in root.iter() if "id" in e.attrib}


def test_a_figure_tells_what_it_shows_to_those_who_cannot_see(model: FDVVModel, svg: str) -> None:
    root = ET.fromstring(svg)
    assert root.attrib["role"] == "img"
    title = root.find(f"{SVG}title")
    assert title is not None
    assert title.text == "mx-clear"
    hostile = ET.fromstring(figure_svg(plot_vibration(model), 'a <b> & "c"\x00'))
    assert hostile.findtext(f"{SVG}title") == 'a <b> & "c" '


def test_a_description_that_looks_like_markup_is_not_renamed(model: FDVVModel) -> None:
    svg = figure_svg(plot_vibration(model), 'see id="x" and url(#y)')
    root = ET.fromstring(prefix_ids(svg, "p-"))
    assert root.findtext(f"{SVG}title") == 'see id="x" and url(#y)'


def test_a_png_has_the_size_asked_for_and_the_same_bytes_each_time(model: FDVVModel) -> None:
    content = figure_png(plot_vibration(model), dpi=50.0)
    width, height = struct.unpack(">II", content[16:24])
    assert (width, height) == (350, 170)
    assert content == figure_png(plot_vibration(model), dpi=50.0)
    assert b"matplotlib" not in content


def test_axes_that_left_their_figure_have_no_picture(model: FDVVModel) -> None:
    ax = plot_model(model)
    ax.remove()
    with pytest.raises(ModelError, match="taken off"):
        figure_svg(ax)
