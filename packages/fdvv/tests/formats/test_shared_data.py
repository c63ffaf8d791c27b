"""The real collections: every file is read or refused in one line, and each known defect says its name."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.formats.force.average import average_by_velocity
from fdvv.formats.force.read import find_force_files, read_force_file
from fdvv.model.bump import find_contact_mm
from tests.formats import conftest as files

pytestmark = pytest.mark.shared

FOLDERS = [
    "tg-tidy",
    "tg-raw-excerpt",
    "tg-strokes",
    "haata",
    "bluepylons",
    "bluepylons-parsed",
    "buddyog-topre",
    "geekboards",
    "joaoachando",
    "paper-figure",
]

REFUSED = {
    "tg-raw-excerpt/X_Green_HighResolutionRaw.excerpt.csv": "the displacement stays within 0 mm",
    "tg-strokes/switchmeta.csv": "no header names a displacement and a force",
    "bluepylons/Blank templates/Blank-template-automated-Dangkeebs.ods": "sheet 'Sheet1': it is empty",
    "bluepylons/Blank templates/Blank-template-automated.ods": "hold no numbers (an empty template)",
    "bluepylons/JWK-Twilight-stock.ods": "hold no numbers (an empty template)",
    "bluepylons/KBDfans-Mito-Gateron-Laser-60g.ods": "it is a PNG image",
    "bluepylons/U4T-vs-Aura-vs-Halo-vs-Polia-in-Cherry-MX-Blue.ods": "it has corrected columns only",
    "paper-figure/fdvv_figure_nodes.csv": "no header names a displacement and a force",
}

TG = "tg-tidy/data/"
DEFECTS = [
    (TG + "Novelkeys Sherbet__Novelkeys Sherbet Raw Data CSV.csv", "0.370 to 0.655 mm: the probe stuck"),
    (
        TG + "Gateron Cap Ecommerce Anniversary__Gateron Cap Ecommerce Anniversary Raw Data CSV.csv",
        "3.595 to 3.680 mm: the probe stuck",
    ),
    (TG + "Ajazz x Huano Peach__Ajazz x Huano Peach Raw Data CSV.csv", "the force leaps to 38.6 cN and back"),
    (
        TG + "Firstblood Pink__Firstblood Pink Raw Data CSV.csv",
        "ends at -15.9 cN in the air, the tare was lost",
    ),
    ("tg-raw-excerpt/X Green Raw Data CSV.excerpt.csv", "there is no release"),
    ("haata/Greetech Brown.csv", "Press 2: the position counter slipped by 2.97 mm"),
    ("haata/NEC LED Magnetic Reed.csv", "Press 4: the position counter slipped by 0.48 mm"),
    ("haata/Cherry MX Blue.csv", "Press 4: displacement jumps by 9.14 mm"),
    ("haata/Cherry 01APBSW Switch.csv", "'RS232 (Cal) Press, x; Analog (Cal) Press, x' names 2 curves"),
    ("haata/Cherry 01APBSW Switch.csv", "displacement counts outwards; its sign was turned"),
    ("haata/Key Tronic Magnetic Reed V2 Latch Press.csv", "the file holds no cycle 1, 3"),
    ("bluepylons-parsed/AEBoards-Naevy-R1-5.csv", "the contact never closed"),
    ("bluepylons-parsed/AEBoards-Naevy-R1-5.csv", "the force leaps to -202.7 cN and back; 2 samples"),
    ("bluepylons-parsed/Akko-KTT-CS-Jelly-Black.csv", "the contact chatters, 7 edges from 1.850 to 2.270 mm"),
    ("bluepylons/Cherry-MX-Hyperglide-Brown.ods", "the contact chatters, 5 edges"),
    ("bluepylons/Cherry-MX-Clear-slow-vs-fast.ods", "4 measurements side by side"),
    *[
        (f"joaoachando/{name}.json", "$.up_x: copied from down_x")
        for name in ("London Fog", "linear fast", "tf1s1", "tf4s4")
    ],
    ("geekboards/Cherry MX Blue.json", "$.up_x: copied from down_x"),
]


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_file_is_read_or_refused_in_one_line(folder: str, shared_data: Path) -> None:
    found = find_force_files(shared_data / folder)
    assert found
    for path in found:
        key = path.relative_to(shared_data).as_posix()
        if key in REFUSED:
            with pytest.raises(InputError) as caught:
                read_force_file(path)
            assert REFUSED[key] in str(caught.value)
            assert "\n" not in str(caught.value)
            continue
        cycles = read_force_file(path).cycles
        assert any(cycle.press for cycle in cycles), key
        assert "excerpt" in key or any(cycle.release for cycle in cycles), key


@pytest.mark.parametrize(("path", "message"), DEFECTS)
def test_each_known_defect_is_reported(path: str, message: str, shared_data: Path) -> None:
    assert any(message in warning for warning in read_force_file(shared_data / path).warnings)


@pytest.mark.parametrize("name", ["Jade", "Navy"])
def test_click_bars_keep_their_drop_between_two_samples(name: str, shared_data: Path) -> None:
    path = shared_data / TG / f"Kailh Box {name}__Kailh Box {name} Raw Data CSV.csv"
    file = read_force_file(path)
    assert np.diff(files.press(file).force_cN).min() < -28.0
    assert not any("leaps" in warning or "stuck" in warning for warning in file.warnings)


def test_a_clean_file_has_no_warning(shared_data: Path) -> None:
    clear = shared_data / TG / "Cherry MX Clear__Cherry MX Clear Raw Data CSV.csv"
    assert read_force_file(clear).warnings == ()


def test_the_two_publications_of_one_measurement_agree(shared_data: Path) -> None:
    # the strokes are the tidy run shifted so that contact is 0, the force first above 2 gf
    tidy = read_force_file(shared_data / TG / "Cherry MX Clear__Cherry MX Clear Raw Data CSV.csv").cycles[0]
    pair = read_force_file(shared_data / "tg-strokes/csv_output/Cherry MX Clear.upstroke.csv").cycles[0]
    for stroke in ("press", "release"):
        one, other = getattr(tidy, stroke), getattr(pair, stroke)
        x = np.arange(0.5, 3.5, 0.01)
        shift = find_contact_mm(one) - find_contact_mm(other)
        forces = [np.interp(x + s, *c.by_displacement()[:2]) for c, s in ((one, shift), (other, 0.0))]
        assert np.median(np.abs(forces[0] - forces[1])) < 0.5


def test_the_spreadsheet_and_its_parsed_table_are_the_same_measurement(shared_data: Path) -> None:
    names = ("bluepylons/Cherry-MX-Red.ods", "bluepylons-parsed/Cherry-MX-Red.csv")
    sheet, table = (read_force_file(shared_data / name) for name in names)
    for file in (sheet, table):
        assert (file.cycles[0].actuation_mm, file.cycles[0].reset_mm) == (1.805, 1.76)
    np.testing.assert_allclose(files.press(sheet).force_cN, files.press(table).force_cN)


@pytest.mark.parametrize(
    ("name", "left_out"),
    [
        ("Cherry MX Black", {}),
        ("Cherry MX Clear", {}),
        ("Greetech Brown", {"Cycle 4": "of the release are missing"}),
        ("NEC LED Magnetic Reed", {"Cycle 4": "force of the press differs"}),
        ("Cherry MX Blue", {"Cycle 4": "of the press are missing"}),
    ],
)
def test_repeats_are_averaged_when_they_are_one_population(
    name: str, left_out: dict[str, str], shared_data: Path
) -> None:
    (averaged,) = average_by_velocity(read_force_file(shared_data / f"haata/{name}.csv"))
    assert averaged.warnings == ()
    assert {label for label, _ in averaged.left_out} == set(left_out)
    assert all(left_out[label] in reason for label, reason in averaged.left_out)
    assert len(averaged.used) + len(left_out) == 4


def test_different_buttons_in_one_sheet_are_not_averaged(shared_data: Path) -> None:
    (averaged,) = average_by_velocity(
        read_force_file(shared_data / "bluepylons/Gateron-Yellow-leaf-vs-no-leaf.ods")
    )
    assert averaged.used == ("(with leaf)",)
    assert averaged.warnings[0].startswith("mixed populations")


def test_a_rebuilt_release_agrees_with_every_release_point(shared_data: Path) -> None:
    # the point's force must be found where the point says, on data that did not have to agree
    for path in find_force_files(shared_data / "geekboards"):
        (cycle,) = read_force_file(path).cycles
        assert cycle.press is not None
        assert cycle.release is not None
        step = 0.025
        # one step back from the deepest point: the release begins where the press ended
        deep = cycle.press.displacement_mm[-1] - cycle.release.displacement_mm[-1]
        assert deep == pytest.approx(step, abs=1e-9), path.name


def test_the_published_figure_gives_ten_curves(shared_data: Path) -> None:
    file = read_force_file(shared_data / "paper-figure/fdvv_figure_press.csv")
    assert [c.press and c.press.velocity_mm_s for c in file.cycles] == [0.5, 50.0, 100.0, 150.0, 200.0]
    assert all(c.release is not None and c.release.force_cN.size == 81 for c in file.cycles)
    assert files.press(file).force_cN[:2].tolist() == [2.952, 9.713]
    assert len(average_by_velocity(file)) == 5
    assert file.warnings == ()


def test_reading_is_fast(shared_data: Path) -> None:
    paths = find_force_files(shared_data / "tg-tidy")
    read_force_file(paths[0])
    took = []
    for path in paths[:15]:
        start = time.process_time()
        read_force_file(path)
        took.append(time.process_time() - start)
    assert float(np.median(took)) < 0.015
