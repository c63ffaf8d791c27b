"""The page that is handed on: what it says, what it holds, and that it needs nothing else."""

from __future__ import annotations

import base64
import re
from dataclasses import replace

import pytest

from fdvv.button.page import buttons_page, difference_sentences
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin, model_from_json
from fdvv.model.jnd_file import jnds_of
from fdvv.model.noticeable import LITERATURE
from tests.support.buttons import line_model
from tests.support.jnds import as_literature, record_of

MODELS = [load_builtin(name) for name in ("mx-red", "mx-clear", "mx-blue")]


def test_a_page_of_one_button_shows_every_speed_and_says_what_it_is() -> None:
    html = buttons_page([load_builtin("mx-clear")])
    assert "Tactile: the press falls by 13.3 cN at 1.45 mm." in html
    assert html.count("<path d=") >= 10
    for speed in ("0.5", "50", "100", "150", "200"):
        assert f">{speed} mm/s</text>" in html


def test_a_comparison_has_one_sentence_for_each_button_but_the_first() -> None:
    sentences = list(difference_sentences(MODELS))
    assert [sentence.split()[0] for sentence in sentences] == ["mx-clear", "mx-blue"]
    html = buttons_page(MODELS)
    assert all(sentence in html for sentence in sentences)


def test_a_button_is_hardly_felt_apart_from_itself() -> None:
    (sentence,) = difference_sentences([MODELS[0], replace(MODELS[0], name="again")])
    assert sentence.startswith("again can hardly be felt apart from mx-red: about 0.0 ")


def test_twice_the_force_feels_clearly_different() -> None:
    (sentence,) = difference_sentences([line_model("light", 30), line_model("heavy", 60)])
    assert "feels clearly different" in sentence
    assert "most of it in the force" in sentence


def test_what_is_noticed_depends_on_whose_jnds_count_and_the_page_says_whose() -> None:
    pair = [line_model("light", 45), line_model("heavy", 60)]
    dull = jnds_of(record_of(as_literature("force", 4.0), simulated=True))
    (sharp_sentence,), (dull_sentence,) = (
        list(difference_sentences(pair, one)) for one in (LITERATURE, dull)
    )
    assert "heavy feels close to light" in sharp_sentence
    assert "heavy can hardly be felt apart from light" in dull_sentence
    assert "Counted in JNDs from the literature" in buttons_page(pair)
    assert "Counted in JNDs of force of 12 people of study weights (simulated)" in buttons_page(
        pair, jnds=dull
    )


def test_the_models_can_be_saved_from_the_page_as_they_are() -> None:
    found = re.findall(
        r'href="data:application/json;base64,([^"]+)" download="([^"]+)"', buttons_page(MODELS)
    )
    assert [name for _, name in found] == [f"{model.name}.fdvv.json" for model in MODELS]
    for (text, _), model in zip(found, MODELS, strict=True):
        assert model_from_json(base64.b64decode(text)).curves == model.curves


def test_the_page_fetches_and_runs_nothing() -> None:
    html = buttons_page(MODELS)
    assert "<script" not in html
    assert not re.search(r'(?:src|href)="(?!data:|#)', html)


def test_a_name_cannot_become_markup() -> None:
    html = buttons_page([replace(MODELS[0], name="<img src=x onerror=alert(1)>")])
    assert "<img" not in html


def test_what_was_simulated_is_marked() -> None:
    model = MODELS[1]
    made = replace(model, provenance=replace(model.provenance, simulated=True))
    assert "Simulated:" in buttons_page([made])
    assert "Simulated:" not in buttons_page([model])


@pytest.mark.parametrize("count", [0, 7])
def test_a_page_has_one_to_six_buttons(count: int) -> None:
    with pytest.raises(ModelError, match="1 to 6 buttons"):
        buttons_page([MODELS[0]] * count)
