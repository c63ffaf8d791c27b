from dataclasses import replace
from typing import Any

import matplotlib.figure
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from numpy.testing import assert_allclose

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.spread import ModeSpread, VibrationSpread
from fdvv.model.vibration import Mode, Vibration
from fdvv.report import style
from fdvv.report.model_figures import plot_comparison, plot_model, plot_surface, plot_vibration
from fdvv.report.svg import figure_of
from tests.support.captures import recorded


def lines(ax: Any, *styles: str) -> list[Any]:
    return [line for line in ax.get_lines() if line.get_linestyle() in styles]


def legend(ax: Any) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_model_is_drawn_with_every_curve_as_it_is(model: FDVVModel) -> None:
    drawn = lines(plot_model(model), "-", "--")
    assert len(drawn) == len(model.curves) == 10
    for line, curve in zip(drawn, model.curves, strict=True):
        assert line.get_linestyle() == ("-" if curve.stroke is Stroke.PRESS else "--")
        assert_allclose(line.get_ydata(), curve.force_cN(line.get_xdata()), atol=1e-12)
        assert (line.get_xdata()[0], line.get_xdata()[-1]) == (0.0, 4.0)


def test_both_strokes_of_one_velocity_share_its_colour(model: FDVVModel) -> None:
    drawn = lines(plot_model(model), "-", "--")
    press, release = ([to_rgb(line.get_color()) for line in half] for half in (drawn[:5], drawn[5:]))
    assert press == release
    assert len(set(press)) == 5


def test_the_landmarks_of_a_model_lie_on_its_curves(model: FDVVModel) -> None:
    marks = lines(plot_model(model), "None")
    found = {line.get_marker(): line for line in marks}
    assert_allclose(found["v"].get_xdata(), [2.0] * 5)
    assert_allclose(found["v"].get_ydata(), [c.force_cN(2.0) for c in model.of("press")])
    assert_allclose(found["^"].get_ydata(), [c.force_cN(2.0) for c in model.of("release")])
    assert_allclose(found["*"].get_xdata(), [2.3] * 5)
    assert legend(plot_model(model))[-3:] == [
        "actuation, 2.00 mm",
        "reset, 2.00 mm",
        "vibration onset, 2.30 mm",
    ]


def test_a_model_of_one_curve_without_landmarks_is_drawn(model: FDVVModel) -> None:
    curve = replace(model.of("release")[0], velocity_mm_s=None)
    ax = plot_model(FDVVModel("one", 4.0, (curve,)))
    assert len(ax.get_lines()) == 1
    assert legend(ax) == ["speed unknown", "release"]


def test_drawing_on_given_axes_stays_on_them(model: FDVVModel) -> None:
    fig = matplotlib.figure.Figure()
    left, right = fig.subplots(1, 2)
    assert plot_model(model, left) is left
    assert right.get_lines() == []
    assert figure_of(left) is fig


def test_simulated_is_read_from_the_model(gallery: Any, simulated_model: FDVVModel) -> None:
    for drawn in (
        plot_model(simulated_model),
        plot_surface(simulated_model),
        plot_vibration(simulated_model),
    ):
        assert "simulated" in gallery.texts(drawn).splitlines()


def test_one_simulated_model_among_measured_ones_marks_figure_and_entry(
    model: FDVVModel, simulated_model: FDVVModel
) -> None:
    ax = plot_comparison([model, simulated_model])
    assert ax.get_title(loc="right") == "simulated"
    assert legend(ax)[:2] == ["mx-clear", "twin of mx-clear (simulated)"]


def test_the_lines_of_a_surface_are_the_curves_at_their_velocities(model: FDVVModel) -> None:
    ax = plot_surface(model, "press")
    assert len(ax.get_lines()) == 5
    for line, curve in zip(ax.get_lines(), model.of("press"), strict=True):
        x, v, force = line.get_data_3d()
        assert np.all(v == curve.velocity_mm_s)
        assert_allclose(force, curve.force_cN(x), atol=1e-12)


def test_the_facets_of_a_surface_lie_on_the_model(model: FDVVModel) -> None:
    (surface,) = plot_surface(model, "release").collections
    # matplotlib keeps no public copy of the corners
    x, v, force = np.moveaxis(np.asarray(surface._faces), -1, 0)
    assert_allclose(force, model.force_cN(x, v, "release"), atol=1e-9)
    assert set(model.velocities_mm_s("release")) <= set(np.round(v.ravel(), 9))


def test_a_surface_needs_two_velocities(model: FDVVModel) -> None:
    one = FDVVModel("slow only", 4.0, model.of("press")[:1])
    with pytest.raises(ModelError, match=r"'slow only' needs press curves at 2 velocities, has 1"):
        plot_surface(one, "press")
    with pytest.raises(ModelError, match="release"):
        plot_surface(one, "release")


def test_a_comparison_takes_the_curves_nearest_to_the_velocity(model: FDVVModel) -> None:
    press, release = lines(plot_comparison([model], velocity_mm_s=140.0), "-", "--")
    assert_allclose(press.get_ydata(), model.of("press")[3].force_cN(press.get_xdata()))
    assert_allclose(release.get_ydata(), model.of("release")[3].force_cN(release.get_xdata()))
    slowest, _ = lines(plot_comparison([model]), "-", "--")
    assert_allclose(slowest.get_ydata(), model.of("press")[0].force_cN(slowest.get_xdata()))


def test_a_comparison_marks_the_landmarks_that_the_model_room_finds(model: FDVVModel) -> None:
    found = landmarks(model)
    marks = [(m.get_xdata()[0], m.get_ydata()[0]) for m in lines(plot_comparison([model]), "None")]
    expected = [
        (found.peak_mm, found.peak_cN),
        (found.valley_mm, found.valley_cN),
        (2.0, found.actuation_cN),
        (2.0, model.force_cN(2.0, 0.5, "release")),
    ]
    assert_allclose(marks, np.array(expected, dtype=float))


def test_a_button_without_a_press_or_a_bump_is_compared_too(model: FDVVModel) -> None:
    flat = ForceCurve(Stroke.PRESS, None, 1, np.array([0.0, 0.0, 4.0, 4.0]), np.array([10.0, 60.0]))
    linear = FDVVModel("linear", 4.0, (flat,))
    upward = FDVVModel("upward", 4.0, model.of("release")[:1])
    ax = plot_comparison([linear, upward])
    assert len(lines(ax, "-")) == 1
    assert len(lines(ax, "--")) == 1
    assert lines(ax, "None") == []


def test_forty_models_get_forty_colours_and_names(model: FDVVModel) -> None:
    ax = plot_comparison([model.renamed(f"switch {i}") for i in range(40)])
    assert legend(ax)[:40] == [f"switch {i}" for i in range(40)]
    assert len({line.get_color() for line in lines(ax, "-")}) == 40


def test_a_comparison_of_nothing_is_refused() -> None:
    with pytest.raises(ModelError, match="at least one model"):
        plot_comparison([])


def test_equal_vibrations_are_drawn_once_and_named_together(model: FDVVModel) -> None:
    curve: Any = plot_vibration(model).get_lines()[0]
    t_s = np.asarray(curve.get_xdata())
    assert curve.get_label() == "press and release, every speed: 239 Hz"
    assert_allclose(curve.get_ydata(), model.vibrations[0].acceleration_m_s2(t_s))
    assert t_s[-1] == model.vibrations[0].duration_s


def test_different_vibrations_are_drawn_apart(model: FDVVModel) -> None:
    first = replace(model.vibrations[0], velocity_mm_s=50.0)
    second = replace(first, velocity_mm_s=100.0, duration_s=0.02)
    up = replace(second, stroke=Stroke.RELEASE, duration_s=0.03)
    ax = plot_vibration(replace(model, vibrations=(first, second, up)))
    assert [line.get_linestyle() for line in ax.get_lines()[:3]] == ["-", "-", "--"]
    assert legend(ax) == ["press, 50 mm/s: 239 Hz", "press, 100 mm/s: 239 Hz", "release, 100 mm/s: 239 Hz"]


def test_a_model_without_vibration_has_none_to_draw(model: FDVVModel) -> None:
    with pytest.raises(ModelError, match="no vibration"):
        plot_vibration(replace(model, vibrations=()))


def test_limits_hold_every_finite_value() -> None:
    low, high = style.limits_around(np.array([1.0, np.nan, 3.0]), [np.inf, 0.0])
    assert low < 0.0
    assert high > 3.0
    assert style.limits_around([2.0, 2.0]) == (1.5, 2.5)
    assert style.limits_around([np.nan]) == (-0.05, 1.05)


def bands(ax: Any) -> list[Any]:
    """Return the bands of axes, as (vertices, 2) arrays."""
    from matplotlib.collections import PolyCollection

    return [c.get_paths()[0].vertices for c in ax.collections if isinstance(c, PolyCollection)]


def test_a_measured_curve_stands_in_a_band_of_one_standard_deviation() -> None:
    model = recorded().model
    ax = plot_model(model)
    measured = [c for c in model.curves if c.spread]
    assert len(bands(ax)) == len(measured) == 6
    for curve, band in zip(measured, bands(ax), strict=True):
        assert curve.spread is not None
        at_mm = curve.spread.displacement_mm[30]
        heights = band[np.isclose(band[:, 0], at_mm), 1]
        middle, half = float(curve.force_cN(at_mm)), float(curve.spread.spread_cN[30])
        np.testing.assert_allclose([heights.min(), heights.max()], [middle - half, middle + half], atol=1e-9)


def test_the_legend_says_what_the_band_is_and_of_how_many_presses(gallery: Any) -> None:
    model = recorded().model
    texts = gallery.texts(plot_model(model))
    assert model.actuation_spread is not None
    assert "mean ± 1 SD,\nn = 2 to 6 presses" in texts
    assert f"actuation, {model.actuation_mm:.2f} ± {model.actuation_spread.spread_mm:.2f} mm" in texts
    assert "SD" not in gallery.texts(plot_model(load_builtin("mx-clear")))


def test_a_comparison_draws_the_bands_of_the_buttons_that_were_measured(gallery: Any) -> None:
    ax = plot_comparison([load_builtin("mx-clear"), recorded().model], velocity_mm_s=150.0)
    assert len(bands(ax)) == 2
    assert "mean ± 1 SD,\nn = 6 presses" in gallery.texts(ax)


def test_a_vibration_is_named_with_the_spread_of_its_frequency() -> None:
    spread = VibrationSpread(12, modes=(ModeSpread(6.5),))
    buzz = Vibration(Stroke.PRESS, 150.0, 2.1, 0.016, (Mode(239.0, 4.0, 150.0),), spread)
    model = replace(recorded().model, vibrations=(buzz,))
    assert legend(plot_vibration(model)) == ["press, 150 mm/s: 239 ± 6.5 Hz"]
    plain = replace(model, vibrations=(replace(buzz, spread=None),))
    assert legend(plot_vibration(plain)) == ["press, 150 mm/s: 239 Hz"]
