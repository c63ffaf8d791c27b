import functools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.button.figures import plot_fit, plot_scan
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.fit import CurveFit, fit_curve
from fdvv.model.model import FDVVModel, Provenance
from fdvv.rendering.figures import plot_convergence, plot_rendering
from fdvv.report.model_figures import plot_comparison, plot_model, plot_surface, plot_vibration
from fdvv.report.records import ErrorHistory, RenderedBand, RenderedCurve
from tests.support.gallery import Gallery

Draw = Callable[[FDVVModel, MeasuredCurve, list[CurveFit], bool], Any]
_SCORES = {"uniform": {5: 40.0, 6: 20.0, 7: 30.0}, "adaptive": {5: 30.0, 6: 12.0, 7: 11.0}}


def _rendered(model: FDVVModel) -> list[RenderedCurve]:
    x = np.linspace(0.0, model.travel_mm, 41)
    curves = []
    for stroke in Stroke:
        for velocity in (200.0, 50.0):
            target = model.force_cN(x, velocity, stroke)
            bands = tuple(
                RenderedBand(method, target + bias, target + bias - 1.0, target + bias + 2.0)
                for method, bias in (("FD only", 6.0), ("FDVV", 0.5))
            )
            curves.append(RenderedCurve(stroke, velocity, x, target, bands))
    return curves


def _histories() -> list[ErrorHistory]:
    return [
        ErrorHistory(stroke, velocity, np.array([velocity, 12.0, 5.0, 3.0]))
        for stroke in Stroke
        for velocity in (100.0, 50.0)
    ]


FIGURES: dict[str, Draw] = {
    "model": lambda model, measured, fits, said: plot_model(model, simulated=said),
    "surface": lambda model, measured, fits, said: plot_surface(model, "release", simulated=said),
    "comparison": lambda model, measured, fits, said: plot_comparison(
        [model, replace(model, name="other")], simulated=said
    ),
    "vibration": lambda model, measured, fits, said: plot_vibration(model, simulated=said),
    "fit": lambda model, measured, fits, said: plot_fit(measured, fits, simulated=said),
    "scan": lambda model, measured, fits, said: plot_scan(_SCORES, simulated=said),
    "rendering": lambda model, measured, fits, said: plot_rendering(_rendered(model)[::2], simulated=said),
    "convergence": lambda model, measured, fits, said: plot_convergence(_histories(), simulated=said),
}


@pytest.fixture(scope="session")
def gallery(model: FDVVModel, measured: MeasuredCurve, fits: list[CurveFit]) -> Gallery:
    return Gallery({name: functools.partial(draw, model, measured, fits) for name, draw in FIGURES.items()})


@pytest.fixture(params=FIGURES)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="session")
def names() -> list[str]:
    return list(FIGURES)


@pytest.fixture
def rendered(model: FDVVModel) -> list[RenderedCurve]:
    return _rendered(model)


@pytest.fixture
def histories() -> list[ErrorHistory]:
    return _histories()


@pytest.fixture
def scores() -> dict[str, dict[int, float]]:
    return _SCORES


@pytest.fixture(scope="session")
def model() -> FDVVModel:
    return load_builtin("mx-clear")


@pytest.fixture(scope="session")
def simulated_model(model: FDVVModel) -> FDVVModel:
    return replace(model, name="twin of mx-clear", provenance=Provenance(simulated=True))


@pytest.fixture(scope="session")
def measured(model: FDVVModel) -> MeasuredCurve:
    noise = np.random.default_rng(3).normal(0.0, 0.3, 401)
    x = np.round(np.linspace(0.0, 4.0, 401), 2)
    return MeasuredCurve(x, model.of(Stroke.PRESS)[0].force_cN(x) + noise, Stroke.PRESS)


@pytest.fixture(scope="session")
def fits(measured: MeasuredCurve) -> list[CurveFit]:
    return [fit_curve(measured, "uniform", 15), fit_curve(measured, "adaptive", 12)]
