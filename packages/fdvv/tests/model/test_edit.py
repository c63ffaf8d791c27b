from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.edit import assign, copy_curve, merge, remove_curve
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.spread import CurveSpread, PointSpread, VibrationSpread
from fdvv.model.velocity import Interpolation
from fdvv.model.vibration import Mode, Vibration

CLEAR = load_builtin("mx-clear")
X_mm = np.linspace(0, 4, 401)


def curve(force_cN: float, stroke: str = "press", velocity_mm_s: float | None = 50.0) -> ForceCurve:
    return ForceCurve(Stroke(stroke), velocity_mm_s, 1, [0, 0, 4, 4], [0, force_cN])  # type: ignore[arg-type]


def buzz(frequency_Hz: float) -> Vibration:
    return Vibration(Stroke.PRESS, None, 2.0, 0.01, (Mode(frequency_Hz, 1.0, 10.0),))


def model(name: str, *curves: ForceCurve, travel_mm: float = 4.0, **fields: object) -> FDVVModel:
    return FDVVModel(name, travel_mm, curves, **fields)  # type: ignore[arg-type]


def test_single_curves_merge_into_the_model_they_came_from() -> None:
    merged = merge(reversed(CLEAR.curves), "again")
    at = (X_mm[:, np.newaxis], np.array([0.5, 30.0, 125.0, 300.0]))
    for stroke in Stroke:
        np.testing.assert_array_equal(merged.force_cN(*at, stroke), CLEAR.force_cN(*at, stroke))
    assert merged.travel_mm == 4.0


def test_models_merge_with_their_points_vibrations_and_provenance() -> None:
    slow = model(
        "slow", curve(60, velocity_mm_s=1.0), actuation_mm=2.0, provenance=Provenance(source="bench")
    )
    fast = model(
        "fast",
        curve(80, velocity_mm_s=100.0),
        reset_mm=1.5,
        vibrations=(buzz(239.0),),
        provenance=Provenance(source="twin", assumptions=("guessed",), simulated=True),
    )
    merged = merge([slow, fast], "both")
    assert merged.velocities_mm_s("press") == (1.0, 100.0)
    assert (merged.actuation_mm, merged.reset_mm) == (2.0, 1.5)
    assert merged.vibrations == (buzz(239.0),)
    assert merged.provenance == Provenance(
        source="bench; twin", method="merged from slow, fast", assumptions=("guessed",), simulated=True
    )


def test_merging_a_model_with_itself_changes_nothing_but_name_and_provenance() -> None:
    merged = merge([CLEAR, CLEAR], "twice")
    assert replace(merged, name=CLEAR.name, provenance=CLEAR.provenance) == CLEAR


def test_two_curves_of_one_stroke_and_velocity_are_refused_by_the_names_of_both() -> None:
    parts = [model("left", curve(60)), model("right", curve(70))]
    with pytest.raises(ModelError, match=r"two different curves for press at 50 mm/s.*'left'.*'right'"):
        merge(parts, "both")


def test_two_vibrations_of_one_stroke_are_a_conflict_too() -> None:
    parts = [
        model("left", curve(60), vibrations=(buzz(200.0),)),
        model("right", curve(60, "release"), vibrations=(buzz(300.0),)),
    ]
    with pytest.raises(ModelError, match=r"two different vibrations for press at unknown velocity"):
        merge(parts, "both")
    assert merge(parts, "both", conflict="last").vibrations == (buzz(300.0),)


@pytest.mark.parametrize(
    ("field", "left", "right"),
    [
        ("travel_mm", 4.0, 3.6),
        ("actuation_mm", 2.0, 1.8),
        ("reset_mm", 1.5, 1.8),
        ("interpolation", Interpolation.LINEAR, Interpolation.PCHIP),
    ],
)
def test_parts_that_differ_are_refused_by_the_names_of_both_unless_an_argument_decides(
    field: str, left: object, right: object
) -> None:
    parts = [
        replace(model("left", curve(60)), **{field: left}),  # type: ignore[arg-type]
        replace(model("right", curve(60, "release")), **{field: right}),  # type: ignore[arg-type]
    ]
    with pytest.raises(ModelError, match=rf"differ in {field}: {left} in 'left' and {right} in 'right'"):
        merge(parts, "both")
    assert getattr(merge(parts, "both", **{field: right}), field) == right  # type: ignore[arg-type]


def test_single_curves_that_end_apart_need_a_travel() -> None:
    short = ForceCurve(Stroke.RELEASE, 50.0, 1, [0, 0, 3.6, 3.6], [0, 1])  # type: ignore[arg-type]
    said = r"differ in travel_mm: 4\.0 in 'press at 50 mm/s' and 3\.6 in 'release at 50 mm/s'"
    with pytest.raises(ModelError, match=said):
        merge([curve(60), short], "both")
    assert merge([curve(60), short], "both", travel_mm=3.8).travel_mm == 3.8


def test_nothing_merges_into_nothing() -> None:
    with pytest.raises(ModelError, match="at least one"):
        merge([], "none")
    with pytest.raises(ModelError, match="at least one"):
        merge([], "none", travel_mm=4.0)


def test_an_assigned_curve_replaces_the_one_at_its_place_and_leaves_the_rest() -> None:
    edited = assign(CLEAR, curve(75), "release", 100.0)
    assert float(edited.force_cN(4.0, 100.0, "release")) == 75.0
    untouched = [c for c in edited.curves if (c.stroke, c.velocity_mm_s) != (Stroke.RELEASE, 100.0)]
    assert all(any(c is old for old in CLEAR.curves) for c in untouched)
    assert len(untouched) == 9
    assert edited.provenance.method.endswith("; release at 100 mm/s assigned from press at 50 mm/s")


def test_a_segment_needs_a_curve_to_go_into() -> None:
    with pytest.raises(ModelError, match=r"has no press curve at 75 mm/s; it has press at 0.5 mm/s"):
        assign(CLEAR, curve(75), "press", 75.0, segment_mm=(1.0, 2.0))


def test_a_copied_curve_is_the_same_at_its_new_place() -> None:
    edited = copy_curve(CLEAR, "press", 200.0, "press", 300.0)
    np.testing.assert_array_equal(edited.force_cN(X_mm, 300.0), CLEAR.force_cN(X_mm, 200.0))
    assert len(edited.curves) == 11


def test_a_removed_curve_is_gone() -> None:
    edited = remove_curve(CLEAR, "press", 150.0)
    assert edited.velocities_mm_s("press") == (0.5, 50.0, 100.0, 200.0)
    assert edited.vibrations == CLEAR.vibrations


def test_the_last_curve_cannot_be_removed() -> None:
    with pytest.raises(ModelError, match="press at 50 mm/s is the only curve of 'one'"):
        remove_curve(model("one", curve(60)), "press", 50.0)


def test_a_curve_that_is_not_there_cannot_be_copied_or_removed() -> None:
    with pytest.raises(ModelError, match="no release curve at 75 mm/s"):
        remove_curve(CLEAR, "release", 75.0)
    with pytest.raises(ModelError, match="no release curve at unknown velocity"):
        copy_curve(CLEAR, "release", None, "press", 50.0)


SPREAD = CurveSpread(np.array([0.0, 2.0, 4.0]), np.array([1.0, 2.0, 1.0]), 15, 48.0, 4.0)
OTHER = CurveSpread(np.array([0.0, 2.0, 4.0]), np.array([1.0, 2.0, 1.0]), 12, 48.0, 4.0)


def measured(name: str = "measured", **fields: object) -> FDVVModel:
    """A button whose press at 50 mm/s, release at 50 mm/s and points were measured on presses."""
    press, release = (replace(curve(60, stroke), spread=SPREAD) for stroke in ("press", "release"))
    given: dict[str, object] = {"actuation_mm": 2.0, "actuation_spread": PointSpread(0.03, 15)} | fields
    return model(name, press, release, travel_spread=PointSpread(0.01, 15), **given)  # type: ignore[arg-type]


def spreads(found: FDVVModel) -> dict[tuple[str, float | None], CurveSpread | None]:
    return {(str(c.stroke), c.velocity_mm_s): c.spread for c in found.curves}


def test_a_merge_keeps_spreads_of_curves_points_and_vibrations() -> None:
    shaken = replace(buzz(239.0), spread=VibrationSpread(11, 0.05))
    merged = merge([measured(vibrations=(shaken,)), curve(80, velocity_mm_s=100.0)], "both")
    assert spreads(merged) == {("press", 50.0): SPREAD, ("release", 50.0): SPREAD, ("press", 100.0): None}
    assert merged.vibrations[0].spread == VibrationSpread(11, 0.05)
    assert merged.travel_spread == PointSpread(0.01, 15)
    assert merged.actuation_spread == PointSpread(0.03, 15)


def test_a_point_that_is_given_to_a_merge_was_not_measured() -> None:
    merged = merge([measured()], "moved", actuation_mm=1.5, travel_mm=3.9)
    assert (merged.actuation_spread, merged.travel_spread) == (None, None)
    assert merge([measured()], "same", actuation_mm=2.0).actuation_spread == PointSpread(0.03, 15)


def test_a_point_with_two_different_spreads_keeps_neither() -> None:
    parts = [measured(), measured("again", actuation_spread=PointSpread(0.05, 9))]
    assert merge(parts, "both").actuation_spread is None


@pytest.mark.parametrize("turned", [False, True])
def test_of_equal_curves_and_vibrations_the_one_that_knows_its_spread_is_kept(turned: bool) -> None:
    shaken = replace(buzz(239.0), spread=VibrationSpread(11, 0.05))
    knowing = measured(vibrations=(shaken,))
    plain = model("plain", curve(60), curve(60, "release"), vibrations=(buzz(239.0),))
    merged = merge([knowing, plain][:: -1 if turned else 1], "both")
    assert set(spreads(merged).values()) == {SPREAD}
    assert merged.vibrations == (shaken,)


def test_equal_curves_of_different_spreads_are_a_conflict() -> None:
    other = model("other", replace(curve(60), spread=OTHER))
    with pytest.raises(ModelError, match="two different curves for press at 50 mm/s"):
        merge([measured(), other], "both")
    assert spreads(merge([measured(), other], "both", conflict="last"))["press", 50.0] == OTHER


def test_a_curve_assigned_to_where_it_was_measured_keeps_its_spread() -> None:
    fresh = replace(curve(70), spread=OTHER)
    assert spreads(assign(measured(), fresh, "press", 50.0))["press", 50.0] == OTHER


@pytest.mark.parametrize(("stroke", "velocity_mm_s"), [("release", 50.0), ("press", 100.0), ("press", None)])
def test_a_curve_assigned_to_another_stroke_or_velocity_was_not_measured_there(
    stroke: str, velocity_mm_s: float | None
) -> None:
    fresh = replace(curve(70), spread=OTHER)
    edited = assign(model("one", curve(60, stroke, velocity_mm_s)), fresh, stroke, velocity_mm_s)
    assert spreads(edited)[stroke, velocity_mm_s] is None


def test_a_segment_makes_a_curve_that_was_not_measured_and_leaves_the_others() -> None:
    edited = assign(measured(), replace(curve(70), spread=OTHER), "press", 50.0, segment_mm=(1.0, 2.0))
    assert spreads(edited) == {("press", 50.0): None, ("release", 50.0): SPREAD}
    assert edited.travel_spread == PointSpread(0.01, 15)


def test_removing_and_renaming_keep_what_was_measured_of_the_rest() -> None:
    left = remove_curve(measured(), "release", 50.0).renamed("left")
    assert spreads(left) == {("press", 50.0): SPREAD}
    assert left.actuation_spread == PointSpread(0.03, 15)
