"""Pictures of one recorded press and of all: what they show is what was recorded and found."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.bench.figures import (
    plot_averages,
    plot_clocks,
    plot_displacement,
    plot_force,
    plot_registration,
    plot_take,
    plot_velocities,
)
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.preprocess.clock import ClockFit
from fdvv.preprocess.paper import AS_PRINTED, PaperRecipe, paper_average
from fdvv.preprocess.reject import Reason
from fdvv.preprocess.takes import edge_bounds
from fdvv.recording.types import Quantity
from tests.support.captures import SHORT_STROKE, capture, recorded
from tests.support.gallery import Gallery

texts = Gallery.texts

FAST = 10
"""A take at 150 mm/s."""


def line(ax: Any, label: str) -> Any:
    (found,) = [one for one in ax.get_lines() if str(one.get_label()).startswith(label)]
    return found


def test_every_stream_of_a_take_has_a_panel_with_its_unit_and_its_clock() -> None:
    take = capture().takes[FAST - 1]
    figure = plot_take(capture(), FAST)
    assert len(figure.axes) == len(take.streams)
    for ax, stream in zip(figure.axes, take.streams, strict=True):
        assert ax.get_ylabel().startswith(stream.name)
        assert f"clock of the {stream.clock} (s)" in ax.get_xlabel()
        assert stream.t_s[0] == np.asarray(ax.get_lines()[0].get_xdata())[0]
    (force,) = take.of(Quantity.FORCE)
    np.testing.assert_array_equal(figure.axes[0].get_lines()[0].get_ydata(), force.values)
    assert "(cN)" in figure.axes[0].get_ylabel()


def test_marks_stand_on_the_clock_that_they_were_made_on() -> None:
    take = capture().takes[FAST - 1]
    for ax, stream in zip(plot_take(capture(), FAST).axes, take.streams, strict=True):
        drawn = sorted(x[0] for x in (np.asarray(one.get_xdata()) for one in ax.get_lines()) if x[0] == x[-1])
        assert drawn == sorted(m.t_s for m in take.marks if m.clock == stream.clock)
    assert "mark: closed" in texts(plot_take(capture(), FAST))


def test_the_clocks_figure_shows_the_bounds_of_every_edge() -> None:
    figure = plot_clocks(capture(), recorded().processed)
    bounds = edge_bounds(capture(), recorded().processed.clock)
    assert bounds is not None
    wide, close = figure.axes
    bars = np.array([p.vertices for c in wide.collections for p in c.get_paths()])
    np.testing.assert_allclose(np.sort(bars[:, 0, 0]), bounds.board_s)
    np.testing.assert_allclose(np.sort(bars[:, :, 1].min(axis=1)), np.sort(1e3 * bounds.low_s))
    np.testing.assert_allclose(line(close, "not later").get_ydata(), 1e6 * bounds.high_s)
    assert f"{recorded().processed.clock.edges} edges" in texts(figure)
    assert "doubt ±" in texts(figure)
    assert "contradicts" not in texts(figure)


def test_edges_that_the_line_misses_are_reported() -> None:
    clock = recorded().processed.clock
    wrong = replace(recorded().processed, clock=replace(clock, offset_s=clock.offset_s + 3e-3))
    assert "contradicts the line" in texts(plot_clocks(capture(), wrong))


def test_one_clock_alone_has_no_figure() -> None:
    alone = replace(recorded().processed, clock=ClockFit(0.0))
    with pytest.raises(ModelError, match="no light that joined two clocks"):
        plot_clocks(capture(), alone)


def test_the_force_is_drawn_as_read_and_as_felt_and_their_difference_below() -> None:
    processed = recorded().processed
    top, below = plot_force(capture(), processed, FAST).axes
    (one,) = [o for o in processed.judged if o.press.take == FAST]
    rendered = line(top, "filter of 0.33 ms undone")
    np.testing.assert_array_equal(
        rendered.get_ydata(), one.press.force_cN[np.isin(one.press.t_s, rendered.get_xdata())]
    )
    read = line(top, "as read")
    change: Any = below.get_lines()[0]
    at = np.interp(change.get_xdata(), read.get_xdata(), read.get_ydata())
    inner = slice(1, -1)
    np.testing.assert_allclose(change.get_ydata()[inner], (rendered.get_ydata() - at)[inner], atol=1e-9)


def test_the_path_goes_through_its_samples_with_a_colour_for_each_stroke() -> None:
    processed = recorded().processed
    (ax,) = plot_displacement(processed, FAST).axes
    tracks = [t for group in processed.tracks for t in group if t.take == FAST]
    assert len(tracks) == 2
    drawn = [line(ax, str(track.stroke)) for track in tracks]
    for one, track in zip(drawn, tracks, strict=True):
        np.testing.assert_array_equal(one.get_ydata(), track.displacement_mm)
    assert len({one.get_color() for one in drawn}) == 2
    assert {"circuit closed", "circuit open"} <= set(texts(ax.figure).splitlines())


def test_a_press_that_is_left_out_is_drawn_with_the_reason_and_without_a_path() -> None:
    (ax,) = plot_displacement(recorded().processed, SHORT_STROKE).axes
    assert "left out: did not reach the bottom" in ax.get_title(loc="left")
    assert not [one for one in ax.get_lines() if "path" in str(one.get_label())]


def test_a_take_that_is_not_there_is_refused() -> None:
    with pytest.raises(ModelError, match="no take 99"):
        plot_take(capture(), 99)
    with pytest.raises(ModelError, match="no press was seen in take 1"):
        plot_displacement(recorded().processed, 1)
    with pytest.raises(ModelError, match="no press was seen in take 2"):
        plot_force(capture(), recorded().processed, 2)


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
    recording, processed = replace(capture(), simulated=False), recorded().processed
    for figure in (
        plot_take(recording, FAST, simulated),
        plot_clocks(recording, processed, simulated),
        plot_force(recording, processed, FAST, simulated),
        plot_displacement(processed, FAST, simulated),
        plot_velocities(processed, simulated),
        plot_registration(processed, "press", 50.0, simulated=simulated),
        plot_averages(processed, simulated),
    ):
        assert ("simulated" in texts(figure)) is simulated
    assert "simulated" in texts(plot_take(capture(), FAST))
