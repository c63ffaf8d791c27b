"""What all tests share: one seed of all that is drawn, real measurements where they are present."""

from __future__ import annotations

import os
import signal
from collections.abc import Generator
from pathlib import Path
from zlib import crc32

import pytest
from hypothesis import HealthCheck, settings

from tests.support.campaign import SEED
from tests.support.checkout import REPOSITORY, shared_folder

pytest_plugins = ["tests.support.command_line"]

# what a test starts as a process of its own imports tests.support too
os.environ |= {"PYTHONPATH": os.pathsep.join(map(str, (REPOSITORY, *REPOSITORY.glob("packages/*"))))}

# no wall clock: beside other work everything takes longer
settings.register_profile(
    "fdvv", deadline=None, derandomize=False, print_blob=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("quick", settings.get_profile("fdvv"), max_examples=15)
settings.load_profile("quick" if os.environ.get("FDVV_QUICK") else "fdvv")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # a shell's background job; what the tests interrupt would inherit it and go on for ever
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Draw the examples of property tests and the order of the tests from the seed of the run."""
    if config.option.hypothesis_seed is None:
        config.option.hypothesis_seed = str(crc32(SEED.encode()))
    if config.getoption("randomly_seed", None) == "default":
        config.option.randomly_seed = crc32(SEED.encode())


def pytest_report_header() -> str:
    return f"FDVV_SEED={SEED}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Print the seed with a failure, for who sees no header."""
    report = yield
    if report.failed:
        report.sections.append(("Seed", f"FDVV_SEED={SEED} draws the same again"))
    return report


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Return ../shared/data, or skip by name where it is absent."""
    folder = shared_folder() / "data"
    if not folder.is_dir():
        pytest.skip("the real measurements (../shared/data or FDVV_SHARED) are not on this machine")
    return folder


@pytest.fixture
def hasty_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have nobody wait until something is on the disk: for small files that is most of the time."""
    monkeypatch.setattr("os.fsync", lambda _file: None)
