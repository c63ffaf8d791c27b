import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv.report.model_figures import plot_vibration
from fdvv.report.report import Headline, Section, Table, render_html, write_report
from fdvv.report.svg import figure_svg

VOID = {"meta", "link", "br", "img", "hr", "input"}
HOSTILE = """<script>alert('x')</script>"><img src=x onerror=alert(1)> & {title} {0} </style>"""


class Page(HTMLParser):
    """Reads a page and holds it to balanced tags."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def attributes(self, name: str) -> list[str]:
        return [attrs[name] or "" for _, attrs in self.tags if name in attrs]

    def count(self, tag: str) -> int:
        return sum(name == tag for name, _ in self.tags)


@pytest.fixture(scope="module")
def html(gallery: Any, names: list[str]) -> str:
    table = Table(
        ("curve", "mean (cN)", "note"), (("press", "1.5", "ok"), ("release", "−2 cN", "")), "Errors"
    )
    sections = [Section(name, (f"Words on {name}.",), (gallery.svg(name),) * 2, (table,)) for name in names]
    return render_html("A button", "What was found.", sections, "fdvv", simulated="the twin, seed 1")


def test_a_report_with_every_figure_has_balanced_tags(html: str, names: list[str]) -> None:
    page = Page(html)
    assert page.count("svg") == 2 * len(names)
    assert page.count("table") == len(names)
    assert [name for name, _ in page.tags[:2]] == ["html", "head"]


def test_a_report_fetches_nothing_and_runs_nothing(html: str) -> None:
    page = Page(html)
    links = page.attributes("href") + page.attributes("xlink:href") + page.attributes("src")
    assert all(link.startswith("#") for link in links)
    assert not {"script", "link", "img", "iframe", "object", "embed"} & {name for name, _ in page.tags}
    assert "@import" not in html
    assert all(target.startswith("#") for target in re.findall(r"url\(([^)]*)\)", html))


def test_no_two_elements_of_a_report_share_an_id_and_every_use_has_its_element(html: str) -> None:
    page = Page(html)
    ids = page.attributes("id")
    assert len(ids) == len(set(ids))
    uses = {link.removeprefix("#") for link in page.attributes("xlink:href")}
    uses |= set(re.findall(r"url\(#([^)]+)\)", html)) | set(page.attributes("aria-labelledby"))
    assert uses <= set(ids)


def test_figures_have_names_and_table_headings_their_scope(html: str) -> None:
    page = Page(html)
    for name, attrs in page.tags:
        if name == "svg":
            assert attrs["role"] == "img"
            assert attrs["aria-labelledby"]
        if name == "th":
            assert attrs["scope"] in ("col", "row")
    assert page.count("title") == 1 + page.count("svg")


def test_numbers_stand_at_the_right_and_words_at_the_left(html: str) -> None:
    assert '<th scope="col" class="number">mean (cN)</th>' in html
    assert '<td class="number">−2 cN</td>' in html
    assert '<th scope="row">press</th>' in html
    assert "<td>ok</td>" in html


def test_a_column_with_gaps_is_still_one_of_numbers_and_an_empty_one_is_not() -> None:
    table = Table(("a", "b", "c"), (("x", "1", ""), ("y", "–", ""), ("z", "2.5 %", "")))
    html = render_html("t", "", [Section("s", tables=(table, Table(("d",), ())))])
    assert '<td class="number">–</td>' in html
    assert '<th scope="col">c</th>' in html
    assert '<th scope="col">d</th>' in html


def test_the_banner_stands_only_over_simulated_numbers(html: str) -> None:
    assert "Simulated: the twin, seed 1" in Page(html).text
    assert "Simulated" not in Page(render_html("t", "s", [])).text


def test_hostile_text_stays_text_wherever_it_is_put(model: FDVVModel) -> None:
    figure = figure_svg(plot_vibration(model.renamed(HOSTILE)), HOSTILE)
    table = Table((HOSTILE,), ((HOSTILE,),), HOSTILE)
    sections = [Section(HOSTILE, (HOSTILE,), (figure,), (table,))]
    page = Page(render_html(HOSTILE, HOSTILE, sections, HOSTILE, simulated=HOSTILE))
    assert page.count("script") == page.count("img") == 0
    assert page.attributes("onerror") == []
    # document title, heading, banner, summary, section, paragraph, figure, caption, two cells, footer
    assert page.text.count(HOSTILE) == 11


@settings(max_examples=50, deadline=None)
@given(st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=40))
def test_any_text_comes_back_as_it_went_in(text: str) -> None:
    page = Page(render_html(text, text, [Section(text, (text,))]))
    assert page.text.count(text) >= 4
    assert page.count("section") == 1


def test_a_row_of_another_length_than_the_headings_is_refused() -> None:
    with pytest.raises(ModelError, match="row 1 has 1 cells, the table 2 columns"):
        Table(("a", "b"), (("1", "2"), ("3",)))


def test_a_figure_that_is_no_svg_element_is_refused() -> None:
    with pytest.raises(ModelError, match="svg element"):
        Section("s", (), ("<p>no figure</p>",))


def test_a_report_is_written_whole(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "report.html"
    write_report(path, render_html("é", "µ", []))
    assert "<h1>é</h1>" in path.read_text(encoding="utf-8")
    assert list(path.parent.iterdir()) == [path]


SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><title>one</title></svg>'


def test_one_of_several_figures_is_chosen_without_a_script() -> None:
    choices = (("50 mm/s", SVG), ("100 mm/s", SVG))
    html = render_html("title", "", [Section("Speeds", choices=choices)])
    assert "<script" not in html
    assert html.count('type="radio"') == 2
    assert html.count(" checked>") == 1
    assert html.count("<figure>") == 2


def test_more_choices_than_the_style_sheet_counts_are_refused() -> None:
    with pytest.raises(ModelError, match="at most 8"):
        Section("Speeds", choices=tuple((str(i), SVG) for i in range(9)))


def test_a_folded_section_keeps_its_heading_in_view() -> None:
    html = render_html("title", "", [Section("Detail", ("text",), folded=True)])
    assert re.search(r"<details>\s*<summary><h2[^>]*>Detail</h2></summary>\s*<p>text</p>\s*</details>", html)


def test_headlines_come_before_the_summary_and_are_escaped() -> None:
    html = render_html("title", "the summary", [], headlines=[Headline("9 → 1 cN", "mean <error>")])
    assert html.index("9 → 1 cN") < html.index("the summary")
    assert "mean &lt;error&gt;" in html
