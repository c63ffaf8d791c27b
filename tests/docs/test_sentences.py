from __future__ import annotations

import pytest
from tools.check_sentences import MOST_WORDS, found, sentences

LONG = " ".join(["word"] * (MOST_WORDS + 1))
SHORT = " ".join(["word"] * MOST_WORDS)


def lines(text: str) -> list[tuple[int, int]]:
    return [(line, count) for line, count, _ in found(text)]


def test_a_sentence_of_one_word_too_many_is_found_with_its_line() -> None:
    assert lines(f"# Title\n\n{SHORT}. {SHORT}!\n\nA {SHORT}\nand on.\n") == [(5, MOST_WORDS + 3)]


def test_code_is_left_out_and_within_a_line_it_is_one_word() -> None:
    assert lines(f"```text\n{LONG}\n```\n\n    \n") == []
    assert lines(f"A formula:\n\n    {LONG}\n    {LONG}\n\n{LONG}\n") == [(6, MOST_WORDS + 1)]
    assert lines(f"Run `{LONG}` now.") == []


def test_a_link_counts_by_its_text() -> None:
    assert lines(f"[{LONG}](page.md)") == [(1, MOST_WORDS + 1)]
    assert sentences("See [the page](a.md#b c).") == ["See the page."]


def test_each_cell_of_a_table_and_each_item_of_a_list_is_text_of_its_own() -> None:
    assert lines(f"| {SHORT} | {SHORT} |\n|---|---|\n| a | {LONG} |\n") == [(3, MOST_WORDS + 1)]
    assert lines(f"- {SHORT}\n- {SHORT}\n1. {LONG}\n") == [(3, MOST_WORDS + 1)]
    assert lines(f"- {SHORT}\n\n    - {LONG}\n      and on\n") == [(3, MOST_WORDS + 3)]


@pytest.mark.parametrize("text", ["1.5 mm of b", "e.g. this", "Hussain et al. 1999"])
def test_points_within_a_sentence_do_not_end_it(text: str) -> None:
    assert len(sentences(text)) == 1


def test_a_sentence_ends_before_a_quote_a_digit_and_a_link() -> None:
    assert len(sentences("It ends. 5 mm follow. `code` too. (In brackets.) [Link](x.md) **Bold.** End")) == 6
