from pathlib import Path

import numpy as np
import pytest
from tools import make_builtin

from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.file import builtin_names, load_builtin, model_to_json
from fdvv.model.model import FDVVModel

ROOT = Path(__file__).parents[4]

# read from the drawn curves, between the nodes (cN)
GOLDEN_mm = (0.40, 1.25, 2.10, 2.70, 3.95)
GOLDEN_cN = {
    ("press", 0.5): (39.838, 62.996, 51.609, 70.779, 89.211),
    ("press", 50.0): (38.409, 64.931, 52.965, 73.814, 96.634),
    ("press", 100.0): (33.175, 65.616, 55.991, 71.785, 102.846),
    ("press", 150.0): (32.868, 58.949, 51.470, 60.341, 98.284),
    ("press", 200.0): (35.425, 67.871, 62.871, 68.807, 102.530),
    ("release", 0.5): (23.389, 49.020, 34.829, 66.708, 81.170),
    ("release", 50.0): (5.399, 34.302, 18.076, 49.226, 65.076),
    ("release", 100.0): (13.164, 19.361, 14.354, 50.273, 84.479),
    ("release", 150.0): (9.471, 14.143, 18.388, 49.079, 74.639),
    ("release", 200.0): (23.347, 26.721, 37.442, 55.146, 69.706),
}


@pytest.fixture(scope="module")
def clear() -> FDVVModel:
    return load_builtin("mx-clear")


def drawn_curves(folder: Path, stroke: Stroke) -> np.ndarray:
    """The figure's own table: displacement, then force at 0.5, 50, 100, 150 and 200 mm/s."""
    return np.genfromtxt(folder / "paper-figure" / f"fdvv_figure_{stroke}.csv", delimiter=",", skip_header=1)


@pytest.mark.parametrize(("stroke", "velocity_mm_s"), GOLDEN_cN)
def test_the_published_forces_come_back_between_the_nodes(
    clear: FDVVModel, stroke: str, velocity_mm_s: float
) -> None:
    forces = clear.force_cN(GOLDEN_mm, velocity_mm_s, stroke)
    np.testing.assert_allclose(forces, GOLDEN_cN[stroke, velocity_mm_s], rtol=0, atol=0.01)


@pytest.mark.shared
@pytest.mark.parametrize("stroke", Stroke)
def test_the_ten_published_curves_are_reproduced_to_a_hundredth_of_a_cN(
    clear: FDVVModel, stroke: Stroke, shared_data: Path
) -> None:
    table = drawn_curves(shared_data, stroke)
    drawn = table[table[:, 0] >= 0.249]
    curves = clear.of(stroke)
    assert [c.velocity_mm_s for c in curves] == [0.5, 50.0, 100.0, 150.0, 200.0]
    for curve, forces in zip(curves, drawn[:, 1:].T, strict=True):
        np.testing.assert_allclose(curve.force_cN(drawn[:, 0]), forces, rtol=0, atol=0.01)


@pytest.mark.shared
@pytest.mark.parametrize(("stroke", "above_cN", "below_cN"), [("press", 6.4, 0.0), ("release", 3.8, 2.6)])
def test_below_the_second_node_the_spline_leaves_the_drawn_line_as_far_as_the_provenance_says(
    clear: FDVVModel, stroke: Stroke, above_cN: float, below_cN: float, shared_data: Path
) -> None:
    x = np.linspace(0.0, 0.25, 251)
    excess = [
        curve.force_cN(x) - np.interp(x, drawn_curves(shared_data, stroke)[:, 0], forces)
        for curve, forces in zip(clear.of(stroke), drawn_curves(shared_data, stroke)[:, 1:].T, strict=True)
    ]
    assert np.max(excess) == pytest.approx(above_cN, abs=0.05)
    assert -np.min(excess) == pytest.approx(below_cN, abs=0.05)


@pytest.mark.shared
def test_the_shipped_file_is_what_its_tool_builds(clear: FDVVModel, shared_data: Path) -> None:
    made = make_builtin.build(shared_data / "paper-figure" / "fdvv_figure_nodes.csv")
    assert model_to_json(made) == model_to_json(clear)


def test_every_published_curve_has_fifteen_control_points(clear: FDVVModel) -> None:
    assert [c.control_points_cN.size for c in clear.curves] == [15] * 10


def test_the_published_button_has_the_papers_travel_activation_and_vibration(clear: FDVVModel) -> None:
    assert (clear.travel_mm, clear.actuation_mm) == (4.0, 2.0)
    vibration = clear.vibration("press", 100.0)
    assert vibration is not None
    assert (vibration.onset_mm, vibration.duration_s) == (2.3, 0.016)
    assert [m.frequency_Hz for m in vibration.modes] == [239.0]


def test_the_vibration_falls_as_the_papers_middle_template_does(clear: FDVVModel) -> None:
    vibration = clear.vibration("press", 100.0)
    assert vibration is not None
    remaining = np.exp(-vibration.modes[0].decay_1_s * vibration.duration_s)
    assert remaining == pytest.approx(0.3 / 2.43, rel=1e-3)


@pytest.mark.parametrize("name", builtin_names())
def test_every_shipped_model_bears_its_files_name_and_says_where_it_comes_from(name: str) -> None:
    model = load_builtin(name)
    assert model.name == name
    assert model.provenance.source
    assert model.provenance.licence
    assert f"`{name}`" in (ROOT / "packages/fdvv/src/fdvv/model/builtin/NOTICE.md").read_text()


@pytest.mark.parametrize("name", builtin_names())
def test_every_shipped_file_is_written_as_the_library_writes_it(name: str) -> None:
    path = ROOT / "packages/fdvv/src/fdvv/model/builtin" / f"{name}.fdvv.json"
    assert path.read_text() == model_to_json(load_builtin(name))


def test_an_unknown_name_is_answered_with_the_names_there_are() -> None:
    with pytest.raises(InputError, match=r"no model is called 'mx-pink'; use one of: .*mx-clear") as caught:
        load_builtin("mx-pink")
    assert "\n" not in str(caught.value)
