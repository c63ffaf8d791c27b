"""Small real files, and the command as a person runs it."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np
import pytest

from fdvv.cli.main import cli, command_helps, main
from fdvv.units import FloatArray


def tactile_csv(path: Path, shift_cN: float = 0.0, seed: int = 0) -> Path:
    """Write a tactile switch: contact at 0.2 mm, bump near 1.2 mm, stop at 4 mm, contact column."""
    x = np.round(np.arange(0.0, 4.2005, 0.01), 3)

    def force(x: FloatArray, lag_mm: float, lower_cN: float) -> FloatArray:
        d = x - 0.2
        bump = 18 * np.exp(-(((d - 1.1 + lag_mm) / 0.35) ** 2))
        free = 30 * np.clip(d / 0.05, 0, 1) + 6 * d + bump - lower_cN + shift_cN
        return np.asarray(np.where(d <= 0, 0.0, free + 1500 * np.clip(x - 4.0, 0, None)))

    noise = np.random.default_rng(seed).normal(0, 0.05, (2, x.size))
    down = [(v, f, int(v >= 2.0)) for v, f in zip(x, force(x, 0, 0) + noise[0], strict=True)]
    up = [(v, f, int(v >= 1.8)) for v, f in zip(x, force(x, 0.2, 5) + noise[1], strict=True)]
    rows = [f"{v:.3f},{f:.4f},{c}" for v, f, c in [*down, *reversed(up)]]
    path.write_text("displacement_mm,force_cN,contact\n" + "\n".join(rows) + "\n")
    return path


@pytest.fixture
def switch(tmp_path: Path) -> Path:
    return tactile_csv(tmp_path / "switch.csv")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with two switches and a file that is none."""
    below = tmp_path / "switches"
    below.mkdir()
    tactile_csv(below / "b.csv", seed=1)
    tactile_csv(below / "a.csv", shift_cN=5, seed=2)
    (below / "c.csv").write_text("not,a,curve\n")
    return below


@dataclass(frozen=True)
class Ran:
    """What a run of the command left behind."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> dict[str, Any]:
        """Return standard output, which must be one JSON document."""
        document = json.loads(self.out)
        assert isinstance(document, dict)
        return document


Run = Callable[..., Ran]


@pytest.fixture
def fdvv(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[Run]:
    """Yield a function that runs the command in the test's folder, within this process."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str | Path) -> Ran:
        monkeypatch.setattr("sys.argv", ["fdvv", *map(str, arguments)])
        capsys.readouterr()
        with pytest.raises(SystemExit) as stop:
            main()
        out, err = capsys.readouterr()
        assert isinstance(stop.value.code, int)
        return Ran(stop.value.code, out, err)

    yield run
    for name in command_helps():
        # click keeps the help option of the first context that asked, which other tests must not see
        command = cli.get_command(click.Context(cli), name)
        assert command is not None
        command._help_option = None
