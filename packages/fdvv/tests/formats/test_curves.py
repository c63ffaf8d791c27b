"""Tables of curves are read back, by the readers of foreign files, to the same numbers."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.formats.exchange.curves import bluepylons_csv, curves_csv, haata_csv, switch_tester_json
from fdvv.formats.exchange.exported import Exported
from fdvv.formats.force.read import read_force_file
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from tests.formats import conftest as files

WRITERS: dict[str, tuple[Callable[[FDVVModel], Exported], str]] = {
    "plain-csv": (curves_csv, ".csv"),
    "bluepylons-csv": (bluepylons_csv, ".csv"),
    "haata": (haata_csv, ".csv"),
    "tester-json": (switch_tester_json, ".json"),
}


def _read_back(model: FDVVModel, form: str, folder: Path) -> list[tuple[ForceCurve, float, int]]:
    """Return each curve read with its largest error, and its samples."""
    write, ending = WRITERS[form]
    path = folder / f"{model.name}{ending}"
    write(model).save(path)
    found = read_force_file(path)
    assert found.format == form
    # where a model knows only one of the contact's points, the other is reported as missing
    assert [w for w in found.warnings if "reset point" not in w and "actuation point" not in w] == []
    read = []
    for number, cycle in enumerate(found.cycles):
        for part in (cycle.press, cycle.release):
            if part is None:
                continue
            of = model.of(part.stroke)
            match = of[number] if form == "haata" else model.nearest(part.stroke, part.velocity_mm_s)
            assert match is not None
            off = np.abs(match.force_cN(part.displacement_mm) - part.force_cN).max()
            read.append((match, float(off), part.displacement_mm.size))
    return read


@pytest.mark.parametrize("form", WRITERS)
@pytest.mark.parametrize("name", builtin_names())
def test_the_readers_of_foreign_files_give_back_the_same_force(name: str, form: str, tmp_path: Path) -> None:
    model = load_builtin(name)
    read = _read_back(model, form, tmp_path)
    one_velocity = form in ("bluepylons-csv", "tester-json")
    assert len({id(curve) for curve, _, _ in read}) == (2 if one_velocity else len(model.curves))
    assert max(off for _, off, _ in read) < 1e-9
    assert min(count for _, _, count in read) > 350


@pytest.mark.parametrize("form", ["plain-csv", "bluepylons-csv", "tester-json"])
def test_the_contacts_points_come_back_where_they_are(form: str, tmp_path: Path) -> None:
    model = load_builtin("mx-blue")
    write, ending = WRITERS[form]
    write(model).save(tmp_path / f"a{ending}")
    cycle = read_force_file(tmp_path / f"a{ending}").cycles[0]
    assert (cycle.actuation_mm, cycle.reset_mm) == (model.actuation_mm, model.reset_mm)


def test_the_plain_table_keeps_stroke_and_velocity_in_its_names(tmp_path: Path) -> None:
    head = curves_csv(load_builtin("mx-clear")).text.partition("\n")[0].split(",")
    assert head[:3] == [f"press_0.5mm_s_{q}" for q in ("displacement_mm", "actuated", "force_cN")]
    assert len(head) == 30
    curves_csv(load_builtin("mx-clear")).save(tmp_path / "a.csv")
    cycles = read_force_file(tmp_path / "a.csv").cycles
    assert [c.press.velocity_mm_s for c in cycles if c.press] == [0.5, 50, 100, 150, 200]


def test_a_bench_layout_takes_the_curve_nearest_in_velocity(tmp_path: Path) -> None:
    model = load_builtin("rubber-dome")
    bluepylons_csv(model, 140).save(tmp_path / "a.csv")
    press = files.press(read_force_file(tmp_path / "a.csv"))
    wanted = next(c for c in model.of("press") if c.velocity_mm_s == 150)
    np.testing.assert_allclose(press.force_cN, wanted.force_cN(press.displacement_mm), atol=1e-9)


def test_losses_are_listed() -> None:
    assert "2 vibrations" in curves_csv(load_builtin("mx-clear")).lost
    assert "8 curves at other velocities" in bluepylons_csv(load_builtin("mx-clear")).lost
    assert "contact points" in haata_csv(load_builtin("mx-red")).lost


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    speeds=st.lists(
        st.floats(0.001, 5000).map(lambda v: float(f"{v:.6g}")), min_size=1, max_size=3, unique=True
    ),
    step_mm=st.sampled_from([0.005, 0.01, 0.013, 0.1]),
    heights=st.lists(st.floats(5, 200), min_size=8, max_size=8),
)
def test_any_velocity_and_step_are_read_back(
    speeds: list[float], step_mm: float, heights: list[float], tmp_path: Path
) -> None:
    knots = np.array([0.0, 0, 0, 1, 1.5, 2, 2.5, 3, 4, 4, 4])
    # rising, so that no reader takes a fall for a defect
    points = np.cumsum(heights) / 8
    curves = tuple(
        ForceCurve(stroke, v, 2, knots, points * (1 if stroke is Stroke.PRESS else 0.8))
        for v in speeds
        for stroke in Stroke
    )
    model = FDVVModel("drawn", 4.0, curves)
    curves_csv(model, step_mm).save(tmp_path / "a.csv")
    found = read_force_file(tmp_path / "a.csv")
    for cycle in found.cycles:
        assert cycle.press is not None
        curve = model.nearest("press", cycle.press.velocity_mm_s)
        assert curve is not None
        assert curve.velocity_mm_s == cycle.press.velocity_mm_s
        np.testing.assert_allclose(
            curve.force_cN(cycle.press.displacement_mm), cycle.press.force_cN, atol=1e-9
        )


def test_a_step_of_nothing_is_refused() -> None:
    with pytest.raises(ModelError, match="step_mm must be at least"):
        curves_csv(load_builtin("mx-red"), 0.0)
