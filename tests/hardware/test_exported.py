"""The exported parts: closed, as large as their solids, of today's dimensions, and they go together."""

import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest
from tools import make_hardware

from fdvv.errors import InputError
from fdvv.twin.files import load_rig
from fdvv_rig.bought import bought_parts
from fdvv_rig.check import Assembly, assemble, clearances, meetings, states
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.exported import check_exported
from fdvv_rig.limiter import Limiter
from fdvv_rig.manifest import read_manifest
from fdvv_rig.mesh import Mesh, read_stl
from fdvv_rig.parts import PARTS, part_named
from fdvv_rig.placement import RIG, Pose, State, in_rig, on_jig
from fdvv_rig.solids import body_of, gap_mm, placed, shared_mm3

pytest.importorskip("manifold3d", reason="manifold3d is not installed")

REPOSITORY = Path(__file__).resolve().parents[2]
HARDWARE = REPOSITORY / "hardware"
D = Dimensions()
NAMES = [part.name for part in PARTS]


@pytest.fixture(scope="module")
def meshes() -> dict[str, Mesh]:
    return {name: read_stl(HARDWARE / "parts" / f"{name}.stl") for name in NAMES}


@pytest.fixture(scope="module")
def rig(meshes: dict[str, Mesh]) -> Assembly:
    return assemble(meshes, D)


@pytest.mark.parametrize("name", NAMES)
def test_every_edge_of_a_part_is_shared_by_exactly_two_triangles(name: str, meshes: dict[str, Mesh]) -> None:
    assert meshes[name].open_edges() == 0
    assert meshes[name].flat_triangles() == 0


@pytest.mark.parametrize("name", NAMES)
def test_a_parts_surface_holds_what_its_solid_holds(name: str, meshes: dict[str, Mesh]) -> None:
    made = read_manifest(HARDWARE).parts[name]
    assert meshes[name].volume_cm3 == pytest.approx(made.volume_cm3, rel=0.01)
    assert meshes[name].area_cm2 == pytest.approx(made.area_cm2, rel=0.01)
    low, high = meshes[name].box_mm
    assert high - low == pytest.approx(np.array(made.box_mm), abs=0.05)
    assert low[2] == pytest.approx(0.0, abs=1e-4), "it lies on the bed"


def test_the_exports_are_of_todays_dimensions() -> None:
    manifest = read_manifest(HARDWARE)
    assert manifest.digest == D.digest(), "run python tools/make_hardware.py"
    assert manifest.made_from() == D


def test_every_file_is_the_one_that_was_exported_and_no_other_lies_there() -> None:
    from hashlib import sha256

    recorded = {
        name: digest for made in read_manifest(HARDWARE).parts.values() for name, digest in made.files.items()
    }
    there = {
        str(p.relative_to(HARDWARE)): p for kind in ("parts", "drawings") for p in (HARDWARE / kind).iterdir()
    }
    assert set(recorded) == set(there)
    for name, path in there.items():
        assert sha256(path.read_bytes()).hexdigest() == recorded[name], "run python tools/make_hardware.py"


def test_the_package_tells_of_the_parts_what_the_manifest_tells() -> None:
    kept = (REPOSITORY / "extras/fdvv-rig/src/fdvv_rig/printed.json").read_text()
    assert kept == make_hardware.printed(read_manifest(HARDWARE)), "run python tools/make_hardware.py"
    assert part_named("base").made.volume_cm3 == read_manifest(HARDWARE).parts["base"].volume_cm3


def test_no_exported_file_tells_of_a_place_or_a_time_of_its_making() -> None:
    for path in [*HARDWARE.rglob("*.step"), *HARDWARE.rglob("*.svg"), HARDWARE / "manifest.json"]:
        text = path.read_text(encoding="ascii" if path.suffix == ".step" else "utf-8")
        assert not any(word in text for word in ("/tmp", "/home", "/root", "/work", "build123d")), path.name
    head = (HARDWARE / "parts" / "base.step").read_text()[:400]
    assert "FILE_NAME('base.step','2020-01-01T00:00:00',('fdvv'),('fdvv'),'fdvv','fdvv','');" in head


def test_all_exports_together_stay_small() -> None:
    assert sum(path.stat().st_size for path in HARDWARE.rglob("*") if path.is_file()) < 3_000_000


def test_the_sensor_cone_is_the_papers_frustum_less_a_dimple(meshes: dict[str, Mesh]) -> None:
    frustum_mm3 = math.pi * 5 / 3 * (6**2 + 6 * 2.5 + 2.5**2)
    ball_mm = (D.sensor_ball_mm + D.hole_excess_mm) / 2
    deep_mm = 0.7 * ball_mm
    dimple_mm3 = math.pi * deep_mm**2 * (3 * ball_mm - deep_mm) / 3
    assert read_manifest(HARDWARE).parts["sensor-cone"].volume_cm3 == pytest.approx(
        (frustum_mm3 - dimple_mm3) / 1e3, rel=1e-4
    )


def test_no_two_parts_meet_at_the_end_of_the_travel(rig: Assembly) -> None:
    travel_mm = D.travel_mm - 0.02
    assert meetings(rig, State(travel_mm, min(travel_mm + 0.05, D.travel_mm))) == []


def test_with_a_load_cell_in_the_cap_no_two_parts_meet(meshes: dict[str, Mesh]) -> None:
    with_cell = assemble(meshes, D, cell=True)
    for travel_mm in (0.0, D.travel_mm - 0.02):
        assert meetings(with_cell, State(travel_mm, D.travel_mm)) == []


def test_the_plate_touches_nothing_but_the_cell_and_is_as_light_as_the_twins(meshes: dict[str, Mesh]) -> None:
    with_cell = assemble(meshes, D, cell=True)
    bodies = with_cell.at(State())
    assert gap_mm(bodies["cell-plate"], bodies["cell-holder"]) >= D.film_preload_mm - 1e-3
    assert gap_mm(bodies["cell-plate"], bodies["cell"]) < 0.05
    assert part_named("cell-plate").mass_g < 1e3 * load_rig("recommended").load_cell.plate_kg
    rim_mm, plate_mm = (bodies[name].bounding_box()[5] for name in ("cell-holder", "cell-plate"))
    assert plate_mm - rim_mm > 1.5, "a finger must not press the rim"


@pytest.mark.slow
def test_no_two_parts_meet_in_any_state_that_is_checked(rig: Assembly) -> None:
    assert [met for state in states(D) for met in meetings(rig, state)] == []


@pytest.mark.slow
def test_what_moves_keeps_its_distance(rig: Assembly) -> None:
    gaps = {frozenset((c.one, c.other)): c.gap_mm for c in clearances(rig)}
    stated = {
        ("core", "lvdt"): (D.lvdt_bore_mm - D.lvdt_core_diameter_mm) / 2,
        ("slider-yoke", "coil-mount"): D.slide_gap_mm,
        ("slider-yoke", "pin"): (D.m3_clearance_mm - 3.0) / 2,
        ("limiter-arm", "coil-mount"): D.free_gap_mm,
        ("slider-yoke", "coil"): D.free_gap_mm,
        ("coupling", "lvdt"): D.free_gap_mm,
        ("coupling", "bushing"): D.free_gap_mm,
        ("limiter-arm", "servo"): 1.0,
        ("keycap", "coil-mount"): 3.0,
    }
    found = {pair: gaps[frozenset(pair)] for pair in stated}
    assert all(found[pair] >= least - 0.01 for pair, least in stated.items()), found
    assert min(gaps.values()) >= 0.19


def test_parts_that_stand_wrong_are_seen_to_meet(rig: Assembly) -> None:
    aside = placed(rig.printed["limiter-bracket"], Pose(shift_mm=(0.0, 0.0, 8.0)))
    wrong = Assembly(D, {**rig.printed, "limiter-bracket": aside}, rig.bought, rig.envelopes)
    met = {frozenset((m.one, m.other)) for m in meetings(wrong, State(0.0, D.travel_mm))}
    assert any("limiter-bracket" in pair for pair in met)


@pytest.mark.parametrize("stop_mm", [0.5, 6.0])
def test_the_foot_meets_the_limiter_where_its_law_says(rig: Assembly, stop_mm: float) -> None:
    # stand still, let the limiter be set for a stop: the gap that is left is the rest of the way
    for left_mm in (0.3, 0.1):
        bodies = rig.at(State(stop_mm - left_mm, stop_mm))
        gap = gap_mm(bodies["slider-yoke"], bodies["limiter-arm"])
        slope = D.limiter_small_mm * Limiter(D).mm_per_deg * 180 / math.pi / D.limiter_small_mm**2
        assert gap == pytest.approx(left_mm * math.cos(math.atan(slope)), abs=0.03)
    through = rig.printed["slider-yoke"]
    below = placed(
        through, Pose(shift_mm=(0.0, 0.0, -(stop_mm + 0.3))).after(in_rig("slider-yoke", State(), D))
    )
    assert shared_mm3(below, rig.at(State(0.0, stop_mm))["limiter-arm"]) > 0.05


def test_a_state_beyond_the_stop_is_refused() -> None:
    with pytest.raises(InputError, match="stay above the stop"):
        State(3.0, 2.0).angle_deg(D)


def test_the_marker_posts_stand_in_the_jig_without_meeting_it(meshes: dict[str, Mesh]) -> None:
    jig = placed(body_of(meshes["capture-jig"]), on_jig("capture-jig", D)[0])
    places = on_jig("marker-post", D)
    assert len(places) == part_named("marker-post").count
    for pose in places:
        post = placed(body_of(meshes["marker-post"]), pose)
        assert shared_mm3(jig, post) < 0.01
        assert gap_mm(jig, post) < 0.01, "its collar rests on the jig"


def test_the_three_posts_make_sides_that_a_camera_can_tell_apart() -> None:
    at = [np.array(pose.shift_mm[:2]) for pose in on_jig("marker-post", D)]
    sides = sorted(float(np.linalg.norm(at[i] - at[j])) for i, j in ((0, 1), (1, 2), (2, 0)))
    assert sides[1] - sides[0] > 5
    assert sides[2] - sides[1] > 5


def test_the_box_hides_the_rig_and_leaves_the_hand_a_way_to_the_key(rig: Assembly) -> None:
    bodies = rig.at(State(0.0))
    box = bodies["black-box"]
    inside = [bodies[name] for name in (*RIG, *rig.bought) if name != "black-box"]
    assert min(gap_mm(box, body) for body in inside) > 2.0
    key = bodies["keycap"].bounding_box()
    front = type(box).cube((40.0, 200.0, 40.0)).translate((-20.0, -200.0, key[5] - 5))
    assert shared_mm3(box, front) == pytest.approx(0.0, abs=1e-6)


def test_every_bought_part_names_only_parts_that_exist() -> None:
    known = {*NAMES, *(envelope.name for envelope in bought_parts(D))}
    for envelope in bought_parts(D):
        assert envelope.holds | envelope.enters <= known, envelope.name


def copied(tmp_path: Path) -> Path:
    folder = tmp_path / "hardware"
    shutil.copytree(HARDWARE, folder, ignore=shutil.ignore_patterns("pictures"))
    return folder


def test_a_manifest_of_other_dimensions_is_refused(tmp_path: Path) -> None:
    folder = copied(tmp_path)
    document = json.loads((folder / "manifest.json").read_text())
    del document["dimensions"]["travel_mm"]
    (folder / "manifest.json").write_text(json.dumps(document))
    with pytest.raises(InputError, match="travel_mm"):
        check_exported(folder)


def test_a_missing_part_is_named(tmp_path: Path) -> None:
    folder = copied(tmp_path)
    (folder / "parts" / "coil-mount.stl").unlink()
    with pytest.raises(InputError, match=r"coil-mount\.stl"):
        check_exported(folder)
