"""Figures and report of a probe."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.device.twin import TwinDevice
from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.model.noticeable import LITERATURE
from fdvv.model.surface import ForceSurface
from fdvv.rendering.evaluation.probe_figures import method_curves, plot_vibrations, worst_vibrations
from fdvv.rendering.evaluation.probe_report import probe_report
from fdvv.rendering.evaluation.vibration_presses import NONE_ASKED, Playback
from fdvv.rendering.figures import plot_rendering
from fdvv.rendering.probe import ProbeResult, probe

MODEL = load_builtin("mx-clear")


@pytest.fixture(scope="module")
def result() -> ProbeResult:
    """Return a probe of a rig with an exciter."""
    surface = ForceSurface.of_model(MODEL, [50.0])
    return probe(TwinDevice(seed=2), MODEL, surface, [50.0], 3, playback=Playback(3))


def bars(ax: Any) -> list[tuple[float, float]]:
    return [tuple(line.get_xdata()) for line in ax.get_lines() if line.get_gid() == "noticed"]


def test_the_band_around_the_target_is_one_jnd_and_bars_are_where_most_presses_are_beyond(
    result: ProbeResult,
) -> None:
    curve = result.curves[0]
    ax = plot_rendering(method_curves({"rendered": result.curves}, simulated=True))[0, 0]
    edges = ax.collections[0].get_paths()[0].vertices[:, 1]
    jnd = LITERATURE.force_cN(curve.target_cN)
    assert edges.max() == pytest.approx((curve.target_cN + jnd).max())
    assert edges.min() == pytest.approx((curve.target_cN - jnd).min())
    marked = [any(low <= x <= high for low, high in bars(ax)) for x in curve.displacement_mm]
    np.testing.assert_array_equal(marked, (curve.total_JND > 1).mean(axis=0) > 0.5)


def test_vibration_is_drawn_as_it_was_asked_for_and_as_it_came(result: ProbeResult) -> None:
    axes = plot_vibrations(result.curves, simulated=True)
    assert axes.shape == (len(worst_vibrations(result.curves)), 2)
    shown = worst_vibrations(result.curves)[0].vibration.shown
    assert shown is not None
    drawn = [line.get_ydata() for line in axes[0, 0].get_lines()]
    for got, wanted in zip(drawn, (shown.without_m_s2, shown.with_m_s2, shown.asked_m_s2), strict=True):
        np.testing.assert_array_equal(got, wanted)
    error = result.curves[0].vibration.error
    assert error is not None
    steps = [patch.get_data().values for patch in axes[0, 1].patches]
    np.testing.assert_allclose(steps[0], np.maximum(error.own_m_s2, 0.01))
    assert axes[0, 0].get_title(loc="right") == "simulated"


def test_without_a_vibration_there_is_nothing_to_draw(result: ProbeResult) -> None:
    with pytest.raises(ModelError, match="one that was compared"):
        plot_vibrations([replace(c, vibration=NONE_ASKED) for c in result.curves])


def test_the_report_has_the_verdict_both_figures_and_every_source(result: ProbeResult) -> None:
    html = probe_report(result)
    found = result.to_dict()
    assert found["verdict"].replace("'", "&#39;") in html
    assert html.count("<svg") == 2
    for source in LITERATURE.sources:
        assert source.value.replace("'", "&#39;") in html
    plain = replace(result, curves=tuple(replace(c, vibration=NONE_ASKED) for c in result.curves))
    assert "Vibration was not asked for: the model has none." in probe_report(plain)
