"""The headers and tables made from protocol/*.toml, and the records in them."""

from __future__ import annotations

import importlib.util
import struct
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

from fdvv.errors import ModelError
from fdvv.protocol import tables

ROOT = Path(__file__).resolve().parents[4]
SOURCE = tomllib.loads((ROOT / "protocol" / "fdvv.toml").read_text())
LOOP = tomllib.loads((ROOT / "protocol" / "force_loop.toml").read_text())


FOLDERS = "core", "force_loop"


def generator() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_protocol", ROOT / "tools" / "make_protocol.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def test_what_is_committed_is_made_from_the_definitions() -> None:
    make = generator()
    strip = tomllib.loads(make.STRIP_SOURCE.read_text())
    assert make.header(SOURCE) == make.HEADER.read_text()
    assert make.header(LOOP) == make.LOOP_HEADER.read_text()
    assert make.header(strip) == make.STRIP_HEADER.read_text()
    assert make.tables(strip) == make.STRIP_TABLES.read_text()


def test_the_tables_of_the_build_are_as_new_as_their_definition() -> None:
    assert generator().meaning_hash(SOURCE) == tables.HASH
    assert generator().meaning_hash(LOOP) == tables.FORCE_LOOP_HASH


def test_prose_does_not_change_the_hash_and_a_range_does() -> None:
    make = generator()
    prose = tomllib.loads((ROOT / "protocol" / "fdvv.toml").read_text())
    prose["structs"]["settings"]["fields"][0][5] = "other words"
    assert make.meaning_hash(prose) == tables.HASH
    prose["structs"]["settings"]["fields"][0][4] += 1
    assert make.meaning_hash(prose) != tables.HASH


def test_a_range_may_be_widened_for_later_firmware_and_the_hash_stays() -> None:
    make = generator()
    more = tomllib.loads((ROOT / "protocol" / "fdvv.toml").read_text())
    more["widened"]["settings"]["reads"] = [1, 100]
    assert make.meaning_hash(more) == tables.HASH
    assert '"reads": (1, 100),' in make.tables(more)
    assert "X(reads, 1, 100)" in make.header(more)
    for wrong, says in (({"reads": [2, 100]}, "narrowed"), ({"read": [1, 100]}, "no field read to widen")):
        more["widened"]["settings"] = wrong
        with pytest.raises(SystemExit, match=says):
            make.header(more)


def test_a_constant_of_the_loop_is_one_row_and_leaves_the_boards_without_a_loop_as_they_are() -> None:
    make = generator()
    more = tomllib.loads((ROOT / "protocol" / "force_loop.toml").read_text())
    row = ["own_force_N", "f32[3]", "N", -1.0, 1.0, "of the rig", [0.0, 0.0, 0.5]]
    more["structs"]["force_loop_gains"]["fields"].append(row)
    assert "float own_force_N[3]; /* N; -1.0 to 1.0; of the rig */" in make.header(more)
    assert "X(own_force_N[2], -1.0f, 1.0f)" in make.header(more)
    made = make.tables(make.extended(SOURCE, more))
    assert "    own_force_N: tuple[float, ...] = (0.0, 0.0, 0.5)" in made
    assert (
        'RUNS: ClassVar[dict[str, int]] = {"own_N": 8, "free_gains": 4, "stop_gains": 4, "own_force_N": 3'
        in made
    )
    assert f"\nHASH = 0x{tables.HASH:08X}\n" in made
    assert f"FORCE_LOOP_HASH = 0x{tables.FORCE_LOOP_HASH:08X}" not in made
    row[6] = [1.0, 1.0, 1.0]
    assert make.tables(make.extended(SOURCE, more)).split("FORCE_LOOP_HASH")[1][:20] in made


def test_the_headers_compile_alone_and_together(tmp_path: Path) -> None:
    probe = tmp_path / "probe.c"
    probe.write_text(
        '#include "loop_protocol.h"\n#include "protocol.h"\n#include "strip_protocol.h"\n'
        "int main(void) { return sizeof(fdvv_settings) != 96; }\n"
    )
    program = tmp_path / "probe"
    flags = [
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        *(f"-I{ROOT / 'firmware' / name}" for name in FOLDERS),
    ]
    subprocess.run(["cc", *flags, "-o", program, probe], check=True)
    assert subprocess.run([program], check=False).returncode == 0


def test_a_number_out_of_range_is_refused_by_name() -> None:
    with pytest.raises(ModelError, match="tick_us must be 50 to 4000, got 7"):
        tables.Settings(tick_us=7)


def test_too_few_bytes_are_refused() -> None:
    with pytest.raises(ModelError, match="96 bytes, got 95"):
        tables.Settings.unpack(bytes(95))


def test_every_request_fits_a_frame() -> None:
    room = tables.FRAME_BYTES - 4
    assert max(tables.REQUEST_BYTES.values()) <= room
    assert max(tables.REPLY_BYTES.values()) <= room
    records = tables.RecordsRequest.length_bytes()
    records += tables.TELEMETRY_RECORDS * struct.calcsize(tables.TickRecord.FORMAT)
    assert records <= room
