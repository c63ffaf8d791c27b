"""The core under the sanitisers, at the ends of every range; it must give the bits of the fast library."""

from __future__ import annotations

import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.firmware.core import INPUTS, OUTPUTS, Core, CoreRequest, RecordArray
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import Mode, Settings
from tests.support.campaign import campaign
from tests.support.random_programs import random_image

CORE = Path(__file__).resolve().parents[4] / "firmware" / "core"
FLAGS = [
    "-std=c99",
    "-O1",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-fsanitize=address,undefined",
    "-fno-sanitize-recover=all",
]


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Path:
    program = tmp_path_factory.mktemp("sanitised") / "driver"
    sources = [str(Path(__file__).with_name("_driver.c")), *map(str, sorted(CORE.glob("*.c")))]
    subprocess.run(["cc", *FLAGS, f"-I{CORE}", "-o", str(program), *sources], check=True)
    return program


def wild_settings(rng: np.random.Generator) -> Settings:
    """Draw every field from the ends of its range or from anywhere between, until the firmware takes them."""
    while True:
        fields = {
            name: [low, high, int(rng.integers(low, high, endpoint=True))][int(rng.integers(3))]
            for name, (low, high) in Settings.LIMITS.items()
        }
        fields["reading_low"] = int(rng.integers(0, 3))
        fields["supply_low_mV"], fields["supply_high_mV"] = 2000, 57000
        fields["jump_um16"], fields["late_ticks"] = 65535, 1000
        fields["window_end_um16"] = max(fields["window_end_um16"], fields["window_start_um16"] + 1)
        fields["heat_limit_K"] = max(fields["heat_limit_K"], fields["derate_start_K"] + 1)
        largest = (2**33 - 2**16) // (max(1, abs(fields["position_gain_q14"])) * fields["reads"])
        fields["reading_high"] = max(4, min(65535, largest))
        settings = Settings(**fields)
        try:
            Core(settings)
        except ModelError:
            continue
        return settings


def wild_inputs(rng: np.random.Generator, settings: Settings, ticks: int) -> RecordArray:
    """Draw any bits at all, or a walk over all places that does not jump; gaps of all lengths."""
    inputs = np.zeros(ticks, INPUTS)
    for name in ("sum", "time_us"):
        inputs[name] = rng.integers(0, 2**32, ticks, dtype=np.uint64)
    if rng.random() < 0.7:
        step = max(1, (60000 << 14) // abs(settings.position_gain_q14))
        walk = np.cumsum(rng.choice([-step, 0, 1, step], ticks).astype(np.int64)) + int(rng.integers(2**31))
        inputs["sum"] = walk % 2**32
    inputs["lowest"] = inputs["highest"] = settings.reading_low + 1
    inputs["elapsed_ticks"] = rng.choice(
        [0, 1, 2, 64, 65, 1000, 1001, 65535], ticks, p=[0.02, 0.84, 0.1, 0.01, 0.01, 0.01, 0.005, 0.005]
    )
    inputs["supply_mV"] = rng.choice(
        [2000, 12000, 57000, 0, 65535], ticks, p=[0.33, 0.33, 0.33, 0.005, 0.005]
    )
    at_rest = settings.force_offset_counts
    inputs["force_counts"] = rng.choice([0, 65535, at_rest], ticks, p=[0.005, 0.005, 0.99])
    return inputs


def expected(settings: Settings, image: bytes, inputs: RecordArray) -> bytes:
    """Run the fast library as the driver runs its core."""
    core, found = Core(settings, image), np.zeros(inputs.size, OUTPUTS)
    for k, given in enumerate(inputs):
        core.hear(int(given["time_us"]))
        if core.mode is Mode.FAULT:
            core.ask(CoreRequest.CLEAR, core.fault)
        core.ask(CoreRequest.BOOTED)
        core.ask(CoreRequest.ARM)
        core.event(int(given["sum"]) & 31)
        found[k] = core.tick(given, host_heard=False)
    return found.tobytes()


def run(driver: Path, seeds: range, ticks: int) -> int:
    """Compare the cases of these seeds; return how many ticks were rendered."""
    script, wanted = b"", b""
    for seed in seeds:
        rng = np.random.default_rng(seed)
        settings = wild_settings(rng)
        image, inputs = random_image(rng, settings), wild_inputs(rng, settings, ticks)
        script += settings.pack() + limits_like(settings).pack() + struct.pack("<I", len(image)) + image
        script += struct.pack("<I", ticks) + inputs.tobytes()
        wanted += expected(settings, image, inputs)
    done = subprocess.run([str(driver)], input=script, capture_output=True, check=False)
    assert (done.returncode, done.stderr.decode()) == (0, "")
    assert done.stdout == wanted
    return int(np.frombuffer(wanted, OUTPUTS)["enable"].sum())


@campaign("block", range(12), part=1)
def test_no_overflow_and_no_stray_access_at_the_ends_of_every_range(driver: Path, block: int) -> None:
    assert run(driver, range(40 * block, 40 * block + 40), 500) > 10_000
