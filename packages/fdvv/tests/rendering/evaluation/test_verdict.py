"""The verdict of a probe in words."""

from dataclasses import replace

import numpy as np
import pytest

from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.jnd_file import jnds_of
from fdvv.model.noticeable import LITERATURE
from fdvv.model.surface import ForceSurface
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.evaluation.verdict import (
    STEPS,
    RenderingMeans,
    headline,
    next_step,
    outcome_words,
    short_outcome,
    verdict,
)
from fdvv.rendering.evaluation.vibration_presses import NONE_ASKED, RenderedVibration
from fdvv.rendering.probe import probe
from fdvv.testing.scripted import ScriptedDevice
from fdvv.vibration.compare import VibrationError
from tests.support.jnds import as_literature, record_of

MODEL = load_builtin("mx-clear")
SNAP = MODEL.vibrations[0]
PLAYED = VibrationError(
    played=True,
    asked_m_s2=(1.0,) * 4,
    own_m_s2=(1.0,) * 4,
    own_dB=3.0,
    level_JND=0.6,
    compared_ms=20.0,
    added_m_s2=(0.6,) * 4,
    level_dB=-4.2,
    onset_ms=0.3,
    onset_mm=0.03,
    likeness=0.9,
    onset_JND=0.05,
)
SILENT = replace(
    PLAYED, played=False, level_dB=None, onset_ms=None, added_m_s2=None, own_dB=-6.0, onset_JND=None
)
LEARNED = RenderingMeans(learned=True, exciter=True)


@pytest.fixture(scope="module")
def curves() -> list[ProbeCurve]:
    """Return a press and a release without an error, without a vibration asked for."""
    found = probe(ScriptedDevice(), MODEL, ForceSurface.of_model(MODEL, [100.0]), [100.0], 2).curves
    return [
        replace(c, rendered_cN=np.tile(c.target_cN, (2, 1)), reached_ratio=1.0, vibration=NONE_ASKED)
        for c in found
    ]


def off(curve: ProbeCurve, places: int) -> ProbeCurve:
    """Return a curve that is off by two JNDs in its first places."""
    step_cN = np.where(
        np.arange(curve.target_cN.size) < places, 2 * LITERATURE.force_cN(curve.target_cN), 0.0
    )
    return replace(curve, rendered_cN=np.tile(curve.target_cN + step_cN, (2, 1)))


def with_vibration(curves: list[ProbeCurve], error: VibrationError) -> list[ProbeCurve]:
    return [replace(c, vibration=RenderedVibration(SNAP, error=error)) for c in curves]


def test_a_perfect_force_without_a_vibration(curves: list[ProbeCurve]) -> None:
    assert verdict(curves) == (
        "By JNDs from the literature, a finger would not notice the force on 100 % of the press and 100 % of "
        "the release; no vibration was asked for."
    )
    assert next_step(curves, LEARNED) == STEPS["people"]


def test_the_share_is_that_of_the_places(curves: list[ProbeCurve]) -> None:
    count = curves[0].target_cN.size
    found = verdict([off(curves[0], count // 4), curves[1]])
    share = 100 - 100 * (count // 4) / count
    assert f"{share:.0f} % of the press and 100 % of the release" in found


def test_the_headline_says_what_fell_to_what_and_at_which_speeds_a_finger_notices(
    curves: list[ProbeCurve],
) -> None:
    count = curves[0].target_cN.size
    bad = [off(curve, count) for curve in curves]
    fine = [replace(curve, velocity_mm_s=50.0) for curve in curves]
    worst_cN = max(float(np.abs(c.rendered_cN - c.target_cN).max()) for c in bad)
    assert headline(fine, bad).startswith("Mean error ")
    assert f" → 0.0 cN, largest {worst_cN:.0f} → 0.0 cN; a finger would not notice it" in headline(fine, bad)
    by = ", by JNDs from the literature"
    assert headline([*fine, *bad]).endswith("; a finger would notice it at 100 mm/s only" + by)
    assert headline(bad).endswith("a finger would notice it" + by)
    three = [*fine, *bad, *(replace(c, velocity_mm_s=200.0) for c in bad)]
    assert headline(three).endswith("at 100 and 200 mm/s only" + by)
    assert headline(three[2:]).endswith("at every speed" + by)
    assert headline([]) == ""
    assert headline(fine, bad, "simulated presses").count(" cN on simulated presses, largest ") == 1
    # a tenth of a stroke and less counts as little, as for the next step
    assert "would not" in headline([off(curves[0], count // 11), curves[1]])


def test_the_verdict_flips_with_what_people_notice_and_says_whose_jnds_judged(
    curves: list[ProbeCurve],
) -> None:
    bad = [off(curve, curve.target_cN.size) for curve in curves]  # by two JNDs from the literature
    dull = jnds_of(record_of(as_literature("force", 3.0)))
    judged = [replace(curve, jnds=dull) for curve in bad]
    by = "JNDs of force of 12 people of study weights"
    assert headline(bad).endswith("; a finger would notice it, by JNDs from the literature")
    assert headline(judged).endswith(f"; a finger would not notice it, by {by}")
    assert verdict(bad).startswith("By JNDs from the literature, a finger would not notice the force on 0 %")
    assert verdict(judged).startswith(f"By {by}, a finger would not notice the force on 100 %")
    assert next_step(bad, LEARNED) != next_step(judged, LEARNED) == STEPS["people"]


def test_what_became_of_the_vibration_is_said_in_its_own_numbers(curves: list[ProbeCurve]) -> None:
    found = verdict(with_vibration(curves[:1], PLAYED))
    assert found.endswith("the 239 Hz vibration at 2.3 mm comes 0.3 ms late and 4 dB weak (0.6 JND, press).")


@pytest.mark.parametrize(
    ("error", "words", "short"),
    [
        (
            replace(PLAYED, onset_ms=0.05, level_dB=0.2),
            "comes on time and as strong as asked",
            "on time, as strong",
        ),
        (
            replace(PLAYED, onset_ms=-2.0, level_dB=3.0),
            "comes 2.0 ms early and 3 dB strong",
            "2.0 ms early, 3 dB",
        ),
        (
            replace(PLAYED, onset_ms=None),
            "cannot be found beside the cap's own motion, 3 dB above it",
            "not found",
        ),
        (replace(PLAYED, level_dB=-60.0), "does not reach the cap; its own motion is 3 dB above it", ""),
        (SILENT, "is not played; the cap's own motion is 6 dB below it", "not played"),
    ],
)
def test_every_outcome_has_its_words(error: VibrationError, words: str, short: str) -> None:
    rendered = RenderedVibration(SNAP, error=error)
    assert outcome_words(rendered) == words
    assert short in short_outcome(rendered)


def test_what_could_not_be_measured_says_why(curves: list[ProbeCurve]) -> None:
    lost = [replace(curves[0], vibration=RenderedVibration(SNAP, "not measured: too short"))]
    assert verdict(lost).endswith("; the vibration was not measured: too short.")
    assert short_outcome(lost[0].vibration) == "not measured"
    assert short_outcome(NONE_ASKED) == "not asked for"


@pytest.mark.parametrize(
    ("places", "error", "means", "step"),
    [
        (30, None, RenderingMeans(learned=False), "learn"),
        (30, None, LEARNED, "rig"),
        (30, None, replace(LEARNED, force_loop=True), "more"),
        (0, replace(PLAYED, level_JND=1.5), LEARNED, "identify"),
        (0, replace(PLAYED, level_JND=1.5), replace(LEARNED, exciter_known=True), "tune"),
        (0, PLAYED, LEARNED, "people"),
        (0, replace(SILENT, level_JND=1.2), replace(LEARNED, exciter=False), "fit"),
        (0, SILENT, replace(LEARNED, exciter=False), "people"),
        (0, SILENT, LEARNED, "play"),
    ],
)
def test_the_next_step_follows_from_what_is_noticed_and_what_the_rig_has(
    curves: list[ProbeCurve], places: int, error: VibrationError | None, means: RenderingMeans, step: str
) -> None:
    found = [off(curves[0], places)]
    shown = with_vibration(found, error) if error else found
    assert next_step(shown, means) == STEPS[step]


def test_a_missed_speed_is_named_where_it_explains_the_error(curves: list[ProbeCurve]) -> None:
    wrong = off(curves[0], 30)
    missed = replace(wrong, at_achieved_cN=wrong.rendered_cN)
    assert next_step([missed], replace(LEARNED, force_loop=True)) == STEPS["pace"]


def test_a_cap_that_does_not_come_back_comes_first(curves: list[ProbeCurve]) -> None:
    stuck = [replace(c, reached_ratio=0.8) if c.stroke is Stroke.RELEASE else c for c in curves]
    assert next_step(stuck, RenderingMeans(learned=False)) == STEPS["stuck"]


def test_nothing_probed_has_no_verdict() -> None:
    assert verdict([]) == next_step([], LEARNED) == ""
