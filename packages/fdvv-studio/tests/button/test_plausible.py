"""What cannot be a button is refused with its reason, or accepted when asked; what can is not doubted."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from fdvv.button.fit import FitSettings, fit_file, measured_files, measured_parts
from fdvv.errors import InputError
from fdvv.formats.force.read import read_force_file
from fdvv.model.residual import noise_cN
from fdvv.units import FloatArray
from fdvv_studio.library.figures import read_file
from tests.support.buttons import bench_mm, known_cN

Columns = tuple[FloatArray, FloatArray]


def cycle() -> Columns:
    """Return displacement and force of a press and its release."""
    x = bench_mm()
    return np.concatenate([x, x[::-1]]), np.concatenate([known_cN(x), known_cN(x, "release")[::-1]])


def write(folder: Path, x: FloatArray, force: FloatArray, header: str = "displacement_mm,force_cN") -> Path:
    path = folder / "made.csv"
    path.write_text("\n".join([header, *(f"{a:.4f},{b:.4f}" for a, b in zip(x, force, strict=True))]) + "\n")
    return path


def joined(scale: float) -> Columns:
    """Return two cycles of one run, the second one as stiff as scale says."""
    x, force = cycle()
    return np.concatenate([x, x]), np.concatenate([force, scale * force])


def random_cN(x: FloatArray) -> FloatArray:
    return np.random.default_rng(1).uniform(0, 100, x.size)


def delayed(rows: int) -> Columns:
    x, force = cycle()
    return x, np.roll(force, rows)


GARBAGE: dict[str, tuple[Callable[[], Columns], str]] = {
    "a constant force": (lambda: (cycle()[0], 0 * cycle()[1] + 50.0), "hardly changes"),
    "noise": (lambda: (cycle()[0], random_cN(cycle()[0])), "jumps by"),
    "half a noise": (lambda: (cycle()[0], 0.5 * cycle()[1] + 0.5 * random_cN(cycle()[0])), "jumps by"),
    "micrometres called millimetres": (lambda: (200 * cycle()[0], cycle()[1]), "travels"),
    "pounds": (lambda: (cycle()[0], 453.6 * cycle()[1]), "the force reaches"),
    "ounces": (lambda: (cycle()[0], 28.35 * cycle()[1]), "the mean force is"),
    "millinewtons": (lambda: (cycle()[0], 0.1 * cycle()[1]), "the mean force is"),
    "strokes exchanged": (lambda: (cycle()[0], cycle()[1][::-1]), "gives back"),
    "forces that come late": (lambda: delayed(60), "leaves the stop"),
    "forces that come early": (lambda: delayed(-120), "before the deepest"),
    "two buttons": (lambda: joined(1.6), "of its cycles goes from"),
    "a fragment": (lambda: (cycle()[0][:150], cycle()[1][:150]), "without a stop or a release"),
}


@pytest.mark.parametrize("what", GARBAGE)
def test_garbage_is_refused_with_what_where_and_what_to_do(tmp_path: Path, what: str) -> None:
    make, reason = GARBAGE[what]
    path = write(tmp_path, *make())
    with pytest.raises(InputError, match=reason) as refused:
        fit_file(path)
    assert refused.value.source == str(path)
    assert "check" in refused.value.remedy or "put each" in refused.value.remedy
    assert "--accept-implausible" in refused.value.remedy


@pytest.mark.parametrize("what", GARBAGE)
def test_what_is_accepted_when_asked_says_so(tmp_path: Path, what: str) -> None:
    make, reason = GARBAGE[what]
    found = fit_file(write(tmp_path, *make()), FitSettings(accept_implausible=True))
    said = [warning for warning in found.warnings if "implausible, accepted" in warning]
    assert any(reason in warning for warning in said)


def test_the_library_refuses_for_the_same_reason(tmp_path: Path) -> None:
    path = write(tmp_path, *GARBAGE["pounds"][0]())
    with pytest.raises(InputError, match="the force reaches"):
        read_file(path)


def test_repeats_of_one_button_are_not_doubted(tmp_path: Path) -> None:
    assert not fit_file(write(tmp_path, *joined(1.02))).warnings


def test_exchanged_columns_are_refused(tmp_path: Path) -> None:
    x, force = cycle()
    with pytest.raises(InputError):
        fit_file(write(tmp_path, force, x))


def test_a_second_header_is_refused_with_its_line(tmp_path: Path) -> None:
    path = write(tmp_path, *cycle())
    path.write_text(2 * path.read_text())
    with pytest.raises(InputError, match=rf"line {2 * bench_mm().size + 2}: a second header"):
        fit_file(path)


def test_decimal_commas_between_commas_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path, *cycle())
    header, body = path.read_text().split("\n", 1)
    path.write_text(header + "\n" + body.replace(".", ","))
    with pytest.raises(InputError, match="4 cells under 2 names"):
        fit_file(path)


def test_two_strokes_in_one_are_refused(tmp_path: Path) -> None:
    lines = [f"{x:.4f},{f:.4f}" for x, f in zip(bench_mm(), known_cN(bench_mm()), strict=True)]
    path = tmp_path / "made.downstroke.csv"
    path.write_text("\n".join(lines + lines) + "\n")
    with pytest.raises(InputError, match="runs back by"):
        fit_file(path)


@pytest.mark.parametrize("sigma_cN", [0.1, 1.0])
def test_the_noise_of_a_clean_signal_is_found_and_a_step_is_none(sigma_cN: float) -> None:
    noise = np.random.default_rng(0).normal(0, sigma_cN, 4000)
    assert noise_cN(known_cN(np.linspace(0, 4.3, 4000)) + noise) == pytest.approx(sigma_cN, rel=0.1)


@pytest.mark.slow
@pytest.mark.shared
def test_no_real_file_is_doubted_but_an_excerpt_of_35_um_and_a_release_that_snaps(shared_data: Path) -> None:
    doubted, read = set(), 0
    for path in measured_files(shared_data):
        try:
            parts = measured_parts(read_force_file(path))
        except InputError:
            continue
        read += 1
        if parts.implausible:
            doubted.add(path.name)
    assert read > 100
    # the second is a real switch: its release falls from 84 to 22 cN between two samples; the gate is wrong
    known = {"X Green Raw Data CSV.excerpt.csv", "TG3-Copre-over-NK-Blueberry-stem-in-Boba.ods"}
    assert doubted == known & {path.name for path in measured_files(shared_data)}
