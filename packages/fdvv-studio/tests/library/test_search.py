"""Searching: against a search that looks at every row in turn; typos; likeness."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.button.kind import ButtonType
from fdvv.button.like import LikeTable, distances
from fdvv.errors import InputError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.jnd_file import jnds_of
from fdvv.model.noticeable import LITERATURE, Dimension
from fdvv.units import FloatArray
from fdvv_studio.library.catalog import source_files
from fdvv_studio.library.figures import row_of_file
from fdvv_studio.library.row import NUMBERS as SHELF_NUMBERS
from fdvv_studio.library.row import ButtonRow, Origin
from fdvv_studio.library.search import CatalogSearch, SearchQuery
from tests.support.catalog_rows import bumped, button, dome, row, spring
from tests.support.jnds import as_literature, record_of

NAMES = ("Cherry MX Clear", "Cherry MX Blue", "Gateron Yellow Pro", "Kailh Box Navy", "Topre 45g", "Omron B3")
FORCES = (bumped(15), bumped(20, 0.03), spring, bumped(30, 0.03), dome, bumped(9))


def below(force: Callable[[FloatArray], FloatArray]) -> Callable[[FloatArray], FloatArray]:
    """Return a release curve 3 cN below a press."""
    return lambda x: force(x) - 3


ROWS = [
    row(button(force, below(force), name), f"measured:{i:016x}", f"bench {i % 2}")
    for i, (name, force) in enumerate(zip(NAMES, FORCES, strict=True))
]


def search_of(found: list[ButtonRow]) -> CatalogSearch:
    search = CatalogSearch()
    search.extend(found)
    return search


SEARCH = search_of(ROWS)


def names(query: SearchQuery) -> list[str]:
    return [ROWS[at].name for at in SEARCH.find(query).positions]


def test_every_word_must_match_in_any_case_and_order() -> None:
    assert names(SearchQuery("cherry")) == ["Cherry MX Clear", "Cherry MX Blue"]
    assert names(SearchQuery("CLEAR mx")) == ["Cherry MX Clear"]
    assert names(SearchQuery("cherry navy")) == []
    assert len(names(SearchQuery("  "))) == len(ROWS)
    assert names(SearchQuery("bench 45")) == ["Topre 45g"]


@pytest.mark.parametrize("typed", ["gatreon", "gatron", "gateeron", "gateran", "gaterom", "gatero"])
def test_one_letter_added_left_out_changed_or_swapped_is_forgiven(typed: str) -> None:
    found = SEARCH.find(SearchQuery(typed))
    assert [ROWS[at].name for at in found.positions] == ["Gateron Yellow Pro"]
    assert found.mended == (() if typed == "gatero" else (typed,))


def test_another_first_letter_is_another_word() -> None:
    assert names(SearchQuery("later")) == []


def test_short_words_and_words_that_match_are_taken_as_they_stand() -> None:
    assert names(SearchQuery("nx")) == []
    assert SEARCH.find(SearchQuery("clear")).mended == ()


def test_names_that_begin_with_the_words_come_first() -> None:
    found = [
        msgspec.structs.replace(ROWS[0], id=f"measured:{n}", name=n)
        for n in ("Pro Box", "Boxer", "Big box", "Abox")
    ]
    order = search_of(found).find(SearchQuery("box")).positions
    assert [found[at].name for at in order] == ["Boxer", "Pro Box", "Big box", "Abox"]


ranges = st.dictionaries(
    st.sampled_from(SHELF_NUMBERS),
    st.tuples(st.none() | st.floats(0, 80), st.none() | st.floats(0, 80)),
    max_size=3,
)


@settings(max_examples=60, deadline=None)
@given(
    ranges,
    st.lists(st.sampled_from(ButtonType), unique=True),
    st.sampled_from(["match", "name", "kind", "origin", "date", *SHELF_NUMBERS]),
    st.booleans(),
)
def test_filters_and_order_are_those_of_a_look_at_every_row(
    asked: dict[str, tuple[float | None, float | None]], kinds: list[ButtonType], sort: str, descending: bool
) -> None:
    def fits(one: ButtonRow) -> bool:
        def within(name: str, low: float | None, high: float | None) -> bool:
            value = getattr(one, name)
            return value is not None and (low is None or value >= low) and (high is None or value <= high)

        return (not kinds or one.kind in kinds) and all(within(n, *ends) for n, ends in asked.items())

    query = SearchQuery(kinds=tuple(kinds), ranges=asked, sort=sort, descending=descending)
    found = [ROWS[at] for at in SEARCH.find(query).positions]
    assert sorted(one.id for one in found) == [one.id for one in ROWS if fits(one)]
    if sort in SHELF_NUMBERS:
        values = [getattr(one, sort) for one in found]
        known = [v for v in values if v is not None]
        assert known == sorted(known, reverse=descending)
        assert values[len(known) :] == [None] * (len(values) - len(known))


def test_counts_say_what_each_filter_costs() -> None:
    query = SearchQuery("cherry", kinds=(ButtonType.TACTILE,), ranges={"drop_cN": (50, None)})
    found = SEARCH.find(query)
    assert found.positions.size == 0
    assert found.without == {"text": 0, "kinds": 0, "drop_cN": 1}
    assert found.kinds == {"tactile": 0, "clicky?": 0, "linear": 0, "dome?": 0}


def test_histograms_count_as_numpy_does_with_what_lies_beyond_the_ends_in_the_outermost_bins() -> None:
    for name, found in SEARCH.find(SearchQuery()).histograms.items():
        known = [value for one in ROWS if (value := getattr(one, name)) is not None]
        inside = np.clip(known, found.lowest, found.highest)
        expected = np.histogram(inside, found.counts.size, (found.lowest, found.highest))[0]
        np.testing.assert_array_equal(found.counts, expected)


def test_a_range_narrows_every_histogram_but_its_own() -> None:
    found = SEARCH.find(SearchQuery())
    narrowed = SEARCH.find(SearchQuery(ranges={"drop_cN": (18, None)}))
    np.testing.assert_array_equal(narrowed.histograms["drop_cN"].counts, found.histograms["drop_cN"].counts)
    assert narrowed.histograms["peak_cN"].counts.sum() == narrowed.positions.size == 3


def test_a_column_or_a_button_that_is_not_there_is_refused() -> None:
    for query in (
        SearchQuery(sort="weight"),
        SearchQuery(ranges={"weight": (1, 2)}),
        SearchQuery(like="own:none"),
    ):
        with pytest.raises(InputError):
            SEARCH.find(query)


def test_an_empty_shelf_finds_nothing() -> None:
    found = CatalogSearch().find(SearchQuery("x", sort="peak_cN"))
    assert found.positions.size == 0
    assert found.without == {"text": 0}


def test_rows_that_come_later_are_found_as_if_they_had_been_there() -> None:
    grown = search_of(ROWS[:2])
    grown.find(SearchQuery(like=ROWS[0].id))
    grown.extend(ROWS[2:])
    for query in (SearchQuery(like=ROWS[0].id), SearchQuery("bench", sort="peak_cN")):
        np.testing.assert_array_equal(grown.find(query).positions, SEARCH.find(query).positions)


def test_distance_is_zero_to_itself_and_the_same_both_ways() -> None:
    table = LikeTable()
    table.extend(ROWS)
    gaps = np.array([distances(table.parts(at)) for at in range(len(ROWS))])
    np.testing.assert_allclose(gaps, gaps.T, atol=1e-12)
    np.testing.assert_array_equal(np.diag(gaps), 0)
    assert (gaps[~np.eye(len(ROWS), dtype=bool)] > 0.5).all()


@pytest.mark.parametrize("dimension", ["force", "snap"])
def test_people_with_twice_the_jnd_find_buttons_half_as_far_apart(dimension: Dimension) -> None:
    table = LikeTable()
    table.extend(ROWS)
    once, twice = (
        table.parts(0, jnds_of(record_of(as_literature(dimension, times)))) for times in (1.0, 2.0)
    )
    np.testing.assert_allclose(once, table.parts(0))
    if dimension == "force":
        np.testing.assert_allclose(twice[:, :2], 0.5 * once[:, :2])
        np.testing.assert_allclose(twice[:, 2], once[:, 2])
    else:
        np.testing.assert_allclose(twice[:, :2], once[:, :2])
        assert (twice[1:, 2] < once[1:, 2]).all()


def test_a_search_that_counts_in_other_jnds_leaves_the_next_one_as_it_was() -> None:
    dull = jnds_of(record_of(as_literature("force", 3.0)))
    before, other, after = (
        SEARCH.find(SearchQuery(like=ROWS[0].id, jnds=jnds)).distances
        for jnds in (LITERATURE, dull, LITERATURE)
    )
    assert (other < before).all()
    np.testing.assert_array_equal(after, before)


def test_a_force_8_percent_higher_is_about_one_noticeable_difference_in_force_and_none_in_shape() -> None:
    def strong(scale: float) -> ButtonRow:
        return row(button(lambda x: scale * (100 + 10 * x), lambda x: scale * (95 + 10 * x)))

    table = LikeTable()
    table.extend([strong(1.0), strong(1.08)])
    force, shape, _ = table.parts(0)[1]
    # 8 % of 100 to 145 cN, of which 7 % and 30 cN are noticed
    assert force == pytest.approx(0.9, abs=0.1)
    assert shape == pytest.approx(0, abs=0.02)


def test_a_button_without_a_press_is_infinitely_far() -> None:
    found = [row(load_builtin(name), f"builtin:{name}") for name in builtin_names()]
    found.append(msgspec.structs.replace(found[0], id="own:half", sketch=type(found[0].sketch)()))
    distances = search_of(found).find(SearchQuery(like=found[0].id)).distances
    assert np.isinf(distances[-1])


SAME_SWITCH = (
    "Diamond Avalon",
    "Huano Pineapple",
    "Gateron G Pro 3.0",
    "DareU Mahjong Blue",
    "Durock Sea Glass",
)


@pytest.mark.shared
def test_switches_of_one_make_are_nearest_to_each_other_on_one_bench(shared_data: Path) -> None:
    found = [
        row_of_file(file.path, file.id, file.collection) for file in source_files([shared_data / "tg-tidy"])
    ]
    group = [next((make for make in SAME_SWITCH if one.name.startswith(make)), None) for one in found]
    search = search_of(found)
    asked = [at for at, make in enumerate(group) if make]
    nearest = [int(search.find(SearchQuery(like=found[at].id)).positions[0]) for at in asked]
    hits = sum(group[at] == group[near] for at, near in zip(asked, nearest, strict=True))
    assert len(asked) == 28
    assert hits >= 24  # by chance 3


@pytest.mark.shared
def test_the_same_switch_of_another_bench_is_among_the_nearest_three(shared_data: Path) -> None:
    places = [shared_data / name for name in ("tg-tidy", "haata", "geekboards", "bluepylons")]
    names = re.compile(r"Cherry.MX.(Hyperglide.)?(Clear|Blue|Brown|Black|Red)(\.| Raw|$)")
    files = [file for file in source_files(places) if names.match(file.path.name.split("__")[-1])]
    found = [row_of_file(file.path, file.id, file.collection) for file in files]
    assert {one.origin for one in found} == {Origin.MEASURED}
    search = search_of(found)
    for make in ("Clear", "Blue", "Brown"):
        mates = [
            at
            for at, one in enumerate(found)
            if one.name in (f"Cherry MX {make}", f"Cherry MX Hyperglide {make}")
        ]
        for at in mates:
            positions = search.find(SearchQuery(like=found[at].id)).positions
            other = [p for p in positions if found[p].collection != found[at].collection]
            assert set(other[:3]) & set(mates), found[at].name
