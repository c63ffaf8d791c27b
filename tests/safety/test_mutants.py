"""Faults planted in the supervisor are caught: the scenes of _scenes.py are dense enough to be trusted."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.safety import _scenes
from tests.safety._build import CORE, compile_c
from tests.safety._equivalents import EQUIVALENT
from tests.safety._mutants import Mutant, mutants
from tests.safety._script import Script

SUPERVISOR = CORE / "supervisor.c"
REPLAY = Path(__file__).with_name("_replay.c")
SECONDS = 5
"""A mutant that has not ended by then hangs, which a watchdog sees: caught."""


class Bench(NamedTuple):
    """What every mutant is linked with and played."""

    folder: Path
    others: tuple[Path, ...]
    settings: Path
    steps: Path
    limits: Path


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("mutants")
    script = Script()
    for scene in _scenes.DIRECTED:
        scene(script)
    _scenes.chance(script, seed=1, ticks=2000)
    for name, data in zip(("settings", "steps", "limits"), script.packed(), strict=True):
        (folder / name).write_bytes(data)
    replay = compile_c(folder / "replay.o", "-O1", "-c", "-DREPLAY_MAIN", sources=(REPLAY,))
    checks = compile_c(folder / "settings.o", "-O1", "-c", sources=(CORE / "settings.c",))
    return Bench(folder, (replay, checks), folder / "settings", folder / "steps", folder / "limits")


def verdict(bench: Bench, mutant: Mutant, number: int) -> str:
    """Say 'caught', 'survived' or 'not C': it does not compile."""
    source = bench.folder / f"mutant{number}.c"
    program = source.with_suffix("")
    source.write_text(mutant.text)
    out = subprocess.run(
        ["cc", "-std=c99", "-O0", "-Werror=return-type", f"-I{CORE}", "-o", program, source, *bench.others],
        capture_output=True,
        check=False,
    )
    source.unlink()
    if out.returncode:
        return "not C"
    try:
        same = subprocess.run(
            [program, bench.settings, bench.steps, bench.limits],
            capture_output=True,
            check=False,
            timeout=SECONDS,
        )
    except subprocess.TimeoutExpired:
        return "caught"
    finally:
        program.unlink()
    return "survived" if same.returncode == 0 else "caught"


def survivors(bench: Bench, chosen: list[Mutant]) -> tuple[list[str], Counter[str]]:
    """Plant each; name those that no scene notices, count the verdicts."""
    with ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        verdicts = list(pool.map(lambda pair: verdict(bench, pair[1], pair[0]), enumerate(chosen)))
    alive = [mutant.name for mutant, found in zip(chosen, verdicts, strict=True) if found == "survived"]
    return alive, Counter(verdicts)


def candidates() -> list[Mutant]:
    """Return all mutants but those that behave as the original does."""
    return [mutant for mutant in mutants(SUPERVISOR.read_text()) if mutant.name not in EQUIVALENT]


def test_the_code_itself_passes(bench: Bench) -> None:
    whole = Mutant(0, "", "", SUPERVISOR.read_text())
    assert verdict(bench, whole, 0) == "survived"


def test_a_sample_of_mutants_is_caught(bench: Bench) -> None:
    alive, counts = survivors(bench, random.Random(1).sample(candidates(), 44))
    assert alive == []
    assert counts["caught"] >= 40


def test_each_equivalent_is_a_mutant_that_exists_and_has_its_reason() -> None:
    names = {mutant.name for mutant in mutants(SUPERVISOR.read_text())}
    assert set(EQUIVALENT) <= names
    assert all(len(reason.split()) > 3 for reason in EQUIVALENT.values())


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_every_mutant_is_caught(bench: Bench) -> None:
    alive, counts = survivors(bench, candidates())
    assert alive == []
    found = f"{counts['caught']} caught, {counts['not C']} not C, {len(EQUIVALENT)} equivalent"
    sys.stdout.write(f"{found}\n")
