"""Pictures of all recorded presses: paces, registration, averages."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.bench.figures import plot_averages, plot_registration, plot_velocities
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.preprocess.paper import AS_PRINTED, PaperRecipe, paper_average
from fdvv.preprocess.reject import Reason
from tests.support.captures import SHORT_STROKE, recorded
from tests.support.gallery import Gallery

texts = Gallery.texts


def line(ax: Any, label: str) -> Any:
    (found,) = [one for one in ax.get_lines() if str(one.get_label()).startswith(label)]
    return found


def test_every_press_stands_at_the_speed_it_had_and_those_left_out_with_their_reason() -> None:
    (ax,) = plot_velocities(recorded().processed).axes
    used, left = line(ax, "used: 11"), line(ax, "did not reach the bottom: 1")
    speeds = [one.achieved_mm_s for one in recorded().processed.judged if one.reason is None]
    np.testing.assert_array_equal(used.get_ydata(), speeds)
    (out,) = [i for i, one in enumerate(recorded().processed.judged, 1) if one.press.take == SHORT_STROKE]
    assert list(left.get_xdata()) == [out]
    np.testing.assert_array_equal(line(ax, "asked").get_ydata(), [50.0] * 5 + [150.0] * 7)


def test_every_reason_has_a_look_of_its_own() -> None:
    judged = tuple(
        replace(one, reason=reason) for one, reason in zip(recorded().processed.judged, Reason, strict=False)
    )
    (ax,) = plot_velocities(replace(recorded().processed, judged=judged)).axes
    looks = {
        (one.get_marker(), one.get_color()) for one in ax.get_lines() if one.get_marker() not in ("None", "o")
    }
    assert len(looks) == len(Reason)


@pytest.mark.parametrize("stroke", list(Stroke))
def test_registration_shows_all_samples_the_mean_its_band_and_the_papers_recipe(stroke: Stroke) -> None:
    (ax,) = plot_registration(recorded().processed, stroke, 150.0).axes
    at = [(c.stroke, c.velocity_mm_s) for c in recorded().processed.curves].index((stroke, 150.0))
    curve, tracks = recorded().processed.curves[at], recorded().processed.tracks[at]
    count = sum(track.t_s.size for track in tracks)
    assert line(ax, f"{count} samples of 6 presses").get_xdata().size == count
    np.testing.assert_array_equal(line(ax, "mean").get_ydata(), curve.force_cN)
    theirs = paper_average(
        recorded().processed.judged, stroke, 150.0, PaperRecipe(), recorded().processed.zero_mm
    )
    np.testing.assert_array_equal(line(ax, "the paper's recipe").get_ydata(), theirs.force_cN)
    (band,) = [np.asarray(c.get_paths()[0].vertices) for c in ax.collections]
    assert band[:, 1].max() == pytest.approx(float((curve.force_cN + curve.spread_cN).max()))
    assert "n = 6 presses" in texts(ax.figure)


def test_the_units_of_the_papers_recipe_are_named() -> None:
    figure = plot_registration(recorded().processed, "press", 150.0, AS_PRINTED)
    assert "σ 1.2 mm and 0.8 mm" in texts(figure).replace("\n", " ")


def test_a_curve_that_was_not_averaged_is_refused() -> None:
    with pytest.raises(ModelError, match="no press at 80 mm/s was averaged"):
        plot_registration(recorded().processed, "press", 80.0)


def test_averages_show_every_pace_in_its_band_and_the_probe() -> None:
    figure = plot_averages(recorded().processed)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["press", "release"]
    for ax, stroke in zip(figure.axes, Stroke, strict=True):
        curves = [c for c in recorded().processed.curves if c.stroke is stroke]
        assert len(ax.collections) == len(curves) == 2
        assert len(ax.get_lines()) == len(curves) + 1
        probe = recorded().processed.probe
        assert probe is not None
        np.testing.assert_array_equal(ax.get_lines()[0].get_xdata(), probe.displacement_mm)
    assert "probe, 0.5 mm/s" in texts(figure)
    assert "mean ± 1 SD,\nn = 5 to 6 presses" in texts(figure)


def test_without_a_probe_none_is_named() -> None:
    assert "probe" not in texts(plot_averages(replace(recorded().processed, probe=None)))


@pytest.mark.parametrize("simulated", [False, True])
def test_simulated_data_say_so(simulated: bool) -> None:
    for figure in (
        plot_velocities(recorded().processed, simulated),
        plot_registration(recorded().processed, "press", 50.0, simulated=simulated),
        plot_averages(recorded().processed, simulated),
    ):
        assert ("simulated" in texts(figure)) is simulated
