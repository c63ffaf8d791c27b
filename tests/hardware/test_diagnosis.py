"""Every part is judged by evidence that is its own; what rests on a bad part is not judged."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv_rig.selftest.diagnosis import Bounds, Verdict, diagnose
from fdvv_rig.selftest.evidence import Evidence, Latched, Lift

SOUND = Evidence(
    nominal_mV=12000.0,
    supply_mV=12010.0,
    rest_sd_um=5.0,
    gauge_mm=(4.52, 2.01),
    free_stop_mm=5.0,
    fallen_mm=5.02,
    stops_mm=((3.5, 3.6), (2.0, 2.1)),
    empty=Lift(32.0, 11.0),
    loaded=Lift(84.0, 60.0),
    hard_mm=-0.1,
    weight_cN=49.03,
    sensor_zero_cN=0.1,
    sensor_weight_cN=49.2,
    vibration_answers=True,
    tone_um=2.8,
    tone_floor_um=0.4,
    tone_ratio=50.0,
    pwm_um=0.6,
    pwm_floor_um=0.6,
)


def named(**changes: object) -> str | None:
    wrong = diagnose(replace(SOUND, **changes)).wrong  # type: ignore[arg-type]
    return wrong.part if wrong else None


def test_a_sound_rig_passes() -> None:
    found = diagnose(SOUND)
    assert found.passed
    assert found.wrong is None


@pytest.mark.parametrize(
    ("part", "changes"),
    [
        ("supply", {"supply_mV": 9600.0}),
        ("supply", {"sag_mV": 10900.0}),
        ("supply", {"faults": (Latched("supply_low", 8000, 9000),)}),
        ("link", {"link_missing": 0.1}),
        ("link", {"late_ticks": 3}),
        ("position sensor", {"gauge_mm": (-4.52, -2.01)}),
        ("position sensor", {"gauge_mm": (3.6, 1.6)}),
        ("position sensor", {"gauge_mm": (5.1, 2.6)}),
        ("position sensor", {"gauge_mm": (0.0, 0.0), "rest_sd_um": 0.0}),
        ("position sensor", {"rest_sd_um": 120.0}),
        ("position sensor", {"gauge_mm": (), "faults": (Latched("position_low", 0, 20),)}),
        ("slider", {"empty": Lift(), "fallen_mm": 2.02, "stops_mm": ((3.5, 2.01), (2.0, 2.01))}),
        ("slider", {"empty": Lift(70.0, -20.0)}),
        ("travel stop", {"fallen_mm": 4.3, "stops_mm": ((3.5, 4.3), (2.0, 4.3))}),
        ("travel stop", {"fallen_mm": 6.1, "stops_mm": ((3.5, 4.6), (2.0, 3.1))}),
        ("coil", {"empty": Lift(-10.0, -31.0, reversed=True)}),
        ("coil", {"empty": Lift(), "loaded": Lift()}),
        ("coil", {"empty": Lift(60.0, 30.0), "loaded": Lift(165.0, 130.0)}),
        ("coil", {"loaded": Lift()}),
        ("coil driver", {"pwm_um": 9.0}),
        ("coil driver", {"faults": (Latched("output", 0, 0),)}),
        ("force sensor", {"sensor_weight_cN": 0.1}),
        ("force sensor", {"sensor_weight_cN": -49.0}),
        ("force sensor", {"sensor_weight_cN": 33.0}),
        ("force sensor", {"sensor_zero_cN": 20.0, "sensor_weight_cN": 69.0}),
        ("vibration board", {"vibration_answers": False}),
        ("vibration board", {"faults": (Latched("vibration_board", 0, 0),)}),
        ("exciter", {"tone_um": 0.4, "tone_ratio": 1.2}),
    ],
)
def test_what_was_seen_names_its_part(part: str, changes: dict[str, object]) -> None:
    found = diagnose(replace(SOUND, **changes))  # type: ignore[arg-type]
    assert found.wrong is not None
    assert found.wrong.part == part, found.wrong
    assert found.wrong.remedy
    assert not found.passed


def test_what_rests_on_a_bad_part_is_not_judged() -> None:
    found = {f.part: f.verdict for f in diagnose(replace(SOUND, gauge_mm=(-4.5, -2.0))).findings}
    assert found["position sensor"] == Verdict.FAILED
    assert found["slider"] == found["coil"] == found["exciter"] == Verdict.NOT_TESTED
    assert found["force sensor"] == Verdict.PASSED


def test_nothing_measured_is_never_taken_for_sound() -> None:
    found = diagnose(Evidence())
    assert not found.passed
    assert all(f.verdict is not Verdict.PASSED for f in found.findings if f.part in ("coil", "force sensor"))


def test_parts_that_are_not_fitted_do_not_fail() -> None:
    found = diagnose(replace(SOUND, has_sensor=False, has_exciter=False, vibration_answers=None))
    assert found.passed
    assert [f.part for f in found.findings if f.verdict == Verdict.ABSENT] == [
        *("force sensor", "vibration board", "exciter")
    ]


@given(
    gain=st.floats(0.8, 1.25),
    weight=st.floats(8.0, 45.0),
    friction=st.floats(2.0, 12.0),
    late=st.floats(0, 4),
)
def test_the_coils_gain_does_not_depend_on_the_movers_weight_or_friction(
    gain: float, weight: float, friction: float, late: float
) -> None:
    def lift(cN: float) -> Lift:
        return Lift((cN + friction) / gain + late, (cN - friction) / gain - late)

    evidence = replace(SOUND, empty=lift(weight), loaded=lift(weight + 49.03))
    assert evidence.gain == pytest.approx(gain)
    assert diagnose(evidence).passed


@given(scale=st.floats(0.4, 1.6))
def test_a_scale_is_reported_exactly_when_it_is_beyond_its_bound(scale: float) -> None:
    found = named(gauge_mm=(4.5 * scale, 2.0 * scale))
    assert (found == "position sensor") == (abs(scale - 1) > Bounds().scale_ratio)
