"""What commands print and write is as it was, and how a difference from it is shown."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tools.snapshot.cases import EDITS
from tools.snapshot.commands import Commands
from tools.snapshot.compare import difference
from tools.snapshot.reference import FOLDER, MACHINE, Reference, Snapshot, snapshots
from tools.snapshot.values import lines_of

from tests.support.campaign import campaign

SNAPSHOTS = snapshots()


@pytest.fixture(scope="session")
def commands() -> Iterator[Commands]:
    """A process that runs commands for all tests of this worker."""
    with Commands() as commands:
        yield commands


@pytest.fixture(scope="session")
def reference() -> Reference:
    return Reference()


@pytest.mark.parametrize("snapshot", [s for s in SNAPSHOTS if not s.slow], ids=lambda s: s.name)
def test_nothing_differs_that_no_commit_changes(
    snapshot: Snapshot, commands: Commands, reference: Reference
) -> None:
    compare(snapshot, commands, reference)


@pytest.mark.slow
@campaign("snapshot", [s for s in SNAPSHOTS if s.slow], part=4)
def test_nothing_long_differs_that_no_commit_changes(
    snapshot: Snapshot, commands: Commands, reference: Reference
) -> None:
    compare(snapshot, commands, reference)


def compare(snapshot: Snapshot, commands: Commands, reference: Reference) -> None:
    """Take a snapshot and compare it with the one that is kept; skip where it cannot be taken."""
    if not snapshot.possible:
        pytest.skip("the real measurements (../shared/data or FDVV_SHARED) are not on this machine")
    if reference.other_libraries:
        pytest.skip(f"figures are those of {reference.other_libraries}")
    differs = reference.differs(snapshot.name, snapshot.take(commands))
    assert not differs, f"{differs}\nwhere it is meant: python -m tools.snapshot --write {snapshot.name}"


def test_each_snapshot_has_a_name_of_its_own_and_a_text() -> None:
    names = [snapshot.name for snapshot in SNAPSHOTS]
    assert sorted(names) == sorted(path.stem for path in FOLDER.glob("*.txt") if path != MACHINE)


def test_the_order_of_fields_counts() -> None:
    assert lines_of({"a": 1, "b": 2}) != lines_of({"b": 2, "a": 1})


def test_one_bit_of_a_long_list_changes_its_digest_and_a_large_change_its_figures() -> None:
    values = [float(number) for number in range(100)]
    (line,), (last_digit,), (large,) = (
        lines_of(list_) for list_ in (values, [*values[:-1], 99.00000000000001], [*values[:-1], 999.0])
    )
    figures, _, digest = line.rpartition(" ")
    assert last_digit.rpartition(" ")[0] == figures
    assert last_digit.rpartition(" ")[2] != digest
    assert large.rpartition(" ")[0] != figures


def test_an_array_is_shown_by_its_numbers_however_it_was_compressed() -> None:
    data = np.arange(20.0).tobytes()
    texts = [f"<f8:{base64.b64encode(zlib.compress(data, level)).decode()}" for level in (1, 9)]
    assert texts[0] != texts[1]
    assert lines_of(texts[0]) == lines_of(texts[1]) == lines_of([float(number) for number in range(20)])


BEFORE = "force_cN: 3 numbers: first 1.0, rms 2.00000000001 #0123456789ab\nname: mx-2"


@pytest.mark.parametrize(
    ("after", "same_here", "same_elsewhere"),
    [
        (BEFORE, True, True),
        (BEFORE.replace("0123456789ab", "ba9876543210").replace("00001 ", "00002 "), False, True),
        (BEFORE.replace("2.00000000001", "2.00000002"), False, False),
        (BEFORE.replace("mx-2", "mx-3"), False, False),
        (BEFORE.replace("3 numbers", "4 numbers"), False, False),
        (BEFORE + "\n", True, True),
        (BEFORE + "\nmore: 1", False, False),
    ],
)
def test_last_digits_count_only_on_a_machine_that_rounds_alike(
    after: str, same_here: bool, same_elsewhere: bool
) -> None:
    assert [not difference(BEFORE, after, exact) for exact in (True, False)] == [same_here, same_elsewhere]


def test_a_file_is_cut_and_its_numbers_are_set(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text("rounds = 16 # of each\npeople = 3\nname = 'rounds = 1'\n")
    EDITS["set"](tmp_path, "a.toml", "rounds=2", "trials=5")
    EDITS["keep-lines"](tmp_path, "a.toml", "2")
    assert (tmp_path / "a.toml").read_text() == "rounds = 2 # of each\npeople = 3\n"
