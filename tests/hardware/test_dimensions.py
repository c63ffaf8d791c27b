"""Every dimension is listed; what a person writes is read, and refused where parts would not fit."""

import dataclasses
import itertools
import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings

from fdvv.errors import InputError
from fdvv_rig.dimension_file import assumed, dimensions_toml, load_dimensions
from fdvv_rig.dimensions import Dimensions, meaning_of, source_of
from fdvv_rig.fits import check_fits, misses
from fdvv_rig.layout import Layout
from fdvv_rig.limiter import Limiter
from fdvv_rig.parts import PARTS
from fdvv_rig.tolerance import core_stack
from tests.hardware.legal import legal_dimensions

DEFAULT = Dimensions()


def with_(**values: float) -> Dimensions:
    return dataclasses.replace(DEFAULT, **values)


def test_the_papers_own_numbers_are_those_of_the_paper() -> None:
    paper = [f.name for f in dataclasses.fields(Dimensions) if source_of(f.name) == "paper"]
    assert {name: getattr(DEFAULT, name) for name in paper} == {
        "travel_mm": 6.2,
        "servo_torque_kgf_cm": 1.8,
        "cone_bottom_mm": 12.0,
        "cone_top_mm": 5.0,
        "cone_height_mm": 5.0,
    }


def test_every_dimension_has_a_meaning_a_source_and_a_unit_in_its_name() -> None:
    for found in dataclasses.fields(Dimensions):
        assert meaning_of(found.name)
        assert source_of(found.name) in ("paper", "assumed, measure yours", "chosen")
        assert found.name.endswith(("_mm", "_deg", "_N", "_kgf_cm")), found.name


def test_dimensions_of_bought_parts_say_that_they_are_to_be_measured() -> None:
    assert {"coil_diameter_mm", "lvdt_diameter_mm", "servo_length_mm", "exciter_diameter_mm"} <= set(
        assumed()
    )


def test_the_default_parts_fit_each_other() -> None:
    assert list(misses(DEFAULT)) == []


def test_what_is_written_is_what_is_read(tmp_path: Path) -> None:
    mine = with_(coil_diameter_mm=24.0, travel_mm=5.0)
    text = dimensions_toml(mine)
    (tmp_path / "mine.toml").write_text(text)
    assert load_dimensions(tmp_path / "mine.toml") == mine
    assert tomllib.loads(text)["travel_mm"] == 5.0
    assert "set, 6.2 by default" in text


def test_a_word_goes_over_the_file(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text("travel_mm = 5\n")
    assert load_dimensions(tmp_path / "mine.toml", ["travel_mm=4"]).travel_mm == 4.0


def test_equal_dimensions_have_one_fingerprint_and_others_another() -> None:
    assert with_().digest() == DEFAULT.digest()
    assert len({with_(wall_mm=4.0 + i / 100).digest() for i in range(20)}) == 20


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["travle_mm=3"], "did you mean travel_mm?"),
        (["travel_mm"], "no equals sign"),
        (["travel_mm=wide"], "not a number"),
        (["travel_mm=nan"], "not a positive number"),
        (["wall_mm=-1"], "not a positive number"),
        (["travel_mm=1e400"], "not a positive number"),
        (["travel_mm=13"], "displacement sensor's 12.7 mm"),
        (["travel_mm=7"], "the limiter stops from"),
        (["limiter_large_mm=15.5"], "the limiter stops from"),
        (["limiter_large_mm=9", "horn_length_mm=7"], "no spiral that rises"),
        (["horn_length_mm=16.5"], "cut the horn shorter"),
        (["servo_torque_kgf_cm=0.6"], "% of the stall torque"),
        (["rod_diameter_mm=3.2"], "does not let the rod"),
        (["wall_mm=0.8"], "thinner than prints well"),
        (["box_wall_mm=0.4"], "thinner than prints well"),
        (["bed_width_mm=120"], "black box"),
        (["bed_height_mm=150"], "less room above the keycap"),
        (["lvdt_core_diameter_mm=3.3"], "does not enter"),
        (["lvdt_sink_mm=17"], "leads"),
        (["coil_diameter_mm=20"], "too narrow for the sensor's mount"),
        (["float_mm=0.3"], "cannot take up"),
        (["cone_top_mm=13"], "narrower"),
        (["tongue_width_mm=5"], "beside the slot"),
        (["m3_insert_mm=5.5"], "about its insert"),
    ],
)
def test_what_cannot_be_made_is_refused_in_one_line(words: list[str], said: str) -> None:
    with pytest.raises(InputError, match=r".") as refused:
        load_dimensions(None, words)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "text", ["travel_mm = true\n", 'travel_mm = "x"\n', "[rig]\ntravel_mm = 4\n", "=\n", "\xff"]
)
def test_a_file_that_holds_no_dimensions_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match=r"mine\.toml"):
        load_dimensions(tmp_path / "mine.toml")


def test_each_dimension_that_a_drawing_tells_exists() -> None:
    names = {found.name for found in dataclasses.fields(Dimensions)}
    assert {name for part in PARTS for name in part.drawn} <= names


@settings(max_examples=12, deadline=None)
@given(legal_dimensions)
def test_legal_dimensions_leave_room_where_things_move(d: Dimensions) -> None:
    layout = Layout(d)
    down = d.travel_mm + d.overtravel_mm
    assert layout.coupling_top_mm + d.overtravel_mm < layout.floor_low_mm
    assert layout.coupling_top_mm - d.coupling_length_mm - down > layout.lvdt_top_mm
    assert layout.yoke_low_mm - down >= layout.coil_top_mm + d.free_gap_mm - 1e-9
    low, high = layout.slot_mm
    assert high - low >= d.travel_mm + 2 * d.overtravel_mm + d.m3_clearance_mm - 1e-9
    assert layout.tongue_low_mm < low
    assert layout.bracket_in_mm > layout.limiter_out_mm
    half_core = d.lvdt_core_length_mm / 2
    assert layout.core_centre_mm - d.travel_mm - half_core > -d.lvdt_sink_mm
    assert layout.core_centre_mm + half_core < layout.lvdt_top_mm


@settings(max_examples=6, deadline=None)
@given(legal_dimensions)
def test_the_limiter_reaches_the_whole_travel_and_its_law_can_be_inverted(d: Dimensions) -> None:
    limiter = Limiter(d)
    stops = [limiter.travel_mm(angle) for angle in range(0, int(d.servo_sweep_deg) + 1, 10)]
    assert all(a > b for a, b in itertools.pairwise(stops))
    for share in (0.0, 0.3, 1.0):
        wanted = share * d.travel_mm
        assert limiter.travel_mm(limiter.angle_deg(wanted)) == pytest.approx(wanted, abs=1e-6)


def test_the_stop_moves_evenly_with_the_angle_over_the_travel() -> None:
    limiter = Limiter(DEFAULT)
    stops = [limiter.angle_deg(travel) for travel in (1.0, 2.0, 3.0, 4.0, 5.0)]
    steps = [a - b for a, b in itertools.pairwise(stops)]
    assert steps == pytest.approx([1 / limiter.mm_per_deg] * 4, rel=0.01)


def test_a_foot_on_a_round_arm_stands_on_top_of_it() -> None:
    # a spiral that hardly rises is a circle: the foot rests on its top, whatever the angle
    circle = Limiter(with_(limiter_small_mm=10.0, limiter_large_mm=10.0 + 1e-9))
    assert circle.foot_mm(30.0) == pytest.approx(10.0, abs=2e-3)
    assert circle.foot_mm(200.0) == pytest.approx(10.0, abs=2e-3)


def test_the_limiters_torque_is_force_times_rise_per_radian() -> None:
    # 7 mm over 150 degrees, 20 N: by hand 20 * 7 / (150 * pi / 180)
    assert Limiter(DEFAULT).torque_N_mm == pytest.approx(53.476, abs=1e-3)


def test_a_travel_beyond_the_limiter_is_refused() -> None:
    with pytest.raises(InputError, match="outside"):
        Limiter(DEFAULT).angle_deg(9.0)


def test_the_tolerances_that_the_sensors_mount_takes_up_are_listed_by_cause() -> None:
    stack = core_stack(DEFAULT)
    assert stack.worst_mm == pytest.approx(sum(cause.either_way_mm for cause in stack.causes))
    assert stack.likely_mm < stack.worst_mm
    room_mm = (DEFAULT.lvdt_bore_mm - DEFAULT.lvdt_core_diameter_mm) / 2
    assert stack.worst_mm > room_mm, "were it less, the mount would need no moving"
    assert stack.worst_mm <= room_mm + DEFAULT.float_mm


def test_the_first_misfit_is_the_one_that_is_reported() -> None:
    bad = with_(travel_mm=13.0, wall_mm=0.5)
    first = next(misses(bad))
    with pytest.raises(InputError, match=first[0]):
        check_fits(bad)
