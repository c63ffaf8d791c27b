"""One verdict per curve, and lines that name number, place and remedy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.feasibility.limits import AchievableStroke, RigLimits
from fdvv.compensation.feasibility.stability import Slope, Stability
from fdvv.compensation.feasibility.thermal import ThermalDose
from fdvv.compensation.feasibility.verdict import Following, FollowVerdict, follow_verdict
from fdvv.protocol.tables import Settings

LIMITS = RigLimits.of_settings(Settings())
X_mm = np.linspace(0.0, 4.0, 401)
NONE = np.zeros(401, dtype=bool)
REACHED = AchievableStroke(X_mm, 60 + 0 * X_mm, 60 + 0 * X_mm, 80 + 0 * X_mm, NONE, NONE, 0.2, None, None)
STABLE = Stability(Slope(60.0, 1.8, 50.0, 30.0, 1.5, 55.0), 40.0, 500.0, 90.0, 300.0, 10.0, 1.7, 20.0)
DOSE = ThermalDose(90.0, 0.13, 100.0, 30.0, 5.0, 3.0, None, None)


def judged(
    reached: AchievableStroke = REACHED,
    stable: Stability = STABLE,
    dose: ThermalDose = DOSE,
    stop_mm: float | None = None,
) -> FollowVerdict:
    return follow_verdict(reached, LIMITS, stable, dose, stop_mm)


def cut(missing_cN: float) -> AchievableStroke:
    rows = ((X_mm > 1.0) & (X_mm < 1.5)) | (X_mm > 3.0)
    return replace(
        REACHED,
        saturated=rows,
        achievable_cN=np.where(rows, 60.0 - missing_cN, 60.0),
        command_cN=np.where(X_mm > 3.0, 512.0, 460.0),
    )


def test_a_curve_that_nothing_hinders_is_followed_without_a_reason() -> None:
    assert judged() == FollowVerdict(Following.FOLLOWS, ())
    assert str(judged()) == "can follow"


def test_a_cut_command_names_the_limit_the_places_and_what_is_missing() -> None:
    verdict = judged(cut(9.0))
    assert verdict.following is Following.PARTLY
    assert verdict.reasons == (
        "needs a command of 512 cN at 3.01 mm, the limit is 440: up to 9 cN are missing between 1.01 and "
        "1.49 mm and between 3.01 and 4.00 mm; lower the force there, or press slower",
    )


def test_a_curve_that_loses_a_quarter_of_its_force_cannot_be_followed() -> None:
    assert judged(cut(59.0)).following is Following.CANNOT


@pytest.mark.parametrize(
    ("kept", "following"), [(0.95, Following.FOLLOWS), (0.7, Following.PARTLY), (0.3, Following.CANNOT)]
)
def test_the_bump_decides_by_the_part_that_is_left(kept: float, following: Following) -> None:
    verdict = judged(replace(REACHED, drop_cN=20.0, kept_ratio=kept))
    assert verdict.following is following
    assert all(f"{100 * kept:.0f} % of the bump's drop of 20 cN are left" in r for r in verdict.reasons)


@pytest.mark.parametrize(
    ("onset", "following", "message"),
    [
        (300.0, Following.FOLLOWS, None),
        (66.0, Following.PARTLY, "may buzz under a finger"),
        (28.0, Following.CANNOT, "buzzes under a finger"),
    ],
)
def test_a_rise_is_held_against_the_onset(onset: float, following: Following, message: str | None) -> None:
    verdict = judged(stable=replace(STABLE, finger_cN_mm=onset))
    assert verdict.following is following
    if message:
        assert verdict.reasons == (
            f"{message}: it rises by 60 cN/mm, stable up to {onset:.0f}: shorten the loop, or soften the "
            "rise between 1.75 and 1.85 mm",
        )


def test_a_step_between_strokes_is_a_reason_but_never_forbids() -> None:
    verdict = judged(stable=replace(STABLE, step_cN=90.0))
    assert verdict.following is Following.PARTLY
    assert "release lies 90 cN below press at 1.70 mm, stable up to 20" in verdict.reasons[0]


def test_warmth_is_expressed_in_presses_a_minute_and_seconds_held() -> None:
    verdict = judged(dose=replace(DOSE, presses_per_min=40.0, held_s=4.0))
    assert verdict.following is Following.PARTLY
    assert "more than 40 presses a minute (90 cN rms)" in verdict.reasons[0]
    assert "after 4.0 s held at the bottom (100 cN)" in verdict.reasons[1]
    assert judged(dose=replace(DOSE, presses_per_min=0.0)).following is Following.CANNOT


def test_a_travel_beyond_the_stop_cannot_be() -> None:
    assert judged(stop_mm=4.0).following is Following.FOLLOWS
    verdict = judged(stop_mm=3.5)
    assert verdict.following is Following.CANNOT
    assert verdict.reasons == ("its travel is 4 mm, the stop allows 3.5: shorten the button",)


def test_the_gravest_reason_comes_first() -> None:
    verdict = judged(cut(9.0), replace(STABLE, finger_cN_mm=10.0))
    assert [r.split()[0] for r in verdict.reasons] == ["buzzes", "needs"]


def test_a_slew_limit_is_expressed_per_tick() -> None:
    rows = (X_mm > 1.0) & (X_mm < 1.2)
    lagging = replace(REACHED, slewed=rows, achievable_cN=np.where(rows, 52.0, 60.0))
    (reason,) = judged(lagging).reasons
    assert reason.startswith(
        f"changes faster than {LIMITS.slew_cN_tick:.0f} cN per tick between 1.01 and 1.19 mm"
    )
    assert "up to 8 cN are missing" in reason


def test_the_loss_by_smear_alone_is_reported() -> None:
    (reason,) = judged(replace(REACHED, achievable_cN=REACHED.intended_cN + 3.0)).reasons
    assert reason.startswith("holding and lag smear 3.0 cN of it on average")
