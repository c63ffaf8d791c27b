"""Meshes: what is closed, what it holds, and files that read back as they were written."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv_rig.mesh import Mesh, joined, read_stl, stl_bytes
from fdvv_rig.placement import Pose

CORNERS = np.array([[x, y, z] for x in (0.0, 2.0) for y in (0.0, 3.0) for z in (0.0, 4.0)])
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
BLOCK = Mesh(CORNERS, FACES)


def test_a_block_is_closed_and_holds_what_its_sides_give() -> None:
    assert BLOCK.open_edges() == 0
    assert BLOCK.volume_cm3 == pytest.approx(0.024)
    assert BLOCK.area_cm2 == pytest.approx(0.52)


def test_a_missing_triangle_is_seen() -> None:
    assert Mesh(CORNERS, FACES[1:]).open_edges() == 3


def test_a_triangle_that_looks_the_wrong_way_is_seen() -> None:
    turned = FACES.copy()
    turned[0] = turned[0][::-1]
    assert Mesh(CORNERS, turned).open_edges() > 0


def test_an_edge_that_four_triangles_share_is_seen() -> None:
    other = Mesh(CORNERS + np.array([2.0, 3.0, 0.0]), FACES)
    both = joined(np.concatenate([BLOCK.corners, other.corners]))
    assert both.open_edges() > 0


def test_a_block_inside_out_has_a_negative_volume() -> None:
    assert Mesh(CORNERS, FACES[:, ::-1]).volume_cm3 == pytest.approx(-0.024)


def test_a_file_reads_back_as_it_was_written(tmp_path: Path) -> None:
    (tmp_path / "block.stl").write_bytes(stl_bytes(BLOCK))
    found = read_stl(tmp_path / "block.stl")
    assert found.open_edges() == 0
    assert found.volume_cm3 == pytest.approx(0.024)


@given(st.permutations(range(12)), st.integers(0, 2))
def test_the_order_of_triangles_and_corners_does_not_change_the_file(order: list[int], turn: int) -> None:
    other = joined(np.roll(BLOCK.corners[order], turn, axis=1))
    assert stl_bytes(other) == stl_bytes(joined(BLOCK.corners))


@pytest.mark.parametrize(
    "data", [b"", b"solid block\nendsolid\n", stl_bytes(BLOCK)[:-1], stl_bytes(BLOCK) + b"x"]
)
def test_what_is_no_whole_binary_stl_is_refused(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "bad.stl").write_bytes(data)
    with pytest.raises(InputError, match=r"bad\.stl"):
        read_stl(tmp_path / "bad.stl")


def test_a_corner_that_is_not_finite_is_refused(tmp_path: Path) -> None:
    data = bytearray(stl_bytes(BLOCK))
    data[84 + 12 : 84 + 16] = np.array(np.nan, "<f4").tobytes()
    (tmp_path / "bad.stl").write_bytes(bytes(data))
    with pytest.raises(InputError, match="not finite"):
        read_stl(tmp_path / "bad.stl")


def test_a_pose_and_its_inverse_undo_each_other() -> None:
    pose = Pose(((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)), (1.0, 2.0, 3.0))
    there = BLOCK.moved(pose)
    np.testing.assert_allclose(there.moved(pose.inverse).points, CORNERS, atol=1e-12)
    np.testing.assert_allclose(pose.inverse.after(pose).of(CORNERS), CORNERS, atol=1e-12)
    assert there.volume_cm3 == pytest.approx(BLOCK.volume_cm3)
