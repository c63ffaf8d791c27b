from __future__ import annotations

import re
from dataclasses import replace
from html import unescape

import pytest

from fdvv_people.study.analysis.analyse import analyse
from fdvv_people.study.analysis.report import study_html, study_summary
from fdvv_people.study.analysis.sentences import (
    button_sentence,
    choice_sentence,
    claim_sentence,
    ratings_sentence,
    scale_sentence,
    timing_sentences,
)
from fdvv_people.study.analysis.words import exact_p, fixed, listing, many, percent, short_p, span
from fdvv_people.study.plan.plan_file import read_plan_text, template_text
from tests.support.study_answers import BROKEN, EVERY_KIND, all_ties, paper_like, realism, timing

PROXY = "simulated participants: a proxy, no evidence"


def plain(text: str) -> str:
    """Return text with ordinary spaces and minus signs, as a person would search it."""
    return text.replace("\N{NO-BREAK SPACE}", " ").replace("\N{MINUS SIGN}", "-")


def words_of(html: str) -> str:
    """Return what a page says: no markup, no figures."""
    text = re.sub(r"<svg.*?</svg>|<style.*?</style>|<[^>]+>", " ", html, flags=re.DOTALL)
    return plain(" ".join(unescape(text).split()))


def test_the_papers_numbers_are_printed_as_the_paper_prints_them_with_the_exact_p_beside() -> None:
    found = analyse(paper_like(), title="Realism")
    texts = [plain(button_sentence(one)) for one in found.tests]
    assert len(texts) == 6
    assert all("Z = -3.06, p = .002, exact p = .0005, r = 1.00; 12 people" in one for one in texts)
    chosen = plain(study_summary(found))
    assert "Of 432 answers, 334 (77.31 %; 95 % interval" in chosen
    assert "people counted as people) chose FDVV, 98 chose FD." in chosen
    assert "FDVV is rated higher than FD for every button" in plain(ratings_sentence(found.tests))


@pytest.mark.slow
def test_a_page_is_whole_and_its_figures_are_in_it() -> None:
    html = study_html(analyse(paper_like(), title="Realism"))
    assert words_of(html).count("Z = -3.06, p = .002, exact p = .0005, r = 1.00; 12 people") == 6
    assert html.count("<svg") == 4
    assert "nan" not in words_of(html).lower().split()
    assert "None" not in words_of(html)
    assert "simulated" not in html


@pytest.mark.slow
def test_simulated_participants_are_marked_in_title_text_tables_and_every_figure() -> None:
    found = analyse(replace(EVERY_KIND["realism"], simulated=True), title="Try")
    html = study_html(found)
    assert f"<title>Try ({PROXY})</title>" in html
    text = words_of(html)
    assert "No person took part" in text
    captions = re.findall(r"<caption>(.*?)</caption>", html)
    assert captions
    assert all(one.startswith("Simulated.") for one in captions)
    figures = html.count("<svg")
    labels = re.findall(r"<svg[^>]*>\s*<title[^>]*>(.*?)</title>|aria-label=\"(.*?)\"", html)
    assert figures == 4
    assert len(labels) >= figures
    assert text.count("Simulated. ") > figures


@pytest.mark.slow
def test_the_claim_of_a_plan_is_called_registered() -> None:
    plan = read_plan_text(template_text("realism"), "realism.toml")
    assert plan.claim is not None
    found = analyse(EVERY_KIND["realism"], plan)
    assert found.claim is not None
    assert "stated before the first person" in claim_sentence(found.claim)
    assert "not registered beforehand" in study_summary(analyse(EVERY_KIND["realism"]))


def test_ratings_that_do_not_differ_are_reported_as_such() -> None:
    (first, *_) = analyse(all_ties()).tests
    assert plain(button_sentence(first)) == (
        "For Clear, all 8 people rated FDVV (mdn 4.00, mean 4.00, SD 0.00) and FD alike."
    )
    (one,) = analyse(realism(1, 2, ("Clear",))).tests
    assert "the one person rated FDVV" in button_sentence(one)


def test_a_claim_that_is_opposed_is_reported_as_opposed() -> None:
    found = analyse(realism(7, 2, ("Clear",), lean=-2.0))
    assert found.claim is not None
    assert "The answers say the opposite" in claim_sentence(found.claim)
    assert "significantly lower than" in button_sentence(found.tests[0])
    assert "is rated lower than" in ratings_sentence(found.tests)


def test_a_claim_that_is_not_settled_is_no_proof_of_nothing() -> None:
    found = analyse(realism(7, 2, ("Clear",), lean=0.0, seed=2))
    assert found.claim is not None
    assert "no proof that there is no difference" in claim_sentence(found.claim)


def test_all_ties_point_nowhere() -> None:
    found = analyse(all_ties())
    assert found.claim is not None
    assert "neither support it nor speak against it" in claim_sentence(found.claim)
    assert found.preference is not None
    assert "0 chose FD and 16 said equal" not in choice_sentence(found.preference)
    assert "32 said equal" in plain(choice_sentence(found.preference))


@pytest.mark.slow
def test_ordered_categories_and_timing_are_described_in_words() -> None:
    (scale,) = analyse(EVERY_KIND["realism"]).scales
    assert "Taken as ordered categories over all buttons" in scale_sentence(scale)
    found = analyse(timing()).timing
    assert found is not None
    assert plain(timing_sentences(found)[0]).startswith(
        "Asynchrony (ms) of 8 people: The main effect of button"
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", [*EVERY_KIND, *BROKEN])
def test_every_kind_and_whatever_is_broken_makes_a_page(name: str) -> None:
    answers = (EVERY_KIND | BROKEN)[name]
    text = words_of(study_html(analyse(answers, title=name)))
    assert "How this was computed" in text or "nothing is tested" in text
    assert " nan" not in text
    assert "None" not in text
    assert "1 people" not in text


def test_numbers_are_written_as_result_sections_write_them() -> None:
    assert [exact_p(p) for p in (1.0, 0.0022, 0.000488, 0.00001)] == [
        "p = 1.000", "p = .002", "p = .0005", "p < .0001"
    ]  # fmt: skip
    assert [short_p(p) for p in (0.0022, 0.00001, None)] == [".002", "< .0001", "–"]
    assert [plain(fixed(v)) for v in (-3.059, -0.001, float("inf"), float("nan"))] == [
        "-3.06",
        "0.00",
        "∞",
        "–",
    ]
    assert plain(percent(334 / 432)) == "77.31 %"
    assert plain(span(-1.0, 2.0)) == "[-1.00, 2.00]"
    assert span(None, 1.0) == ""
    assert [plain(many(n, "person", "people")) for n in (1, 2)] == ["1 person", "2 people"]
    assert listing([f"P{n}" for n in range(10)], 2) == "P0, P1 and 8 more"
