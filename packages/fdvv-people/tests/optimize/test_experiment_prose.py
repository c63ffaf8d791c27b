from __future__ import annotations

import pytest

from fdvv_people.report.prose import effect_text, interval_text, p_text, sphericity_text, stars
from fdvv_people.stats.anova import AnovaEffect, Sphericity
from fdvv_people.stats.effect_size import Estimate


def effect(df: int = 5) -> AnovaEffect:
    met = Sphericity(0.5, 0.02, 0.001) if df > 1 else Sphericity(1.0)
    return AnovaEffect("button", df, 9 * df, 10.724, 1e-6, met, 0.0004, 1.0, 1.0, 0.5, 0.25)


@pytest.mark.parametrize(
    ("p", "text", "mark"),
    [
        (0.0004, "p < .001", "***"),
        (0.0099, "p = .010", "**"),
        (0.0371, "p = .037", "*"),
        (0.5, "p = .500", "n.s."),
        (1.0, "p = 1.000", "n.s."),
    ],
)
def test_p_is_written_as_papers_write_it(p: float, text: str, mark: str) -> None:
    assert (p_text(p), stars(p)) == (text, mark)


def test_an_effect_tells_corrected_freedom_epsilon_and_size() -> None:
    assert effect_text(effect()) == (
        "F(2.50, 22.50) = 10.72, p < .001 (Greenhouse-Geisser ε = 0.500), generalized η² = 0.250, "
        "partial η² = 0.500"
    )
    assert effect_text(effect(1)).startswith("F(1, 9) = 10.72, p < .001, ")


def test_sphericity_is_reported_where_it_applies() -> None:
    assert sphericity_text(effect()) == "Sphericity of button is rejected (Mauchly's W = 0.02, p = .001)."
    assert sphericity_text(effect(1)) == ""


def test_an_interval_holds_together_and_may_be_absent() -> None:
    assert interval_text(Estimate(0.2, 0.1, 0.3), 0, 100.0) == "20\N{NO-BREAK SPACE}[10,\N{NO-BREAK SPACE}30]"
    assert interval_text(Estimate(-1.25), 1) == "-1.2"
