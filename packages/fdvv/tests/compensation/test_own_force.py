"""A rig's own force over displacement and its other friction: identified, explained, kept, used."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest

from fdvv.compensation.feasibility.limits import finger_force_cN, inverse_dynamics_cN, minimum_jerk
from fdvv.compensation.identification.drift import detect_drift
from fdvv.compensation.identification.excitation import identification_surface
from fdvv.compensation.identification.identify import identify
from fdvv.compensation.identification.rig_file import load_rig, save_rig
from fdvv.compensation.identification.rig_model import Plausible, Prior, RigModel
from fdvv.compensation.rig_aware import explain_rig
from fdvv.compensation.rig_learning import command_cN
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from tests.support.other_rigs import OtherRig, presses_of

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
TRAVEL_mm = 4.0
SPRUNG = OtherRig(spring_N_m=50.0, spring_free_m=1.5e-3, detent_N=0.03, detent_m=1.7e-3)
BINDING = OtherRig(friction_N=0.02, binding_N=0.08, binding_m=1.5e-3)
OWN = RigModel(
    gain=(0.9, 0.05, -0.01),
    friction_cN=3.0,
    stick_cN=2.0,
    side_ratio=0.04,
    weight_cN=12.0,
    mass_g=20.0,
    own_cN=(-8.0, -2.0, 5.0, 3.0, 2.0),
    own_step_mm=1.0,
)


def pressed(rigs: list[OtherRig], seed: int = 1) -> list[list[Press]]:
    """Return four presses of every rig."""
    target = ForceSurface.of_model(load_builtin("mx-clear"), SPEEDS_mm_s, 0.05)
    surfaces = [identification_surface(target)] * len(rigs)
    return [
        list(row) for row in zip(*(presses_of(rigs, surfaces, v, seed) for v in SPEEDS_mm_s), strict=True)
    ]


@pytest.fixture(scope="module")
def records() -> dict[str, list[Press]]:
    stiffer = replace(SPRUNG, spring_N_m=110.0)
    plants = {
        "plain": OtherRig(),
        "sprung": SPRUNG,
        "binding": BINDING,
        "sprung, again": SPRUNG,
        "stiffer": stiffer,
    }
    return dict(zip(plants, pressed(list(plants.values())), strict=True))


@pytest.fixture(scope="module")
def known(records: dict[str, list[Press]]) -> dict[str, RigModel]:
    return {name: identify(records[name], TRAVEL_mm) for name in ("plain", "sprung", "binding")}


def test_a_spring_with_a_detent_is_found_and_no_gain_is_mistaken_for_it(known: dict[str, RigModel]) -> None:
    rig, x = known["sprung"], np.linspace(0.5, 3.5, 100)
    assert np.sqrt(np.mean((rig.own_at(x) - SPRUNG.own_cN(x)) ** 2)) < 1.5
    assert float(rig.gain_at(np.array(2.0))) == pytest.approx(0.95, rel=0.03)
    assert rig.mass_g == pytest.approx(20.0, rel=0.1)
    assert 1e3 * rig.delay_s == pytest.approx(1e3 * SPRUNG.delay_s, abs=0.25)
    assert "own force over displacement" in explain_rig(rig)


def test_where_there_is_no_own_force_none_is_found(known: dict[str, RigModel]) -> None:
    assert np.ptp(known["plain"].own_cN) < 0.5
    assert "own force" not in explain_rig(known["plain"])


def test_a_bearing_that_binds_is_reported_in_one_sentence_with_its_place(known: dict[str, RigModel]) -> None:
    said = known["binding"].misfit
    assert said.startswith("the residual repeats over displacement: ")
    assert abs(float(said.split("most at ")[1].split()[0]) - 1.5) <= 0.5
    assert "\n" not in said
    assert explain_rig(known["binding"]).endswith(said)
    assert known["plain"].misfit == ""


def test_a_number_that_its_error_exceeds_or_that_rests_on_a_bound_is_not_known(
    known: dict[str, RigModel],
) -> None:
    plain = replace(known["plain"], at_bound=())
    doubtful = replace(plain, error={**plain.error, "mass_g": 1.1 * plain.mass_g})
    assert "not known: mass" in explain_rig(doubtful)
    assert "friction" in explain_rig(replace(plain, at_bound=("friction_cN",))).split("not known: ")[1]


def test_a_number_that_the_prior_does_not_let_go_where_it_wants_rests_on_its_bound(
    records: dict[str, list[Press]],
) -> None:
    rubs = Prior(ranges={"friction_cN": Plausible(10.0, 3.0, 8.0)})
    assert identify(records["plain"], TRAVEL_mm, rubs).at_bound == ("friction_cN",)


def test_a_sprung_rig_has_not_changed_until_its_spring_does(
    known: dict[str, RigModel], records: dict[str, list[Press]]
) -> None:
    again, changed = (records[name][1] for name in ("sprung, again", "stiffer"))
    assert detect_drift(known["sprung"], again, TRAVEL_mm) == ""
    assert detect_drift(known["sprung"], changed, TRAVEL_mm).startswith("spring rose")


def test_a_rig_file_keeps_the_own_force_and_files_without_it_load(tmp_path: Path) -> None:
    path = tmp_path / "own.rig.json"
    said = replace(OWN, at_bound=("play_cN",), misfit="the residual is not white")
    save_rig(said, path)
    assert load_rig(path) == said
    new = ("stick_cN", "side_ratio", "own_cN", "own_step_mm", "at_bound", "misfit")
    lines = path.read_text(encoding="utf-8")
    record = {name: value for name, value in msgspec.json.decode(lines).items() if name not in new}
    path.write_bytes(msgspec.json.encode(record))
    plain = load_rig(path)
    assert plain == replace(OWN, stick_cN=0.0, side_ratio=0.0, own_cN=(), own_step_mm=0.25)
    np.testing.assert_array_equal(plain.own_at(np.array([0.0, 3.0])), [-12.0, -12.0])


def test_the_own_force_is_linear_between_its_values_and_held_beyond() -> None:
    x = np.array([-1.0, 0.0, 0.5, 2.0, 4.0, 9.0])
    np.testing.assert_allclose(OWN.own_at(x), np.array([-8.0, -8.0, -5.0, 5.0, 2.0, 2.0]) - 12.0)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_command_of_a_sliding_cap_renders_the_target(direction: float) -> None:
    x, target = np.linspace(0.0, 4.0, 9), np.full(9, 50.0)
    command = command_cN(OWN, x, target, direction)
    plain = replace(OWN, friction_cN=0.0, stick_cN=0.0)
    speed = np.full(9, 20.0 * direction)
    felt = [
        plain.finger_force_cN(
            np.array([0.0, 1e-3]), here * np.ones(2), s * np.ones(2), np.zeros(2), u * np.ones(2)
        )
        for here, s, u in zip(x, speed, command, strict=True)
    ]
    np.testing.assert_allclose([f[0] for f in felt], target)


@pytest.mark.parametrize("stroke", list(Stroke))
def test_feasibility_needs_what_it_renders(stroke: Stroke) -> None:
    motion = minimum_jerk(stroke, 4.0, 80.0, 2.5e-4)
    wanted = 40.0 + 10.0 * np.sin(motion.displacement_mm)
    rendered = finger_force_cN(OWN, motion, inverse_dynamics_cN(OWN, motion, wanted), 1e-9)
    np.testing.assert_allclose(rendered, wanted, atol=1e-6)


def test_a_rig_needs_a_step_and_a_side_load_that_does_not_lock() -> None:
    with pytest.raises(ModelError, match="own_step_mm above 0"):
        replace(OWN, own_step_mm=0.0)
    with pytest.raises(ModelError, match="side_ratio within 1"):
        replace(OWN, side_ratio=1.2)
