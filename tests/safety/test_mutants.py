"""Faults planted in supervisor, heat, thermistor and settings are caught: their tests can be trusted."""

from __future__ import annotations

import os
import subprocess
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.safety import _scenes
from tests.safety._build import CORE, compile_c
from tests.safety._checks import checks_of_settings
from tests.safety._equivalents import EQUIVALENT
from tests.safety._mutants import Mutant, mutants
from tests.safety._script import Script
from tests.support.campaign import campaign

SOURCES = {name: CORE / f"{name}.c" for name in ("supervisor", "heat", "thermistor", "settings")}
SHARES = 20
"""A usual run plants the mutants of one."""
REPLAY = Path(__file__).with_name("_replay.c")
SECONDS = 5
"""A mutant that has not ended by then hangs, which a watchdog sees: caught."""


class Bench(NamedTuple):
    """What every mutant is linked with, by the name of its source, and played."""

    folder: Path
    objects: dict[str, Path]
    files: tuple[Path, ...]

    def others(self, name: str) -> list[Path]:
        """Return all objects but that of this source."""
        return [path for other, path in self.objects.items() if other != name]


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("mutants")
    script = Script()
    for scene in _scenes.DIRECTED:
        scene(script)
    _scenes.chance(script, seed=1, ticks=2000)
    packed = dict(zip(("settings", "steps", "limits"), script.packed(), strict=True)) | checks_of_settings()
    for name, data in packed.items():
        (folder / name).write_bytes(data)
    sources = {**SOURCES, "arithmetic": CORE / "arithmetic.c"}
    objects = {
        name: compile_c(folder / f"{name}.o", "-O1", "-c", sources=(source,))
        for name, source in sources.items()
    }
    objects["replay"] = compile_c(folder / "replay.o", "-O1", "-c", "-DREPLAY_MAIN", sources=(REPLAY,))
    return Bench(folder, objects, tuple(folder / name for name in packed))


def verdict(bench: Bench, name: str, mutant: Mutant, number: int) -> str:
    """Say 'caught', 'survived' or 'not C': it does not compile."""
    source = bench.folder / f"mutant{number}.c"
    program = source.with_suffix("")
    source.write_text(mutant.text)
    out = subprocess.run(
        [
            "cc",
            "-std=c99",
            "-O0",
            "-Werror=return-type",
            "-fsanitize=bounds",  # else what lies behind a table decides whether a read beyond it is seen
            "-fsanitize-undefined-trap-on-error",
            f"-I{CORE}",
            "-o",
            program,
            source,
            *bench.others(name),
        ],
        capture_output=True,
        check=False,
    )
    source.unlink()
    if out.returncode:
        return "not C"
    try:
        same = subprocess.run([program, *bench.files], capture_output=True, check=False, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return "caught"
    finally:
        program.unlink()
    return "survived" if same.returncode == 0 else "caught"


def survivors(bench: Bench, name: str, chosen: list[Mutant]) -> tuple[list[str], Counter[str]]:
    """Plant each; name those that no scene notices, count the verdicts."""
    with ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        verdicts = list(pool.map(lambda pair: verdict(bench, name, pair[1], pair[0]), enumerate(chosen)))
    alive = [mutant.name for mutant, found in zip(chosen, verdicts, strict=True) if found == "survived"]
    return alive, Counter(verdicts)


def candidates(name: str) -> list[Mutant]:
    """Return all mutants of a source but those that behave as the original does."""
    return [mutant for mutant in mutants(SOURCES[name].read_text()) if mutant.name not in EQUIVALENT[name]]


def test_the_code_itself_passes(bench: Bench) -> None:
    whole = Mutant(0, "", "", SOURCES["settings"].read_text())
    assert verdict(bench, "settings", whole, 0) == "survived"


@pytest.mark.parametrize("name", SOURCES)
@campaign("share", range(SHARES), part=1)
def test_every_mutant_is_caught(bench: Bench, share: int, name: str) -> None:
    chosen = candidates(name)[share::SHARES]
    alive, counts = survivors(bench, name, chosen)
    assert alive == []
    assert counts["caught"] >= 0.5 * len(chosen)  # a tenth of all are no C, of a small share more


@pytest.mark.parametrize("name", SOURCES)
def test_each_equivalent_is_a_mutant_that_exists_and_has_its_reason(name: str) -> None:
    names = {mutant.name for mutant in mutants(SOURCES[name].read_text())}
    assert set(EQUIVALENT[name]) <= names
    assert all(len(reason.split()) > 3 for reason in EQUIVALENT[name].values())
